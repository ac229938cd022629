import {
  asOnPhone,
  downloaded,
  expect,
  expectAccessible,
  expectToFit,
  hash,
  openRun,
  openTab,
  status,
  test,
  time_s,
} from "./page";
import { readFileSync } from "node:fs";

const scenario = "scenario=search&seed=3";
const events = (page: import("@playwright/test").Page) =>
  page.getByRole("region", { name: "List of events" });

test("events stand in a list that can be filtered and searched, and a click goes there", async ({
  page,
  server,
}) => {
  await openRun(page, server, `${scenario}&tick=2000`, "finished");
  await openTab(page, "Events");
  const all = events(page).getByRole("button");
  await expect(all.first()).toBeVisible();
  await expectAccessible(page);
  const kinds = page.getByRole("group", { name: "Kinds of events" });
  const found = kinds.getByRole("button", { name: /^Found/ });
  const count = Number(/\d+/.exec((await found.textContent()) ?? "")?.[0]);
  expect(count).toBeGreaterThan(0);
  await expect(page.getByRole("status").filter({ hasText: "events" })).toContainText(
    `${count + 1} of ${count + 1}`,
  );
  await page.getByRole("searchbox", { name: "Search events" }).fill("mine/0");
  await expect(all).toHaveCount(1);
  const label = (await all.getAttribute("aria-label")) ?? "";
  await all.click();
  await expect.poll(() => time_s(page)).toBe(Number.parseFloat(label.replace("Go to ", "")));
  await page.getByRole("searchbox", { name: "Search events" }).fill("");
  await found.click();
  await expect(found).toHaveAttribute("aria-pressed", "false");
  await expect(page.getByRole("button", { name: /^Go to .* found/ })).toHaveCount(0);
});

test("keys go from event to event", async ({ page, server }) => {
  await openRun(page, server, `${scenario}&tick=2000`, "finished");
  await openTab(page, "Events");
  const first = events(page).getByRole("button").first();
  const label = (await first.getAttribute("aria-label")) ?? "";
  const first_s = Number.parseFloat(label.replace("Go to ", ""));
  await page.getByRole("slider", { name: "Time" }).focus();
  await page.keyboard.press("Home");
  await expect.poll(() => time_s(page)).toBe(0);
  await page.getByRole("application").focus();
  await page.keyboard.press("]");
  await expect.poll(() => time_s(page)).toBe(first_s);
  await page.keyboard.press("]");
  await expect.poll(() => time_s(page)).toBeGreaterThan(first_s);
  await page.keyboard.press("[");
  await expect.poll(() => time_s(page)).toBe(first_s);
});

test("a change in the past keeps the future that it replaces: undo, redo and a click restore either", async ({
  page,
  server,
}) => {
  await openRun(page, server, `${scenario}&tick=400`, "40.0 s");
  const future = await hash(page);
  await page.getByRole("slider", { name: "Time" }).focus();
  await page.keyboard.press("Home");
  await expect.poll(() => time_s(page)).toBe(0);
  await openTab(page, "Parameters");
  const box = page.getByRole("spinbutton", { name: "Count of rover" });
  await box.fill("6");
  await box.press("Enter");
  await expect(status(page)).toContainText("6 robots");
  await page.getByRole("button", { name: "Undo" }).click();
  await expect(status(page)).toContainText("4 robots");
  // The future is still there.
  await page.getByRole("slider", { name: "Time" }).focus();
  await page.keyboard.press("End");
  await expect.poll(() => hash(page)).toBe(future);
  await page.getByRole("button", { name: "Redo" }).click();
  await expect(status(page)).toContainText("6 robots");
  await expect(page.getByRole("button", { name: "Redo" })).toBeDisabled();
  await openTab(page, "Events");
  await expectAccessible(page);
  await page.getByRole("button", { name: "Start no changes" }).click();
  await expect.poll(() => hash(page)).toBe(future);
  await page.getByRole("application").focus();
  await page.keyboard.press("Control+Shift+Z");
  await expect(status(page)).toContainText("6 robots");
});

test("numbers of a robot and of the run are drawn with one click, and saved as they are drawn", async ({
  page,
  server,
}) => {
  await openRun(page, server, `${scenario}&tick=300&robot=rover/1`, "30.0 s");
  const chart = page.getByRole("region", { name: "Chart" });
  await expect(chart).toHaveCount(0);
  await page.getByRole("button", { name: "Position over time" }).first().click();
  await expect(chart.getByText("rover/1 x")).toBeVisible();
  await page.getByRole("button", { name: "Speed over time" }).click();
  await openTab(page, "Results");
  await page.getByRole("button", { name: "found over time" }).click();
  await expect(chart.getByRole("listitem")).toHaveCount(4);
  await expect(chart.getByRole("status")).toHaveCount(0);
  await expectAccessible(page);
  await chart.getByRole("button", { name: /^Axis of .*found: right/ }).click();
  await expect(chart.getByRole("button", { name: /^Axis of .*found: left/ })).toBeVisible();
  const file = await downloaded(page, () => chart.getByRole("button", { name: "CSV" }).click());
  const [header, ...rows] = readFileSync(await file.path(), "utf8")
    .trim()
    .split("\n");
  expect(header).toBe(
    "tick,time_s,body/rover/1/x_m,body/rover/1/y_m,robot/rover/1/command/motion/speed_m_s,outcome/found",
  );
  expect(rows.length).toBe(301);
  const [tick, , x_m] = rows.at(-1)?.split(",") ?? [];
  expect(tick).toBe("300");
  await expect(chart.getByRole("listitem").first()).toContainText(
    Number(Number(x_m).toPrecision(5)).toString(),
  );
  await chart.getByRole("button", { name: /^Remove rover\/1 y/ }).click();
  await expect(chart.getByRole("listitem")).toHaveCount(3);
  await chart.getByRole("combobox", { name: "Add a signal" }).fill("rover/1 state of charge");
  await expect(chart.getByRole("listitem")).toHaveCount(4);
  // The address contains what is drawn.
  await expect.poll(() => page.url()).toContain("chart=body/rover/1/charge");
  await page.reload();
  await expect(chart.getByRole("listitem")).toHaveCount(4);
  await asOnPhone(page);
  await expectToFit(page);
  await expectAccessible(page);
  await chart.getByRole("button", { name: "Close the chart" }).click();
  await expect(chart).toHaveCount(0);
});
