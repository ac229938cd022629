import type { Page } from "@playwright/test";
import {
  expect,
  expectAccessiblePanels,
  hash,
  openRun,
  openTab,
  type RealServer,
  status,
  test,
} from "./page";

const open = (page: Page, server: RealServer, query = "") =>
  openRun(page, server, `scenario=classic&seed=7${query}`);

test("the experiment of 2003 opens from the gallery and runs until all items are found", async ({
  page,
  server,
}) => {
  await page.goto(server.url);
  await page.getByRole("link", { name: /^classic/ }).click();
  await expect(status(page)).toHaveText("0.0 s, 4 robots: all clear; 1 of 4 items found; paused.");
  await page.getByRole("combobox", { name: "Speed" }).selectOption({ label: "Maximum" });
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("4 of 4 items found; finished");
});

test("a step is a paint, and steps back lead to the same state", async ({ page, server }) => {
  await open(page, server, "&tick=10&robot=wanderer/2");
  const nextDecision = page.locator("dt", { hasText: "Next decision" }).locator("+ dd");
  await expect(nextDecision).toHaveText("in 2 paints");
  const there = await hash(page);
  await page.keyboard.press(".");
  await expect(nextDecision).toHaveText("in 1 paint");
  await page.keyboard.press(".");
  await expect(nextDecision).toHaveText("in 11 paints");
  for (let i = 0; i < 2; i += 1) await page.keyboard.press(",");
  await expect(nextDecision).toHaveText("in 2 paints");
  await expect.poll(() => hash(page)).toBe(there);
});

test("team and contact change during a run, and the address gives the same run", async ({
  page,
  server,
  context,
}) => {
  await open(page, server, "&tick=30");
  await openTab(page, "Parameters");
  const slider = page.getByRole("slider", { name: "Count of wanderer, slider" });
  await slider.focus();
  for (const robots of [5, 6, 7]) {
    await page.keyboard.press("ArrowRight");
    await expect(status(page)).toContainText(`${robots} robots`);
  }
  await page.getByRole("searchbox").fill("contact");
  await page.getByRole("combobox", { name: "contact" }).selectOption("within-2");
  await expect.poll(() => page.url()).toContain("within-2");
  await page.getByRole("application").focus();
  for (let i = 0; i < 5; i += 1) await page.keyboard.press(".");
  await expect.poll(() => page.url()).toContain("tick=35");
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(status(other)).toContainText("7 robots");
  await expect.poll(() => hash(other)).toBe(await hash(page));
});

test("features that the classic engine lacks are not offered", async ({ page, server }) => {
  await open(page, server);
  await expect(page.getByRole("tab", { name: "Edit" })).toHaveCount(0);
  await openTab(page, "Layers");
  await expect(page.getByRole("checkbox", { name: "Observed cells" })).toBeVisible();
  await expect(page.getByRole("checkbox", { name: "Radio links" })).toHaveCount(0);
  await expect(page.getByText("battery empty")).toHaveCount(0);
});

test("the panels of a classic run pass axe", async ({ page, server }) => {
  await open(page, server, "&tick=60&changes=[[0,%22contact%22,%22ahead%22]]&robot=wanderer/0");
  await expectAccessiblePanels(page, ["Results", "Robot", "Parameters", "Layers", "Events"]);
});

test("a run is saved, listed, and opened as the same run", async ({ page, server }) => {
  await open(page, server, `&tick=90&changes=[[30,"robots.wanderer.count",7],[60,"contact","ahead"]]`);
  await expect(status(page)).toContainText("1.6 s, 7 robots");
  const there = await hash(page);
  await page.locator("summary", { hasText: "Export" }).click();
  await page.getByRole("button", { name: "Save recording" }).click();
  await expect(page.getByText("Saved as recordings/classic-7-0-")).toBeVisible();
  await page.getByRole("link", { name: "All recordings" }).last().click();
  await expect(page.getByRole("row", { name: /classic-7-0-/ })).toContainText("90");
  await page.getByRole("link", { name: /^recordings\/classic-7-0-/ }).click();
  await expect(status(page)).toContainText("0.0 s, 4 robots");
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill((await slider.getAttribute("max")) ?? "");
  await expect(status(page)).toContainText("1.6 s, 7 robots");
  await expect.poll(() => hash(page)).toBe(there);
  await expect.poll(() => page.url()).toMatch(/recording=recordings.*tick=90/);
});

test("changes that do not fit into an address are saved, and the address names the recording", async ({
  page,
  server,
}) => {
  const many = Array.from({ length: 400 }, (_, i) => [0, "robots.wanderer.count", 2 + (i % 7)]);
  await openRun(page, server, `scenario=classic&changes=${JSON.stringify(many)}`);
  await openTab(page, "Parameters");
  await page.getByRole("slider", { name: /^Count of/ }).fill("9");
  await expect.poll(() => page.url()).toContain("recording=recordings/classic-0-0-");
  await page.reload();
  await expect(status(page)).toContainText("9 robots");
});
