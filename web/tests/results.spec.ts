import { copyFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Page } from "@playwright/test";
import { expect, expectAccessible, openRun, test } from "./page";

const small = fileURLToPath(new URL("small_lane.toml", import.meta.url));
const lane = "scenario=small_lane.toml&seed=1&run=1";

const panel = (page: Page) => page.getByRole("tabpanel");
const terms = (page: Page) =>
  panel(page)
    .getByRole("term")
    .getByRole("button", { name: /^(?!.*over time)/ });
/** The figure with a label: its value with the unit. */
const figure = (page: Page, label: string) =>
  panel(page)
    .locator("dl > div")
    .filter({ has: page.getByRole("button", { name: label, exact: true }) })
    .getByRole("definition");
const group = (page: Page, name: string) => panel(page).locator("summary", { hasText: name });

/** Opens the panel of a run, on a phone too. */
async function openResults(page: Page, server: { url: string }, query: string, width: number): Promise<void> {
  await page.setViewportSize({ width, height: 800 });
  await openRun(page, server, query);
  if (width < 821) await page.getByRole("button", { name: "Panels", exact: true }).click();
  await expect(panel(page).getByRole("heading", { name: /^Outcome/ })).toBeVisible();
}

for (const width of [390, 1280]) {
  test(`the three figures that answer the question come first, the rest in groups, at ${width} px`, async ({
    page,
    server,
  }) => {
    await openResults(page, server, "scenario=search&seed=1&run=1&tick=40", width);
    await expect(terms(page)).toHaveText(["Found", "Time", "Collisions"]);
    await expect(figure(page, "Time")).toHaveText("4.0 s so far");
    await expect(figure(page, "Found")).toHaveText("0 / 4");
    // A closed group lists what is in it, in one line.
    await expect(group(page, "Team")).toContainText("Robots 4, Price 80,000");
    // By keyboard.
    await group(page, "Mission").focus();
    await page.keyboard.press("Enter");
    await expect(figure(page, "Complete")).toHaveText("not yet");
    await expectAccessible(page, "aside");
    // What was opened stays open.
    await page.getByRole("tab", { name: "Robot" }).click();
    await page.getByRole("tab", { name: "Results" }).click();
    await expect(figure(page, "Complete")).toBeVisible();
  });

  test(`the help of a figure is displayed on focus and on hover, and Escape hides it, at ${width} px`, async ({
    page,
    server,
  }) => {
    await openResults(page, server, "scenario=search&seed=1&run=1", width);
    const help = panel(page).getByText("Targets that were found, of all targets.");
    const found = panel(page).getByRole("button", { name: "Found", exact: true });
    await expect(found).toHaveAccessibleDescription("Targets that were found, of all targets.");
    await expect(help).toBeHidden();
    await found.focus();
    await expect(help).toBeVisible();
    await expectAccessible(page, "aside");
    await found.blur();
    await expect(help).toBeHidden();
    await found.hover();
    await expect(help).toBeVisible();
    // The pointer can move over it.
    await help.hover();
    await expect(help).toBeVisible();
    const box = await help.boundingBox();
    expect(box && box.x >= 0 && box.x + box.width <= width).toBe(true);
    await page.keyboard.press("Escape");
    await expect(help).toBeHidden();
  });
}

test("a run of which nothing is searched has no finds, energy or prices", async ({ page, server }) => {
  await openResults(page, server, "scenario=flock&seed=1&run=1&tick=10", 1280);
  await expect(terms(page)).toHaveText(["Time", "Collisions", "Distance"]);
  for (const name of ["Finds", "Goals", "Lane", "Mission"]) await expect(group(page, name)).toHaveCount(0);
  await expect(panel(page).getByText(/Energy|Price|Found/)).toHaveCount(0);
});

test("what a lane's controllers state is not yet known before they do, and with the time and the risk after", async ({
  page,
  server,
}) => {
  await copyFile(small, join(server.folder, "small_lane.toml"));
  await openResults(page, server, `${lane}&tick=150`, 1280);
  await expect(panel(page).getByRole("heading", { name: "Outcome so far" })).toBeVisible();
  await expect(figure(page, "Declared")).toHaveText("not yet");
  await expect(figure(page, "Stated risk")).toHaveText("not yet");
  await group(page, "Lane").click();
  await expect(terms(page)).toHaveText(["Declared", "Stated risk", "Found", "Given up"]);
  await openResults(page, server, `${lane}&tick=531`, 1280);
  await expect(panel(page).getByRole("heading", { name: "Outcome", exact: true })).toBeVisible();
  await expect(figure(page, "Declared")).toHaveText("106 s");
  await expect(figure(page, "Stated risk")).toHaveText(/^4\.\d+ %$/);
  await group(page, "Mission").click();
  await expect(figure(page, "Complete")).toHaveText("yes");
  await expect(figure(page, "Merit")).toHaveText("8.55");
  await expectAccessible(page, "aside");
});
