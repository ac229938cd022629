import { expect, test } from "../page";

test("a study is started and answered, and a point of its chart opens a run of it", async ({
  page,
  server,
}) => {
  await page.goto(server.url);
  await page.getByRole("link", { name: "Study search", exact: true }).click();
  await page.getByRole("textbox", { name: "Number of rovers" }).fill("1..4");
  await page.getByRole("textbox", { name: "Delta" }).fill("0.5");
  await expect(page.getByText("factorial: 4 configurations; delta 0.5")).toBeVisible();
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expect(page.getByText(/^Send \d rovers?\. A run takes/)).toBeVisible({ timeout: 60_000 });

  const chart = page.getByRole("img", { name: /^Figure of merit with its interval/ });
  await chart.locator(".mark-symbol.role-mark path").first().click();
  const dialog = page.getByRole("dialog", { name: "Runs of 1 rover" });
  const row = dialog.getByRole("row", { name: /^median/ });
  const run = await row.getByRole("link").textContent();
  const time_s = Number(await row.getByRole("cell").nth(2).textContent());
  await row.getByRole("link").click();
  await expect(page.getByRole("heading", { name: `Run ${run} of search, 1 rover` })).toBeVisible();
  await page.getByRole("combobox", { name: /[Ss]peed/ }).selectOption({ index: 6 });
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await expect(page.locator("#status")).toContainText("finished", { timeout: 30_000 });
  const ended_s = Number.parseFloat((await page.locator("#status").textContent()) ?? "");
  expect(Math.abs(ended_s - time_s)).toBeLessThan(0.2);
  await page.getByRole("link", { name: "Back to the study" }).click();
  await expect(dialog).toBeVisible();
});

test("a stopped study is resumed, and stays in the list", async ({ page, ownServer }) => {
  await page.goto(`${ownServer.url}/#/study/new?scenario=search`);
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText("runs per second")).toBeVisible();
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await page.getByRole("link", { name: "Studies", exact: true }).click();
  await page.getByRole("link", { name: /^Stopped search/ }).click();
  await page.getByRole("button", { name: "Resume" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
});

test("a killed server is reported at once, and the study is read from its folder", async ({
  page,
  ownServer,
}) => {
  await page.goto(`${ownServer.url}/#/study/new?scenario=search`);
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText("runs per second")).toBeVisible();
  await ownServer.kill();
  await expect(page.getByText("The connection is lost.")).toBeVisible();
  await ownServer.start();
  await expect(page.getByText("The connection is lost.")).toBeHidden({ timeout: 15_000 });
  await expect(page.getByText(/^(Running|Stopped)$/)).toBeVisible();
});
