import { readFile } from "node:fs/promises";
import type { Page } from "@playwright/test";
import {
  downloaded,
  droppable,
  expect,
  expectAccessible,
  hash,
  openRun,
  openTab,
  runAt,
  status,
  test,
  time_s,
} from "./page";

const scenario = "scenario=search-beliefs&seed=7";

const count = (page: Page) => page.getByRole("spinbutton", { name: "Count of rover" });

async function setCount(page: Page, value: number): Promise<void> {
  await count(page).fill(String(value));
  await page.keyboard.press("Enter");
}

/** The time series as it is exported. */
async function series(page: Page): Promise<Record<string, number>[]> {
  await page.locator("summary", { hasText: "Export" }).click();
  const file = await downloaded(page, () => page.getByRole("button", { name: "Time series" }).click());
  const [head = "", ...lines] = (await readFile(await file.path(), "utf8")).trim().split("\n");
  const names = head.split(",");
  return lines.map((line) => {
    const values = line.split(",").map(Number);
    return Object.fromEntries(names.map((name, i) => [name, values[i] ?? Number.NaN]));
  });
}

async function finish(page: Page): Promise<void> {
  await page.getByRole("combobox", { name: "Speed" }).selectOption("Maximum");
  await page.getByRole("button", { name: "Play" }).click();
  await expect(status(page)).toContainText("finished");
}

test("at maximum speed the series has each find at its own time", async ({ page, server }) => {
  await openRun(page, server, scenario);
  await finish(page);
  await expect
    .poll(async () => (await series(page)).map((row) => row.found))
    .toEqual(expect.arrayContaining([0, 1, 2, 3, 4]));
  const rows = await series(page);
  const end = rows.at(-1) ?? {};
  for (const found of [1, 2, 3, 4]) {
    const first = rows.find((row) => (row.found ?? 0) >= found);
    // An item is found in the step before the first row that has it.
    const later_s = (first?.time_s ?? 0) - (end[`found_mine_${found}_s`] ?? 0);
    expect(later_s).toBeCloseTo(0.1);
  }
});

test("a run that is opened at a moment has the series before it", async ({ page, server }) => {
  await openRun(page, server, `${scenario}&tick=250`, "25.0 s");
  await expect.poll(async () => (await series(page)).length).toBeGreaterThan(5);
  expect((await series(page))[0]?.tick).toBe(0);
});

test("a run is studied as it is on the screen, with its changes", async ({ page, server }) => {
  await openRun(page, server, `${scenario}&tick=20`, "2.0 s");
  await openTab(page, "Parameters");
  await setCount(page, 6);
  await expect(status(page)).toContainText("6 robots");
  const [request] = await Promise.all([
    page.waitForRequest(/api\/factors/),
    page.getByRole("button", { name: "Study this scenario with your 1 change" }).click(),
  ]);
  expect(request.postDataJSON().text).toContain("count = 6");
  await expect(page.getByRole("heading", { name: /^New study of/ })).toBeVisible();
});

test("a damaged address names what could not be read, and opens nothing", async ({ page, server }) => {
  await page.goto(runAt(server, `${scenario}&tick=1.5&changes=[[1,`));
  await expect(page.getByRole("heading", { name: "This address is damaged" })).toBeVisible();
  await expect(page.getByRole("listitem")).toHaveText(["tick=1.5", "changes=[[1,"]);
  await expectAccessible(page);
});

test("a change made while the server is away is listed, and made when it is back", async ({
  page,
  server,
}) => {
  const connection = await droppable(page);
  await openRun(page, server, `${scenario}&tick=20`, "2.0 s, 4 robots");
  await openTab(page, "Parameters");
  await connection.drop();
  await expect(page.getByText("The connection is lost.").first()).toBeVisible();
  await setCount(page, 7);
  await expect(page.getByText("Then 1 change will be made: robots.rover.count.")).toBeVisible();
  await expect(count(page)).toHaveValue("4");
  await page.locator("summary", { hasText: "Export" }).click();
  await page.getByRole("button", { name: "Scenario with changes" }).click();
  await expect(page.getByText("could not be exported")).toBeVisible();
  connection.restore();
  await page.getByRole("button", { name: "Try now" }).click();
  await expect(status(page)).toContainText("2.0 s, 7 robots");
  await expect(count(page)).toHaveValue("7");
});

test("a change after the end goes back before it, once confirmed", async ({ page, server }) => {
  await openRun(page, server, scenario);
  await finish(page);
  const [end_s, there] = [await time_s(page), await hash(page)];
  await openTab(page, "Parameters");
  await setCount(page, 6);
  const dialog = page.getByRole("dialog", { name: "The run is over" });
  await expect(dialog).toBeVisible();
  await expectAccessible(page);
  await dialog.getByRole("button", { name: "Change nothing" }).click();
  await expect(dialog).toHaveCount(0);
  expect(await hash(page)).toBe(there);
  await setCount(page, 6);
  await dialog.getByRole("button", { name: "Go back and change" }).click();
  await expect(status(page)).toContainText("6 robots");
  expect(await time_s(page)).toBeCloseTo(end_s - 0.1);
  await expect(status(page)).toContainText("paused");
});
