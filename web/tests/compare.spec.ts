import { readFileSync } from "node:fs";
import type { Page } from "@playwright/test";
import { asOnPhone, downloaded, expect, expectAccessible, expectToFit, openRun } from "./page";
import { post, summaryOf, test } from "./studies";

const statusOf = (page: Page, run: "A" | "B") => page.locator(`#status-${run}`);

/** The simulated time that the status of a run states. */
async function time_s(page: Page, run: "A" | "B"): Promise<number> {
  return Number.parseFloat((await statusOf(page, run).textContent()) ?? "");
}

async function compareTeams(page: Page, server: { url: string }): Promise<void> {
  await openRun(page, server, "scenario=search&seed=3&tick=100", "10.0 s");
  await page.getByRole("button", { name: "Compare" }).click();
  const dialog = page.getByRole("dialog", { name: "Compare" });
  await dialog.getByRole("spinbutton", { name: "Count of rover" }).fill("8");
  await expectAccessible(page);
  await dialog.getByRole("button", { name: "Compare" }).click();
  await expect(statusOf(page, "A")).toContainText("10.0 s, 4 robots");
  await expect(statusOf(page, "B")).toContainText("10.0 s, 8 robots");
}

test("a run and the same one with another team play with one clock", async ({ page, server }) => {
  await compareTeams(page, server);
  await expect(page.getByRole("row", { name: "robots.rover.count 4 8" })).toBeVisible();
  await expect(page.getByRole("row", { name: "Time 10.0 s so far 10.0 s so far" })).toBeVisible();
  await expect(page.getByRole("row", { name: "Complete not yet not yet" })).toBeVisible();
  await expect(page.getByRole("row", { name: "Robots 4 8 4" })).toBeVisible();
  await page.getByRole("combobox", { name: "Speed" }).selectOption({ label: "× 10" });
  await page.getByRole("button", { name: "Play" }).click();
  await expect.poll(() => time_s(page, "A")).toBeGreaterThan(15);
  await page.getByRole("button", { name: "Pause" }).click();
  await expect.poll(async () => (await time_s(page, "A")) - (await time_s(page, "B"))).toBe(0);
  await expectAccessible(page);
  await page.getByRole("slider", { name: "Time of both runs" }).focus();
  await page.keyboard.press("Home");
  await expect(statusOf(page, "A")).toContainText("0.0 s");
  await expect(statusOf(page, "B")).toContainText("0.0 s");
  await page.keyboard.press(".");
  await expect(statusOf(page, "A")).toContainText("0.1 s");
  await expect(statusOf(page, "B")).toContainText("0.1 s");
  await page.reload();
  await expect(statusOf(page, "B")).toContainText("8 robots");
});

test("signals of both runs are drawn over each other, and saved", async ({ page, server }) => {
  await compareTeams(page, server);
  const chart = page.getByRole("region", { name: "Chart" });
  await chart.getByRole("combobox", { name: "Add a signal" }).fill("distance");
  await expect(chart.getByRole("listitem")).toContainText(/A [\d.]+, B [\d.]+ m/);
  const file = await downloaded(page, () => chart.getByRole("button", { name: "CSV" }).click());
  const [header, ...rows] = readFileSync(await file.path(), "utf8")
    .trim()
    .split("\n");
  expect(header).toBe("tick,time_s,A/outcome/distance_m,B/outcome/distance_m");
  expect(rows.at(-1)).toMatch(/^100,10,[\d.]+,[\d.]+$/);
});

test("a run is compared with itself before the last change, and by its address with another one", async ({
  page,
  server,
}) => {
  const changed = "scenario=search&seed=3&tick=20&changes=[[10,%22robots.rover.count%22,6]]";
  await openRun(page, server, changed, "2.0 s, 6 robots");
  const address = page.url();
  await page.getByRole("button", { name: "Compare" }).click();
  const dialog = page.getByRole("dialog", { name: "Compare" });
  await dialog.getByRole("radio", { name: "The same run without the last change" }).check();
  await dialog.getByRole("button", { name: "Compare" }).click();
  await expect(statusOf(page, "A")).toContainText("2.0 s, 6 robots");
  await expect(statusOf(page, "B")).toContainText("2.0 s, 4 robots");
  await openRun(page, server, "scenario=search&seed=5&tick=20", "2.0 s, 4 robots");
  await page.getByRole("button", { name: "Compare" }).click();
  await dialog.getByRole("radio", { name: "Another run or recording" }).check();
  const field = dialog.getByRole("textbox");
  await field.fill("http://example.org/");
  await expect(dialog.getByRole("alert")).toContainText("not the address of a run");
  await expect(dialog.getByRole("button", { name: "Compare" })).toBeDisabled();
  await field.fill(address);
  await dialog.getByRole("button", { name: "Compare" }).click();
  await expect(statusOf(page, "B")).toContainText("2.0 s, 6 robots");
});

test("a run that cannot be opened is reported beside the other one, and nothing is compared", async ({
  page,
  server,
}) => {
  const other = "scenario=search&seed=3&tick=20&changes=[[0,%22robots.rover.count%22,100000000]]";
  const run = (query: string) => encodeURIComponent(query);
  await page.goto(
    `${server.url}/#/compare?left=${run("scenario=search&seed=3&tick=20")}&right=${run(other)}`,
  );
  await expect(statusOf(page, "A")).toContainText("2.0 s, 4 robots");
  const failed = page.getByRole("region", { name: "Run B" });
  await expect(failed.getByRole("alert")).toContainText("robots.rover.count = 100000000");
  await expect(failed.getByRole("application")).toHaveCount(0);
  await expect(page.getByText("What differs is listed when both runs are open.")).toBeVisible();
  await expectAccessible(page);
});

test("a comparison is usable on a phone, and a damaged address is reported", async ({ page, server }) => {
  await compareTeams(page, server);
  await asOnPhone(page);
  await expectToFit(page);
  await expectAccessible(page);
  await page.goto(`${server.url}/#/compare?left=scenario%3Dsearch%26tick%3Dx`);
  await expect(page.getByText("left: tick=x")).toBeVisible();
});

test("two studies stand side by side with what differs in question, evidence and verdict", async ({
  page,
  server,
  answered,
}) => {
  const request = { scenario: "search", vary: { "robots.rover.count": "2..4" }, delta: 0.4, seed: "2" };
  const { id } = await post(server, "studies", request);
  await expect.poll(async () => (await summaryOf(server, id)).state, { timeout: 120_000 }).toBe("answered");
  await page.goto(`${server.url}/#/study?id=${answered}`);
  await page.getByRole("combobox", { name: "Compare with another study" }).selectOption(id);
  await expect(page.getByRole("heading", { name: "Comparison of studies" })).toBeVisible();
  await expect(page.getByRole("row", { name: "delta 0.3 0.4" })).toBeVisible();
  await expect(page.getByRole("row", { name: /^5 rovers .* not compared$/ })).toBeVisible();
  await expectAccessible(page);
  await page.goto(`${server.url}/#/study/compare?a=studies/none&b=${id}`);
  await expect(page.getByRole("alert")).toContainText("studies/none");
});
