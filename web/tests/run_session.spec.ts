import type { Page } from "@playwright/test";
import {
  altered,
  expect,
  expectAccessible,
  expectReportAtOnce,
  hash,
  openRun,
  openTab,
  status,
  test,
  time_s,
} from "./page";

/** The address of a run that continues for long, as nothing is left to find. */
function endless(seed: number, tick: number): string {
  const changes = [
    [0, "clock.time_limit_s", 100_000],
    [0, "items.mine.count", 0],
  ];
  const text = encodeURIComponent(JSON.stringify(changes));
  return `scenario=search-beliefs&seed=${seed}&changes=${text}&tick=${tick}`;
}

test("the slider changes the team during a run", async ({ page, server }) => {
  await openRun(page, server, "scenario=search&seed=3&tick=40", "4.0 s");
  await page.keyboard.press("Space");
  await openTab(page, "Parameters");
  const slider = page.getByRole("slider", { name: /^Count of/ });
  const before = Number(await slider.inputValue());
  await slider.focus();
  for (let i = 1; i <= 5; i += 1) {
    await page.keyboard.press("ArrowRight");
    await expect(status(page)).toContainText(`${before + i} robots`);
  }
  expect(await time_s(page)).toBeGreaterThanOrEqual(4);
});

test("dragging a slider while the run is paused is one change, which one undo reverts", async ({
  page,
  server,
}) => {
  await openRun(page, server, "scenario=search&seed=3&tick=40", "4.0 s, 4 robots");
  const before = await hash(page);
  await openTab(page, "Parameters");
  const slider = page.getByRole("slider", { name: /^Count of/ });
  const box = await slider.boundingBox();
  if (!box) throw new Error("there is no slider");
  const middle = box.y + box.height / 2;
  await page.mouse.move(box.x + 10, middle);
  await page.mouse.down();
  for (const share of [0.9, 0.3, 0.7, 0.5]) {
    await page.mouse.move(box.x + share * box.width, middle, { steps: 4 });
    await expect(status(page)).toContainText(`4.0 s, ${await slider.inputValue()} robots`);
  }
  await page.mouse.up();
  await openTab(page, "Events");
  await expect(page.getByRole("button", { name: /robots.rover.count = / })).toHaveCount(1);
  await page.getByRole("application").focus();
  await page.keyboard.press("Control+z");
  await expect(status(page)).toContainText("4.0 s, 4 robots");
  await expect.poll(() => hash(page)).toBe(before);
});

test("a page that is reloaded while computing towards a tick reaches it", async ({ page, server }) => {
  // Until it is reloaded, the page gets no news of the computation after the first: it does not see the end.
  let [states, isReloaded] = [0, false];
  await altered(page, async (message) => {
    if (message.type === "state") states += 1;
    if (states > 1 && !isReloaded) await new Promise(() => {});
    return message;
  });
  await openRun(page, server, endless(3, 3000), "computing");
  // The address has been updated: the page adds its view.
  await expect.poll(() => page.url()).toContain("view=");
  expect(page.url()).toContain("tick=3000");
  await expect(status(page)).toContainText("computing");
  isReloaded = true;
  await page.reload();
  await expect(status(page)).toContainText("300.0 s");
});

test("a killed server is reported at once, and the run is restored when it is back", async ({
  page,
  ownServer,
}) => {
  const reportsAtOnce = await expectReportAtOnce(page);
  await openRun(page, ownServer, "scenario=search-beliefs&seed=7&tick=20");
  await openTab(page, "Parameters");
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("6");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("2.0 s, 6 robots");
  const there = await hash(page);
  await reportsAtOnce(() => ownServer.kill());
  await ownServer.start();
  await expect(status(page)).toContainText("2.0 s, 6 robots");
  await expect.poll(() => hash(page)).toBe(there);
  await expect(page.getByRole("alert")).toHaveCount(0);
});

test("a run that was playing when its server was killed continues playing", async ({ page, ownServer }) => {
  const reportsAtOnce = await expectReportAtOnce(page);
  await openRun(page, ownServer, endless(7, 200), "20.0 s");
  await page.keyboard.press("Space");
  await expect.poll(() => time_s(page)).toBeGreaterThan(21);
  const there = await time_s(page);
  await reportsAtOnce(() => ownServer.kill());
  await expectAccessible(page);
  await ownServer.start();
  await expect(status(page)).toContainText("running");
  await expect(page.getByRole("alert")).toHaveCount(0);
  await expect.poll(() => time_s(page)).toBeGreaterThanOrEqual(there);
  await expect(status(page)).toContainText("running");
});

test("a change that did not reach the server before the connection broke is reported as lost", async ({
  page,
  server,
}) => {
  let isCut = false;
  await page.routeWebSocket(/\/ws/, (line) => {
    const upstream = line.connectToServer();
    line.onMessage((data) => {
      if (isCut && String(data).includes('"change"')) {
        isCut = false;
        void line.close();
      } else upstream.send(data);
    });
  });
  await openRun(page, server, "scenario=search&seed=3&tick=40", "4.0 s, 4 robots");
  await openTab(page, "Parameters");
  isCut = true;
  const count = page.getByRole("spinbutton", { name: "Count of rover" });
  await count.fill("6");
  await page.keyboard.press("Enter");
  const report = page.getByRole("alert").filter({ hasText: "1 change lost: robots.rover.count" });
  await expect(report).toBeVisible();
  await expect(page.getByText("The connection is lost.")).toHaveCount(0);
  await expect(status(page)).toContainText("4.0 s, 4 robots");
  await expect(count).toHaveValue("4");
  await expectAccessible(page);
  await report.getByRole("button", { name: "Dismiss" }).click();
  await expect(report).toHaveCount(0);
});

test("a run is operated by keyboard alone", async ({ page, server }) => {
  await page.goto(server.url);
  const card = page.getByRole("link", { name: /^search-beliefs/ });
  for (let i = 0; i < 60 && !(await card.evaluate((link) => link === document.activeElement)); i += 1)
    await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("4 robots");
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("running");
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("paused");
  const slider = page.getByRole("slider", { name: "Count of rover" });
  const parameters = page.getByRole("tab", { name: "Parameters" });
  for (let i = 0; i < 60 && !(await isInTabs(page)); i += 1) await page.keyboard.press("Tab");
  for (let i = 0; i < 8 && (await parameters.getAttribute("aria-selected")) !== "true"; i += 1)
    await page.keyboard.press("ArrowRight");
  for (let i = 0; i < 60 && !(await slider.evaluate((input) => input === document.activeElement)); i += 1)
    await page.keyboard.press("Tab");
  await page.keyboard.press("ArrowRight");
  await expect(status(page)).toContainText("5 robots");
  await page.keyboard.press("Control+z");
  await expect(status(page)).toContainText("4 robots");
});

const isInTabs = (page: Page) => page.evaluate(() => document.activeElement?.getAttribute("role") === "tab");
