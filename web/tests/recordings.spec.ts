import { readFile } from "node:fs/promises";
import type { Page } from "@playwright/test";
import { expect, expectAccessible, runAt, test } from "./page";

const scenario = "scenario=search-beliefs&seed=7&run=2";

async function choose(page: Page, name: string): Promise<void> {
  await page.locator("summary", { hasText: "Export" }).click();
  await page.getByRole("button", { name }).click();
}

test("a run is saved, and its recording opens as that run", async ({ page, fake }) => {
  await page.goto(runAt(fake, `${scenario}&changes=[[5,%22robots.rover.count%22,6]]&tick=20`));
  await expect(page.locator("#status")).toContainText("6 robots");
  await choose(page, "Save recording");
  await expect(page.getByRole("progressbar", { name: "Saving the run" })).toBeVisible();
  await expectAccessible(page);
  await expect(page.getByText("Saved as recordings/search-beliefs-7-2-1.mcap")).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "Open", exact: true }).click();
  await expect(page.getByText("seed 7, run 2, recorded")).toBeVisible();
  await expect(page.locator("#status")).toContainText("0.0 s, 4 robots");
  await page.getByRole("slider", { name: "Time" }).fill("20");
  await expect(page.locator("#status")).toContainText("2.0 s, 6 robots");
  await expect.poll(() => page.url()).toMatch(/recording=recordings\/search-beliefs-7-2-1.mcap&tick=20/);
});

test("saving can be cancelled", async ({ page, fake }) => {
  await page.goto(runAt(fake, scenario));
  await choose(page, "Save recording");
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(page.getByRole("progressbar")).toHaveCount(0);
  await expect(page.getByText("Saved as")).toHaveCount(0);
});

test("the error of a failed save is displayed", async ({ page, fake }) => {
  await page.goto(runAt(fake, "scenario=flock"));
  await choose(page, "Save recording");
  await expect(page.getByRole("alert")).toContainText("takes no more");
  await expectAccessible(page);
});

test("recordings are listed, opened and downloaded", async ({ page, fake }) => {
  await page.goto(fake.url);
  await page.getByRole("link", { name: "Recordings" }).click();
  await expect(page.getByRole("cell", { name: /Cannot be opened: it is not an MCAP file/ })).toBeVisible();
  await expectAccessible(page);
  const [file] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "Download field.mcap" }).click(),
  ]);
  expect(await readFile(await file.path(), "utf8")).toBe("MCAP");
  await page.getByRole("link", { name: "field.mcap", exact: true }).click();
  await expect(page.getByText("seed 3, run 0, recorded")).toBeVisible();
});

test("the list of recordings is usable on a phone", async ({ page, fake }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await page.goto(`${fake.url}/#/recordings`);
  await expect(page.getByRole("link", { name: "field.mcap", exact: true })).toBeVisible();
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(360);
  await expectAccessible(page);
});

test("changes that do not fit into an address are saved, and the address names the recording", async ({
  page,
  fake,
  context,
}) => {
  const areas = Array.from({ length: 900 }, (_, i) => [i, i]);
  await page.goto(
    runAt(fake, `${scenario}&tick=3&changes=${JSON.stringify([[1, "terrain.mud", { areas_m: [areas] }]])}`),
  );
  await expect(page.locator("#status")).toContainText("0.3 s");
  await expect
    .poll(() => page.url(), { timeout: 15_000 })
    .toContain("recording=recordings/search-beliefs-7-2-1.mcap&tick=3");
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(other.locator("#status")).toContainText("0.3 s");
});

test("a large file of the user's own is saved, so that its address works elsewhere", async ({
  page,
  fake,
  context,
}) => {
  const noise = Array.from({ length: 9000 }, (_, i) => ((i * 2654435761) >>> 0).toString(36)).join("\n# ");
  const buffer = Buffer.from(`engine = "metric"\n# ${noise}`);
  await page.goto(fake.url);
  await page
    .locator("input[type=file]")
    .setInputFiles({ name: "my.toml", mimeType: "application/toml", buffer });
  await expect(page.locator("#status")).toContainText("4 robots");
  await expect.poll(() => page.url(), { timeout: 15_000 }).toContain("recording=recordings/");
  await page.getByRole("application").press(".");
  await expect.poll(() => page.url()).toContain("tick=1");
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(other.locator("#status")).toContainText("0.1 s, 4 robots");
});

test("a change in a recorded run makes a new run, whose address has all changes", async ({ page, fake }) => {
  await page.goto(runAt(fake, "recording=field.mcap&tick=30"));
  await expect(page.locator("#status")).toContainText("3.0 s, 6 robots");
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("2");
  await page.keyboard.press("Enter");
  await expect(page.locator("#status")).toContainText("2 robots");
  await expect
    .poll(() => decodeURIComponent(page.url()))
    .toContain('changes=[[20,"robots.rover.count",6],[30,"robots.rover.count",2]]');
  await page.getByRole("button", { name: "New run" }).click();
  await expect(page.getByText("the recording's scenario, including all changes")).toBeVisible();
  await page.getByRole("button", { name: "Start" }).click();
  await expect.poll(() => page.url()).toMatch(/text=z.*&seed=3&run=1/);
});

test("a missing recording is reported", async ({ page, fake }) => {
  await page.goto(runAt(fake, "recording=gone.mcap"));
  await expect(page.getByText("there is no such recording")).toBeVisible();
  await expectAccessible(page);
});

test("the scenario with its changes is saved as a file", async ({ page, fake }) => {
  await page.goto(runAt(fake, `${scenario}&tick=20`));
  await expect(page.locator("#status")).toContainText("2.0 s");
  const [saved] = await Promise.all([page.waitForEvent("download"), choose(page, "Scenario with changes")]);
  expect(saved.suggestedFilename()).toBe("search-beliefs-20.toml");
  expect(await readFile(await saved.path(), "utf8")).toContain("# From 20");
});
