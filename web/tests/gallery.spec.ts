import { rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import {
  asOnPhone,
  expect,
  expectAccessible,
  expectToFit,
  openFile,
  ownScenario,
  runAt,
  status,
  test,
} from "./page";

const faulty = `${ownScenario}raduis_m = 0.25\n`;

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

test("the gallery is grouped, with what to start with first and then the scenarios of the folder", async ({
  page,
  ownServer,
}) => {
  await writeFile(join(ownServer.folder, "my-field.toml"), ownScenario);
  await page.goto(ownServer.url);
  const groups = page.getByRole("region");
  await expect(groups.getByRole("heading", { level: 2, name: "Start here" })).toBeVisible();
  const titles = await page.locator("section > h2").allTextContents();
  expect(titles.slice(0, 2)).toEqual(["Start here", "Your scenarios"]);
  await expect(page.getByRole("region", { name: "Start here" }).getByRole("listitem")).toHaveCount(3);
  await expect(page.getByRole("region", { name: "Your scenarios" }).getByRole("link")).toHaveCount(2);
  await asOnPhone(page);
  await expectToFit(page);
  await expectAccessible(page);
});

test("the first picture of the gallery arrives within 100 kB", async ({ page, server }) => {
  const network = await page.context().newCDPSession(page);
  await network.send("Network.enable");
  let bytes = 0;
  network.on("Network.loadingFinished", ({ encodedDataLength }) => (bytes += encodedDataLength));
  await page.goto(server.url);
  await page.waitForFunction(() => [...document.images].some(({ naturalWidth }) => naturalWidth > 0));
  expect(bytes).toBeGreaterThan(1000);
  expect(bytes).toBeLessThan(100_000);
});

test("the errors of a file are listed beside its text, with their lines marked", async ({ page, server }) => {
  await openFile(page, server, faulty.replace("summary", "sumary"));
  await expect(page.getByRole("heading", { name: /my.toml has \d errors/ })).toBeVisible();
  await expect(page.getByRole("button", { name: "Line 2" })).toBeVisible();
  await expect(page.getByText("scenario.toml")).toHaveCount(0);
  await expect(page.getByRole("button", { name: "Line 10" })).toBeVisible();
  await expect(page.locator(".marked").last()).toContainText("raduis_m = 0.25");
  await expectAccessible(page);
});

test("of a file with 80,000 errors, the first 200 are listed with their number", async ({ page, server }) => {
  const unknown = Array.from({ length: 80_000 }, (_, i) => `k${i} = 1\n`).join("");
  await openFile(page, server, `engine = "metric"\nsummary = "x"\n${unknown}`);
  const errors = page.getByRole("region", { name: /my.toml has 80,0\d\d errors/ });
  await expect(errors).toBeVisible();
  await expect(errors.getByText(/These are the first of 80,0\d\d errors/)).toBeVisible();
  expect(await errors.getByRole("listitem").count()).toBe(201);
  expect(await errors.locator(".line").count()).toBeLessThan(2000);
  await errors.getByRole("button", { name: "Line 150", exact: true }).click();
  await expect(errors.locator("#line-150")).toBeInViewport();
  await expect(errors.getByText(/more lines$/)).toBeVisible();
  await expectAccessible(page);
});

test("a valid file opens, and its address contains it", async ({ page, server }) => {
  await openFile(page, server, ownScenario);
  await expect(status(page)).toContainText("4 robots");
  await page.reload();
  await expect(status(page)).toContainText("4 robots");
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
