import { chromium } from "@playwright/test";
import { launchOptions } from "./chromium.mjs";
import { RealServer } from "./real-server.mjs";
const server = new RealServer();
await server.start();
const browser = await chromium.launch(launchOptions);
const errors = [];
try {
  for (const [name, size, scheme, at, act] of [
    ["gallery", { width: 1280, height: 800 }, "light", "#/", async () => {}],
    [
      "robot",
      { width: 1280, height: 800 },
      "light",
      "#/live?scenario=classic&seed=7&run=0&tick=300&robot=wanderer/1",
      async () => {},
    ],
    [
      "params",
      { width: 1280, height: 800 },
      "dark",
      "#/live?scenario=classic&seed=7&run=0&tick=120",
      async (p) => {
        await p.getByRole("tab", { name: "Parameters" }).click();
        await p.getByRole("searchbox").fill("c");
      },
    ],
    [
      "layers",
      { width: 1280, height: 800 },
      "light",
      "#/live?scenario=classic&seed=7&run=0&tick=120",
      async (p) => {
        await p.getByRole("tab", { name: "Layers" }).click();
      },
    ],
    [
      "over",
      { width: 1280, height: 800 },
      "dark",
      "#/live?scenario=classic&seed=7&run=0",
      async (p) => {
        await p.getByRole("combobox", { name: "Speed" }).selectOption({ label: "× 10" });
        await p.keyboard.press("Space");
        await p.locator("#status", { hasText: "over" }).waitFor({ timeout: 60000 });
        await p.waitForTimeout(800);
      },
    ],
    [
      "crowd",
      { width: 1280, height: 800 },
      "light",
      "#/live?scenario=classic&seed=7&run=0&tick=300&changes=[[0,%22robots.wanderer.count%22,100]]",
      async () => {},
    ],
    [
      "phone",
      { width: 390, height: 780 },
      "light",
      "#/live?scenario=classic&seed=7&run=0&tick=300",
      async () => {},
    ],
  ]) {
    const page = await browser.newPage({ viewport: size, colorScheme: scheme });
    page.on("console", (m) => {
      if (m.type() === "error") errors.push(name + ": " + m.text());
    });
    page.on("pageerror", (e) => errors.push(name + ": " + e.message));
    await page.goto(`${server.url}/${at}`);
    if (name !== "gallery") await page.locator("#status", { hasText: "robots" }).waitFor();
    else await page.waitForLoadState("networkidle");
    await act(page);
    await page.waitForTimeout(500);
    if (name !== "gallery") console.log(name, await page.locator("#status").textContent());
    await page.screenshot({ path: `/tmp/shot-${name}.png` });
    await page.close();
  }
} finally {
  await browser.close();
  await server.end();
  console.log(errors);
}
