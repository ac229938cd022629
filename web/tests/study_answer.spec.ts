import type { Page } from "@playwright/test";
import { downloaded, expect, expectAccessible, status, time_s } from "./page";
import { openAnswer, recommendation, test } from "./studies";

const meritChart = (page: Page) => page.getByRole("img", { name: /^Figure of merit with its interval/ });

test("an answer has its verdict, guarantee, charts with tables, and files", async ({
  page,
  server,
  answered,
}) => {
  await openAnswer(page, server, answered);
  await expect(page.getByText(/a run takes [\d.]+ s on average/i)).toBeVisible();
  await expect(page.getByText(/^95% confidence; differences under 0.3 merit/)).toBeVisible();
  await expect(page.getByText("selected one with 95% confidence")).toBeVisible();
  await expect(meritChart(page).locator("svg")).toBeVisible();
  await expect(page.getByRole("row", { name: /^4 rovers/ }).first()).toBeVisible();
  const prices = page.getByRole("region", { name: "Price, time and failures" });
  await prices.getByText("Table of values").click();
  await expect(prices.getByRole("columnheader", { name: "mean time, s" })).toBeVisible();
  await expectAccessible(page);
  const saved = await downloaded(page, () => page.getByRole("link", { name: "Report (HTML)" }).click());
  expect(saved.suggestedFilename()).toMatch(/^search.*-report\.html$/);
});

test("a run that is watched from an answer is the median run of the selected team", async ({
  page,
  server,
  answered,
}) => {
  await openAnswer(page, server, answered);
  const link = page.getByRole("link", { name: "Watch a run" });
  await expect(link).toHaveAttribute("title", "The median run of the selected team");
  await link.click();
  await expect(page.getByRole("heading", { name: /^Run \d+ of search, \d rovers?$/ })).toBeVisible();
});

test("charts follow the theme and the width of the window", async ({ page, server, answered }) => {
  await openAnswer(page, server, answered);
  const chart = meritChart(page);
  const [svg, title] = [chart.locator("svg").first(), chart.locator(".role-axis-title text").first()];
  const width = () => svg.evaluate((element) => element.getBoundingClientRect().width);
  const ink = () => title.evaluate((text) => getComputedStyle(text).fill);
  await expect.poll(width).toBeGreaterThan(900);
  const before = await ink();
  await page.setViewportSize({ width: 700, height: 800 });
  await expect.poll(width).toBeLessThan(660);
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(ink).not.toBe(before);
});

test("a click on a point of a chart opens the runs of its configuration, and from there a run", async ({
  page,
  server,
  answered,
}) => {
  await openAnswer(page, server, answered);
  const chart = meritChart(page);
  await chart.locator(".mark-symbol.role-mark path").nth(3).click();
  const dialog = page.getByRole("dialog", { name: "Runs of 4 rovers" });
  await expect(dialog.getByRole("row", { name: /^worst/ })).toBeVisible();
  await expect(dialog.getByRole("row", { name: /^median/ })).toBeVisible();
  await expectAccessible(page);
  // It ends before 100 s, from where on the table rounds to seconds.
  const row = dialog.getByRole("row", { name: /^best/ });
  const run = (await row.getByRole("link").textContent()) ?? "";
  const tabled_s = Number(await row.getByRole("cell").nth(2).textContent());
  await row.getByRole("link").click();
  await expect(page.getByRole("heading", { name: `Run ${run} of search, 4 rovers` })).toBeVisible();
  await expect(status(page)).toContainText("4 robots");
  await expectAccessible(page);
  await page.getByRole("combobox", { name: /[Ss]peed/ }).selectOption({ index: 6 });
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await expect(status(page)).toContainText("finished");
  expect(Math.abs((await time_s(page)) - tabled_s)).toBeLessThan(0.2);
  await page.getByRole("link", { name: "Back to the study" }).click();
  await expect(dialog).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(dialog).toBeHidden();
  await expect(recommendation(page)).toBeVisible();
  await expect.poll(() => page.url()).not.toContain("configuration");
  // Back to the run, not to the dialog that was closed.
  await page.goBack();
  await expect(page.getByRole("heading", { name: `Run ${run} of search, 4 rovers` })).toBeVisible();
  await expect(dialog).toBeHidden();
});

test("all runs of a configuration can be paged through", async ({ page, server, answered }) => {
  await openAnswer(page, server, answered);
  await page.getByRole("link", { name: "4 rovers" }).first().click();
  await page.getByText("All runs", { exact: true }).click();
  await expect(page.getByText(/^1 to 50 of [\d,]+, in order/)).toBeVisible();
  await page.getByRole("button", { name: "Next" }).click();
  await expect(page.getByText(/^51 to 100 of/)).toBeVisible();
  await expect(page.getByRole("link", { name: "Watch run 50", exact: true })).toBeVisible();
  await page.getByRole("button", { name: "Previous" }).click();
  await expect(page.getByText(/^1 to 50 of/)).toBeVisible();
});
