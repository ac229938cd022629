import { readFile } from "node:fs/promises";
import { expect, test } from "../page";

test("a saved run opens as the same run, to the bit", async ({ page, server }) => {
  const status = page.locator("#status");
  const hash = () => page.getByTitle("Hash of the run's state").getAttribute("title");
  const change = encodeURIComponent(JSON.stringify([[10, "robots.rover.count", 7]]));
  await page.goto(`${server.url}/#/run?scenario=search-beliefs&seed=7&changes=${change}&tick=40`);
  await expect(status).toContainText("4.0 s, 7 robots");
  const there = await hash();
  await page.locator("summary", { hasText: "Export" }).click();
  await page.getByRole("button", { name: "Save recording" }).click();
  await expect(page.getByText("Saved as recordings/search-beliefs-7-0-")).toBeVisible();
  await page.getByRole("link", { name: "All recordings" }).last().click();
  await page.getByRole("link", { name: /^recordings\/search-beliefs-7-0-/ }).click();
  await expect(status).toContainText("0.0 s, 4 robots");
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill((await slider.getAttribute("max")) ?? "");
  await expect(status).toContainText("4.0 s, 7 robots");
  await expect.poll(hash).toBe(there);
  await expect.poll(() => page.url()).toMatch(/recording=recordings.*tick=40/);
});

test("the scenario with its changes can be opened as a file", async ({ page, server }) => {
  const change = encodeURIComponent(JSON.stringify([[0, "robots.rover.count", 3]]));
  await page.goto(`${server.url}/#/run?scenario=search-beliefs&changes=${change}`);
  await expect(page.locator("#status")).toContainText("3 robots");
  await page.locator("summary", { hasText: "Export" }).click();
  const [saved] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("button", { name: "Scenario with changes" }).click(),
  ]);
  const buffer = await readFile(await saved.path());
  await page.goto(server.url);
  await page
    .locator("input[type=file]")
    .setInputFiles({ name: "again.toml", mimeType: "application/toml", buffer });
  await expect(page.locator("#status")).toContainText("3 robots");
});
