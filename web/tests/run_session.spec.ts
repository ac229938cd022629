import type { Page } from "@playwright/test";
import { expect, expectAccessible, type RealServer, test } from "./page";

const status = (page: Page) => page.locator("#status");
const hash = async (page: Page) =>
  (await page.getByTitle("Hash of the run's state").getAttribute("title")) ?? "";
const time_s = async (page: Page) => Number.parseFloat((await status(page).textContent()) ?? "");

async function open(page: Page, server: RealServer, query: string): Promise<void> {
  await page.goto(`${server.url}/#/run?${query}`);
  await expect(status(page)).toContainText("robots");
}

test("a scenario of the gallery becomes a run, and then another", async ({ page, server }) => {
  await page.goto(server.url);
  await page.getByRole("link", { name: /^search-beliefs/ }).click();
  await expect(status(page)).toContainText("0.0 s, 4 robots");
  const first = await hash(page);
  await page.getByRole("button", { name: "New run" }).click();
  await page.getByRole("textbox", { name: "Seed" }).fill("12345678901234567890");
  await page.getByRole("button", { name: "Start" }).click();
  await expect.poll(() => page.url()).toContain("seed=12345678901234567890&run=1");
  await expect.poll(() => hash(page)).not.toBe(first);
});

test("the slider changes the team during a run", async ({ page, server }) => {
  await open(page, server, "scenario=search&seed=3&tick=40");
  await expect(status(page)).toContainText("4.0 s");
  await page.keyboard.press("Space");
  await page.getByRole("tab", { name: "Parameters" }).click();
  const slider = page.getByRole("slider", { name: /^Count of/ });
  const before = Number(await slider.inputValue());
  await slider.focus();
  for (let i = 0; i < 5; i += 1) await page.keyboard.press("ArrowRight");
  await expect(status(page)).toContainText(`${before + 5} robots`);
  expect(await time_s(page)).toBeGreaterThanOrEqual(4);
});

test("dragging a slider while the run is paused is one change, which one undo reverts", async ({
  page,
  server,
}) => {
  await open(page, server, "scenario=search&seed=3&tick=40");
  await expect(status(page)).toContainText("4.0 s, 4 robots");
  const before = await hash(page);
  await page.getByRole("tab", { name: "Parameters" }).click();
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
  await page.getByRole("tab", { name: "Changes" }).click();
  await expect(page.getByRole("row")).toHaveCount(2);
  await page.getByRole("application").focus();
  await page.keyboard.press("Control+z");
  await expect(status(page)).toContainText("4.0 s, 4 robots");
  await expect.poll(() => hash(page)).toBe(before);
});

test("a page that is reloaded while computing towards a tick reaches it", async ({ page, server }) => {
  const changes = encodeURIComponent(
    JSON.stringify([
      [0, "clock.time_limit_s", 100_000],
      [0, "items.mine.count", 0],
      [0, "robots.rover.count", 50],
    ]),
  );
  await open(page, server, `scenario=search-beliefs&seed=3&changes=${changes}&tick=3000`);
  await expect.poll(() => time_s(page)).toBeGreaterThan(2);
  // The address has been updated: the page adds its view.
  await expect.poll(() => page.url()).toContain("view=");
  expect(page.url()).toContain("tick=3000");
  await page.reload();
  await expect(status(page)).toContainText("300.0 s", { timeout: 40_000 });
});

test("a run plays, pauses, steps, and returns to the same state", async ({ page, server }) => {
  await open(page, server, "scenario=search-beliefs&seed=7");
  await page.keyboard.press("Space");
  await expect.poll(() => time_s(page)).toBeGreaterThan(1);
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("paused");
  const [there, where] = [await hash(page), (await status(page).textContent()) ?? ""];
  await page.keyboard.press(".");
  await expect.poll(() => hash(page)).not.toBe(there);
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill("3");
  await expect(status(page)).toContainText("0.3 s");
  await slider.fill((await slider.getAttribute("max")) ?? "");
  await page.keyboard.press(",");
  await expect(status(page)).toHaveText(where);
  await expect.poll(() => hash(page)).toBe(there);
});

test("a parameter changes during a run, an invalid value is refused, and the change can be undone", async ({
  page,
  server,
}) => {
  await open(page, server, "scenario=search-beliefs&seed=7&tick=10");
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("searchbox").fill("max_speed");
  const box = page.getByRole("spinbutton", { name: /rover.*max_speed_m_s/ });
  const before = await box.inputValue();
  await box.fill("0.123");
  await box.press("Enter");
  await expect.poll(() => page.url()).toContain("0.123");
  await box.fill("-1");
  await box.press("Enter");
  await expect.poll(() => box.evaluate((input: HTMLInputElement) => input.validity.valid)).toBe(false);
  await page.getByRole("application").focus();
  await page.keyboard.press("Control+z");
  await expect(box).toHaveValue(before);
});

test("an address reproduces the run in another tab, which is independent", async ({
  page,
  server,
  context,
}) => {
  await open(page, server, "scenario=search-beliefs&seed=7&run=2");
  await page.keyboard.press("Space");
  await expect.poll(() => time_s(page)).toBeGreaterThan(0.5);
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("9");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("9 robots");
  await page.getByRole("application").focus();
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("paused");
  const there = await hash(page);
  const tick = Math.round(10 * (await time_s(page)));
  await expect.poll(() => page.url()).toContain(`tick=${tick}`);
  const other = await context.newPage();
  await other.goto(page.url());
  await expect.poll(() => hash(other)).toBe(there);
  // The tabs are independent.
  await other.keyboard.press(".");
  await expect.poll(() => hash(other)).not.toBe(there);
  expect(await hash(page)).toBe(there);
});

test("the errors of an invalid file are listed with lines, and a valid file opens", async ({
  page,
  server,
}) => {
  const file = (text: string) => ({
    name: "my.toml",
    mimeType: "application/toml",
    buffer: Buffer.from(text),
  });
  await page.goto(server.url);
  const input = page.locator("input[type=file]");
  await input.setInputFiles(file('engine = "metric"\nsumary = "x"\n[clock]\nstep_s = -1\n'));
  await expect(page.getByRole("heading", { name: /my.toml has \d errors/ })).toBeVisible();
  await expect(page.getByRole("button", { name: "Line 2" })).toBeVisible();
  await expect(page.getByRole("button", { name: "Line 4" })).toBeVisible();
  await page.goto(server.url);
  await input.setInputFiles(
    file(
      [
        'engine = "metric"\nsummary = "Three rovers."\nmerit = "equation-5.2"\nclock = { time_limit_s = 60 }',
        'world = { size_m = [20, 20] }\nitems.mine.count = 2\n[robots.rover]\nmodel = "ugv"\ncount = 3\n',
      ].join("\n"),
    ),
  );
  await expect(status(page)).toContainText("3 robots");
});

test("a killed server is reported at once, and the run is restored when it is back", async ({
  page,
  ownServer,
}) => {
  await open(page, ownServer, "scenario=search-beliefs&seed=7&tick=20");
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("6");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("2.0 s, 6 robots");
  const there = await hash(page);
  await ownServer.kill();
  await expect(page.getByText("The connection is lost.").first()).toBeVisible({ timeout: 1500 });
  await ownServer.start();
  await expect(status(page)).toContainText("2.0 s, 6 robots", { timeout: 20_000 });
  await expect.poll(() => hash(page)).toBe(there);
});

test("a run that was playing when its server was killed continues playing", async ({ page, ownServer }) => {
  const changes = encodeURIComponent(
    JSON.stringify([
      [0, "clock.time_limit_s", 100_000],
      [0, "items.mine.count", 0],
    ]),
  );
  await open(page, ownServer, `scenario=search-beliefs&seed=7&changes=${changes}&tick=200`);
  await expect(status(page)).toContainText("20.0 s");
  await page.keyboard.press("Space");
  await expect.poll(() => time_s(page)).toBeGreaterThan(21);
  const there = await time_s(page);
  await ownServer.kill();
  await expect(page.getByText("The connection is lost.").first()).toBeVisible({ timeout: 1500 });
  await expectAccessible(page);
  await ownServer.start();
  await expect(status(page)).toContainText("running", { timeout: 20_000 });
  await expect(page.getByRole("alert")).toHaveCount(0);
  expect(await time_s(page)).toBeGreaterThanOrEqual(there);
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
