import type { Page } from "@playwright/test";
import { expect, expectAccessible } from "./page";
import { test } from "./studies";

/** The narrowest and the widest window that the page is made for. */
const widths = [390, 1920];

async function expectViewAccessible(page: Page, address: string, heading: RegExp | string): Promise<void> {
  await page.goto("about:blank");
  await page.goto(address);
  await expect(page.getByRole("heading", { name: heading }).first()).toBeVisible();
  for (const width of widths) {
    await page.setViewportSize({ width, height: 900 });
    const overflow = () => document.documentElement.scrollWidth - document.documentElement.clientWidth;
    expect(await page.evaluate(overflow), `${address} at ${width} px`).toBe(0);
    await expectAccessible(page);
  }
}

test("every view passes axe at 390 and at 1,920 pixels, light and dark, and none is too wide", async ({
  page,
  server,
  answered,
}) => {
  test.slow();
  const run = "scenario=search&seed=3&tick=100";
  const side = encodeURIComponent(run);
  const views: [address: string, heading: RegExp | string][] = [
    ["#/", "Scenarios"],
    [`#/run?${run}&robot=rover/1&chart=outcome/found`, "search"],
    [`#/compare?left=${side}&right=${side}`, "Comparison"],
    ["#/studies", "Studies"],
    ["#/study/new?scenario=search", "New study"],
    [`#/study?id=${answered}`, "search"],
    [`#/study/compare?a=${answered}&b=${answered}`, "Comparison of studies"],
    ["#/recordings", "Recordings"],
  ];
  for (const [address, heading] of views)
    await expectViewAccessible(page, `${server.url}/${address}`, heading);
});
