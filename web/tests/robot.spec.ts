import type { Page } from "@playwright/test";
import {
  altered,
  asOnPhone,
  expect,
  expectAccessible,
  expectToFit,
  openRun,
  type RealServer,
  status,
  test,
} from "./page";

const sections = ["Command", "Percept", "Goals", "Headings", "Items", "Map"];

/** Opens a run and makes five steps: a selected robot has a percept from its next decision on. */
async function open(
  page: Page,
  server: RealServer,
  scenario = "search-beliefs",
  [seed, tick] = [7, 90],
): Promise<void> {
  const time = (steps: number) => `${((tick + steps) / 10).toFixed(1)} s`;
  await openRun(page, server, `scenario=${scenario}&seed=${seed}&robot=rover/1&tick=${tick}`, time(0));
  for (let i = 1; i <= 5; i += 1) {
    await page.keyboard.press(".");
    await expect(status(page)).toContainText(time(i));
  }
}

test("percept, command, goals and beliefs of the selected robot are displayed", async ({ page, server }) => {
  // Values that few robots have at the same time.
  await altered(page, (message) => {
    if (message.type !== "state" || !message.inspection) return message;
    const { percept, belief_state } = message.inspection;
    message.inspection.holds_s = [0, 0, 1.5];
    if (percept) percept.touch = null;
    for (const goal of belief_state?.goals ?? []) goal.stuck_s = 6.2;
    return message;
  });
  // It sees an item.
  await open(page, server, "search-beliefs", [1, 83]);
  const panel = page.getByRole("tabpanel");
  await expect(panel.getByRole("row", { name: /bayesian_search active/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /avoid held for 1.5 s/ })).toBeVisible();
  await expect(panel.getByText("0.97 m/s").first()).toBeVisible();
  await expect(panel.getByText("1 about the sender")).toBeVisible();
  await expect(panel.getByRole("img", { name: /^Percept around the robot/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /Item: mine 0\.8 m, 15° left 0\.20$/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /Touch no reading/ })).toBeVisible();
  await expect(panel.getByText(/Pursued: 1\.2 m left/)).toBeVisible();
  await expect(panel.getByText(/no progress for 6 s/)).toBeVisible();
});

test("sections open by keyboard, and stay open for the next robot", async ({ page, server }) => {
  await open(page, server);
  const reach = page.getByRole("region", { name: "Utility of all headings" });
  await expect(page.locator("summary", { hasText: "Headings" })).toBeVisible();
  await expect(reach).toBeHidden();
  await page.locator("summary", { hasText: "Headings" }).focus();
  await page.keyboard.press("Enter");
  await expect(reach.getByRole("row")).toHaveCount(41);
  await expect(reach.getByRole("row", { name: /chosen/ })).toHaveCount(1);
  await page.locator("summary", { hasText: "Percept" }).click();
  await page.getByRole("button", { name: "Next" }).click();
  await expect.poll(() => page.url()).toContain("robot=rover/2");
  await expect(reach).toBeVisible();
  await expect(page.getByRole("img", { name: /^Percept around the robot/ })).toBeHidden();
});

test("its map is summarised in numbers", async ({ page, server }) => {
  await open(page, server);
  await page.locator("summary", { hasText: "Map" }).click();
  await expect(page.getByText("50 × 50 of 0.50 m")).toBeVisible();
  const part = page.getByRole("row", { name: /Unknown \(hatched\)/ });
  await expect(part).toHaveText(/[1-9]\d%$/);
});

test("a followed robot stays in the centre until the view is panned", async ({ page, server }) => {
  await open(page, server);
  const box = page.getByRole("checkbox", { name: "Follow" });
  await expect(box).not.toBeChecked();
  await page.keyboard.press("f");
  await expect(box).toBeChecked();
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("running");
  await expect(status(page)).not.toHaveText(/^9\.5 s/);
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("paused");
  const picture = page.getByRole("application");
  const frame = await picture.boundingBox();
  if (!frame) throw new Error("there is no picture");
  // The robot in the centre is the followed one.
  await page
    .getByRole("textbox", { name: "Robot" })
    .or(page.getByRole("combobox", { name: "Robot" }))
    .fill("");
  await page.keyboard.press("Enter");
  await picture.click({ position: { x: frame.width / 2, y: frame.height / 2 } });
  await expect.poll(() => page.url()).toContain("robot=rover/1");
  await picture.focus();
  await page.keyboard.press("ArrowLeft");
  await expect(box).not.toBeChecked();
});

test("a robot with a reactive brain has a percept and a command", async ({ page, server }) => {
  await open(page, server, "search");
  await expect(page.getByText("reactive brain")).toBeVisible();
  await expect(page.getByText("1.00 m/s").first()).toBeVisible();
  await expect(page.locator("summary")).not.toContainText(["Goals"]);
  await expectAccessible(page);
});

test("the panel passes axe with all sections open, also on a phone", async ({ page, server }) => {
  await open(page, server);
  for (const name of sections) {
    const section = page.locator("details", { hasText: name }).first();
    if ((await section.getAttribute("open")) === null) await section.locator("summary").click();
  }
  await expectAccessible(page);
  await asOnPhone(page);
  await page.getByRole("button", { name: "Panels", exact: true }).click();
  await expectAccessible(page);
  await expectToFit(page);
  const panel = page.getByRole("tabpanel");
  expect(await panel.evaluate((element) => element.scrollWidth - element.clientWidth)).toBe(0);
});
