import type { Locator, Page } from "@playwright/test";
import { expect, openRun, status, test, time_s } from "./page";

const maxTabs = 150;

/** Presses Tab until an element has the focus, as a person without a pointer does. */
async function tabTo(page: Page, target: Locator): Promise<void> {
  await expect(target).toBeVisible();
  for (let i = 0; i < maxTabs; i++) {
    if (await target.evaluate((element) => element === document.activeElement)) return;
    await page.keyboard.press("Tab");
  }
  throw new Error("the element is not reached with Tab");
}

async function press(page: Page, target: Locator): Promise<void> {
  await tabTo(page, target);
  await page.keyboard.press("Enter");
}

/** Opens a panel with arrow keys. */
async function openPanel(page: Page, name: string): Promise<void> {
  const tabs = page.getByRole("tablist", { name: "Panels" });
  await tabTo(page, tabs.getByRole("tab", { selected: true }));
  const wanted = tabs.getByRole("tab", { name, exact: true });
  for (let i = 0; i < 12 && (await wanted.getAttribute("aria-selected")) !== "true"; i++)
    await page.keyboard.press("ArrowRight");
  await expect(wanted).toHaveAttribute("aria-selected", "true");
}

test("a run is opened from the gallery, played, changed, undone and charted by keyboard alone", async ({
  page,
  server,
}) => {
  await page.goto(server.url);
  await press(page, page.locator('a.run[href*="scenario=search&"], a.run[href$="scenario=search"]').first());
  await expect(status(page)).toContainText("4 robots");
  await page.keyboard.press(".");
  await expect.poll(() => time_s(page)).toBe(0.1);
  await page.keyboard.press(" ");
  await expect.poll(() => time_s(page)).toBeGreaterThan(0.5);
  await page.keyboard.press(" ");
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "Keyboard shortcuts" })).toBeVisible();
  await page.keyboard.press("Escape");
  await openPanel(page, "Parameters");
  await tabTo(page, page.getByRole("spinbutton", { name: "Count of rover" }));
  await page.keyboard.press("Control+a");
  await page.keyboard.type("6");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("6 robots");
  await openPanel(page, "Events");
  await page.keyboard.press("Control+z");
  await expect(status(page)).toContainText("4 robots");
  await page.keyboard.press("Control+Shift+Z");
  await expect(status(page)).toContainText("6 robots");
  await openPanel(page, "Robot");
  await tabTo(page, page.getByRole("combobox", { name: "Robot", exact: true }));
  await page.keyboard.type("rover/1");
  await page.keyboard.press("Enter");
  await press(page, page.getByRole("button", { name: "Position over time" }).first());
  const chart = page.getByRole("region", { name: "Chart" });
  await expect(chart.getByRole("listitem")).toHaveCount(2);
  await press(page, chart.getByRole("button", { name: "Close the chart" }));
  await expect(chart).toHaveCount(0);
});

test("an event is found and displayed, and two runs are compared, by keyboard alone", async ({
  page,
  server,
}) => {
  await openRun(page, server, "scenario=search&seed=3&tick=2000", "finished");
  await openPanel(page, "Events");
  await tabTo(page, page.getByRole("searchbox", { name: "Search events" }));
  await page.keyboard.type("mine/0");
  const event = page.getByRole("region", { name: "List of events" }).getByRole("button");
  await expect(event).toHaveCount(1);
  const label = (await event.getAttribute("aria-label")) ?? "";
  await press(page, event);
  await expect.poll(() => time_s(page)).toBe(Number.parseFloat(label.replace("Go to ", "")));
  await press(page, page.getByRole("button", { name: "Compare" }));
  const dialog = page.getByRole("dialog", { name: "Compare" });
  await tabTo(page, dialog.getByRole("spinbutton", { name: "Count of rover" }));
  await page.keyboard.press("Control+a");
  await page.keyboard.type("7");
  await press(page, dialog.getByRole("button", { name: "Compare" }));
  await expect(page.locator("#status-B")).toContainText("7 robots");
  await page.keyboard.press(" ");
  await expect(page.getByRole("button", { name: "Pause" })).toBeVisible();
  await page.keyboard.press(" ");
  await expect(page.getByRole("button", { name: "Play" })).toBeVisible();
});

test("a study is formulated, started and stopped by keyboard alone", async ({ page, server }) => {
  await page.goto(`${server.url}/#/study/new?scenario=search`);
  await expect(page.getByRole("heading", { name: /^New study of search/ })).toBeVisible();
  await press(page, page.getByRole("button", { name: "Start", exact: true }));
  const stop = page.getByRole("button", { name: "Stop" });
  await expect(stop).toBeVisible();
  await press(page, stop);
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
});
