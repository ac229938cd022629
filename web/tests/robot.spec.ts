import { expect, expectAccessible, live, test } from "./page";

const scenario = "scenario=search-beliefs&seed=7&robot=rover/1";
const sections = ["Command", "Percept", "Goals", "Reach", "Items", "Map"];

test("of a selected robot is told what it perceives, decides, wants and believes", async ({ page, fake }) => {
  await page.goto(live(fake, scenario));
  const panel = page.getByRole("tabpanel");
  await expect(panel.getByRole("row", { name: /bayesian_search has its way/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /avoid holds for 1.5 s/ })).toBeVisible();
  await expect(panel.getByText("0.80 m/s").first()).toBeVisible();
  await expect(panel.getByText("1 about itself")).toBeVisible();
  await expect(panel.getByRole("img", { name: /perceives around it/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /Item: mine 2\.0 m, 23° left 0\.00$/ })).toBeVisible();
  await expect(panel.getByRole("row", { name: /Touch no reading/ })).toBeVisible();
  await expect(panel.getByText(/Goes there now: 4\.2 m left/)).toBeVisible();
  await expect(panel.getByText(/no nearer for 6 s/)).toBeVisible();
});

test("sections open by keyboard, and stay so for the next robot", async ({ page, fake }) => {
  await page.goto(live(fake, scenario));
  const reach = page.getByRole("region", { name: "Worth of all courses" });
  await expect(page.locator("summary", { hasText: "Reach" })).toBeVisible();
  await expect(reach).toBeHidden();
  await page.locator("summary", { hasText: "Reach" }).focus();
  await page.keyboard.press("Enter");
  await expect(reach.getByRole("row")).toHaveCount(41);
  await expect(reach.getByRole("row", { name: /taken/ })).toHaveCount(1);
  await page.locator("summary", { hasText: "Percept" }).click();
  await page.getByRole("button", { name: "Next" }).click();
  await expect.poll(() => page.url()).toContain("robot=rover/2");
  await expect(reach).toBeVisible();
  await expect(page.getByRole("img", { name: /perceives around it/ })).toBeHidden();
});

test("its map is told in numbers too", async ({ page, fake }) => {
  await page.goto(live(fake, scenario));
  await page.locator("summary", { hasText: "Map" }).click();
  await expect(page.getByText("25 × 25 of 1.00 m")).toBeVisible();
  const part = page.getByRole("row", { name: /Unknown, hatched/ });
  await expect(part).toHaveText(/[1-9]\d%$/);
});

test("a robot that is followed stays in the middle until the picture is moved by hand", async ({
  page,
  fake,
}) => {
  await page.goto(live(fake, scenario));
  const box = page.getByRole("checkbox", { name: "Keep it in the middle" });
  await expect(box).not.toBeChecked();
  await page.keyboard.press("f");
  await expect(box).toBeChecked();
  await page.keyboard.press("Space");
  await page.waitForTimeout(500);
  await page.keyboard.press("Space");
  await expect(page.locator("#status")).toContainText("paused");
  const picture = page.getByRole("application");
  const frame = await picture.boundingBox();
  if (!frame) throw new Error("there is no picture");
  // The one in the middle is the one that is followed.
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

test("a robot without a mind has a percept and a command", async ({ page, fake }) => {
  await page.goto(live(fake, "scenario=crowd-5&robot=rover/1"));
  await expect(page.getByText("It has no mind")).toBeVisible();
  await expect(page.getByText("0.80 m/s").first()).toBeVisible();
  await expect(page.locator("summary")).not.toContainText(["Goals"]);
  await expectAccessible(page);
});

test("the panel has no fault that axe finds, all of it open, also on a phone", async ({ page, fake }) => {
  await page.goto(live(fake, scenario));
  for (const name of sections) {
    const section = page.locator("details", { hasText: name }).first();
    if ((await section.getAttribute("open")) === null) await section.locator("summary").click();
  }
  await expectAccessible(page);
  await page.setViewportSize({ width: 360, height: 740 });
  await page.getByRole("button", { name: "Panels", exact: true }).click();
  await expectAccessible(page);
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(360);
  const panel = page.getByRole("tabpanel");
  expect(await panel.evaluate((element) => element.scrollWidth - element.clientWidth)).toBe(0);
});
