import type { Page } from "@playwright/test";
import { inkAt, opens, type View } from "./ink";
import { expect, expectAccessible, expectAccessiblePanels, openRun, openTab, status, test } from "./page";

const view: View = [150, 150, 2];
const run = `scenario=waypoints&seed=7&run=0&tick=200&${opens(view)}`;
const layer = "Goals and controllers";

test("goals and controllers are drawn and sent while their layer is on", async ({ page, server }) => {
  const requested: boolean[] = [];
  page.on("websocket", (line) => {
    line.on("framesent", ({ payload }) => {
      const message = JSON.parse(String(payload));
      if (message.type === "show") requested.push(message.layers.includes("economy"));
    });
  });
  await openRun(page, server, run, "8 robots");
  await openTab(page, "Layers");
  await page.getByRole("checkbox", { name: "Grid and scale" }).uncheck();
  // The controller's square, and a goal that is not served yet.
  await expect.poll(() => inkAt(page, view, [150, 150])).toBe(true);
  await expect.poll(() => inkAt(page, view, [15.5 - 2.5, 270.1])).toBe(true);
  await page.getByRole("checkbox", { name: layer }).uncheck();
  await expect.poll(() => inkAt(page, view, [150, 150])).toBe(false);
  expect(requested.at(-1)).toBe(false);
  await page.getByRole("checkbox", { name: layer }).check();
  await expect.poll(() => inkAt(page, view, [150, 150])).toBe(true);
});

test("a click on a controller shows its goals", async ({ page, server }) => {
  await openRun(page, server, run, "8 robots");
  await expect.poll(() => inkAt(page, view, [150, 150])).toBe(true);
  const box = await page.getByRole("application", { name: "World view" }).boundingBox();
  if (!box) throw new Error("there is no view");
  // The controller is at the centre of the view.
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
  await expect(page.getByRole("heading", { name: "Goals of base/0" })).toBeVisible();
});

test("a run without goals has neither the layer nor the panel", async ({ page, server }) => {
  await openRun(page, server, "scenario=open-field&seed=7&run=0");
  await openTab(page, "Layers");
  await expect(page.getByRole("checkbox", { name: "Radio links" })).toBeVisible();
  await expect(page.getByRole("checkbox", { name: layer })).toHaveCount(0);
  await expect(page.getByRole("tab", { name: "Goals" })).toHaveCount(0);
});

test("the robot panel displays owner and lease of the goals that the robot serves", async ({
  page,
  server,
}) => {
  await openRun(page, server, `${run}&robot=rover/0`, "8 robots");
  const served = page.locator("details", { hasText: "Goals served" }).locator("tbody tr");
  await expect(served).toHaveCount(4);
  await expect(served.first()).toHaveText(/spot\/\d+\s*base\/0\s*\d+\.\d s\s*(approaching|receding)/);
  // Also while the layer is off.
  await openTab(page, "Layers");
  await page.getByRole("checkbox", { name: layer }).uncheck();
  await openTab(page, "Robot");
  await expect(served).toHaveCount(4);
});

test("controllers that are added during a run are listed, and one is chosen", async ({ page, server }) => {
  await openRun(page, server, run, "8 robots");
  await openTab(page, "Parameters");
  await page.getByRole("searchbox").fill("controllers.base");
  await page.getByRole("spinbutton", { name: "controllers.base.count" }).fill("3");
  await page.keyboard.press("Enter");
  await page.getByRole("combobox", { name: "controllers.base.allocation" }).selectOption("nearest");
  await expect(page.getByRole("button", { name: "Study this scenario with your 2 changes" })).toBeVisible();
  await openTab(page, "Goals");
  const controllers = page
    .locator("table")
    .first()
    .getByRole("button", { name: /^base\/\d$/ });
  await expect(controllers).toHaveText(["base/0", "base/1", "base/2"]);
  await expect(page.getByRole("button", { name: /^awarded \d+$/ })).toBeVisible();
  await controllers.nth(1).click();
  await expect(controllers.nth(1)).toHaveAttribute("aria-pressed", "true");
  await expect(page.getByRole("heading", { name: "Goals of base/1" })).toBeVisible();
  await controllers.nth(1).click();
  // The others vote for the owner once they have received each other.
  await page.getByRole("button", { name: "Play" }).click();
  await expect(page.getByText(/votes of base\/\d/).first()).toBeVisible();
  await page.getByRole("button", { name: "Pause" }).click();
  await expect(status(page)).toContainText("paused");
});

test("the panels of a run with goals are accessible", async ({ page, server }) => {
  await openRun(page, server, `${run}&robot=rover/0`, "8 robots");
  await expectAccessiblePanels(page, ["Robot", "Goals", "Layers"]);
});

const goals = (page: Page) => page.getByRole("tabpanel").locator("table").last().locator("tbody tr");

for (const width of [390, 1280]) {
  test(`goals are filtered by status and text, and one is marked in the view, at ${width} px`, async ({
    page,
    server,
  }) => {
    await page.setViewportSize({ width, height: 800 });
    await openRun(page, server, run, "8 robots");
    if (width < 821) await page.getByRole("button", { name: "Panels", exact: true }).click();
    await openTab(page, "Goals");
    await expect(goals(page)).toHaveCount(60);
    const served = page.getByRole("button", { name: "served 7" });
    await expect(served).toHaveAttribute("aria-pressed", "true");
    for (const name of [/^open/, /^awarded/]) await page.getByRole("button", { name }).press("Enter");
    await expect(goals(page)).toHaveCount(7);
    await expect(page.getByText("7 of 60 rows")).toBeVisible();
    for (const name of [/^open/, /^awarded/]) await page.getByRole("button", { name }).click();
    const search = page.getByRole("searchbox", { name: "Search goals" });
    await search.fill("no such goal");
    await expect(page.getByText("0 of 60 rows")).toBeVisible();
    await search.fill("spot/59");
    await expect(goals(page)).toHaveCount(1);
    await expectAccessible(page, "aside");
    await goals(page).getByRole("button", { name: "spot/59" }).press("Enter");
    // The view is centred on it: [224.4, 45.9].
    await expect.poll(() => page.url()).toContain("view=224.4,45.9,2");
    await expect.poll(() => inkAt(page, [224.4, 45.9, 2], [224.4 + 9, 45.9])).toBe(true);
    // On a phone, the panels no longer hide it.
    const view = page.getByRole("application", { name: "World view" });
    if (width < 821) await expect(page.getByRole("tabpanel")).toBeHidden();
    if (width < 821) await expect(view).toBeFocused();
    else await expect(goals(page).getByRole("button")).toHaveAttribute("aria-pressed", "true");
  });
}

test("a second click on a goal takes its mark away", async ({ page, server }) => {
  await openRun(page, server, run, "8 robots");
  await openTab(page, "Goals");
  const goal = goals(page).getByRole("button", { name: "spot/59" });
  await goal.click();
  await expect(goal).toHaveAttribute("aria-pressed", "true");
  await goal.click();
  await expect(goal).toHaveAttribute("aria-pressed", "false");
  await expect.poll(() => inkAt(page, [224.4, 45.9, 2], [224.4 + 9, 45.9])).toBe(false);
});
