import { rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { expect, expectAccessible, ownScenario, runAt, test } from "./page";

const faulty = `${ownScenario}raduis_m = 0.25\n`;
const file = (text: string) => ({ name: "my.toml", mimeType: "application/toml", buffer: Buffer.from(text) });

test("the gallery lists each scenario with its picture, and opens it", async ({ page, server }) => {
  await page.goto(server.url);
  const card = page.getByRole("link", { name: /^search-beliefs/ });
  await expect(card).toContainText("map, share and plan");
  await expect
    .poll(() => card.locator("img").evaluate((img: HTMLImageElement) => img.naturalWidth))
    .toBeGreaterThan(0);
  await expectAccessible(page);
  await card.click();
  await expect(page.getByRole("heading", { name: "search-beliefs" })).toBeVisible();
});

test("the errors of a file are listed beside its text, with their lines marked", async ({ page, server }) => {
  await page.goto(server.url);
  await page.locator("input[type=file]").setInputFiles(file(faulty));
  await expect(page.getByRole("heading", { name: "my.toml has 1 error" })).toBeVisible();
  await expect(page.getByRole("button", { name: "Line 10" })).toBeVisible();
  await expect(page.locator(".marked")).toContainText("raduis_m = 0.25");
  await expectAccessible(page);
});

test("a valid file opens, and its address contains it", async ({ page, server }) => {
  await page.goto(server.url);
  await page.locator("input[type=file]").setInputFiles(file(ownScenario));
  await expect(page.getByRole("status", { name: "" }).filter({ hasText: "4 robots" })).toBeVisible();
  await page.reload();
  await expect(page.locator("#status")).toContainText("4 robots");
});

test("a dropped file is opened like a selected one", async ({ page, server }) => {
  await page.goto(server.url);
  const transfer = await page.evaluateHandle((text) => {
    const data = new DataTransfer();
    data.items.add(new File([text], "my.toml"));
    return data;
  }, faulty);
  await page.dispatchEvent("main", "drop", { dataTransfer: transfer });
  await expect(page.getByRole("heading", { name: "my.toml has 1 error" })).toBeVisible();
});

test("the error of a scenario that cannot be opened is displayed", async ({ page, server }) => {
  const broken = join(server.folder, "broken.toml");
  await writeFile(broken, ownScenario.replace("count = 4", ""));
  await page.goto(runAt(server, "scenario=broken.toml"));
  await expect(page.getByText("count is missing")).toBeVisible();
  await expectAccessible(page);
  // The gallery has no picture of it, which later tests would report as an error.
  await rm(broken);
});
