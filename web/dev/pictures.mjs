/**
 * Takes the pictures of docs/ui: each view, in light and in dark, beside the real server. Needs the page
 * built (`make web`) and `agent-economy` on the PATH. Names as arguments: only those.
 */
import { mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { chromium } from "@playwright/test";
import { launchOptions } from "./chromium.mjs";
import { RealServer } from "./real-server.mjs";

const folder = fileURLToPath(new URL("../../docs/ui", import.meta.url));
const wide = { width: 1280, height: 800 };
const phone = { width: 390, height: 780 };

const live = "#/live?scenario=search-mind&seed=7&run=0&tick=220";

/** Each view: where it is, and what is done before the picture is taken. */
const views = {
  gallery: { at: "#/", ready: (page) => pictured(page) },
  live: { at: `${live}&robot=rover/0`, ready: (page) => standing(page, "22.0 s") },
  parameters: {
    at: live,
    ready: async (page) => {
      await standing(page, "22.0 s");
      await page.getByRole("tab", { name: "Parameters" }).click();
    },
  },
  phone: { at: live, size: phone, ready: (page) => standing(page, "22.0 s") },
};

/** All pictures of the gallery are there. */
async function pictured(page) {
  await page.getByRole("link", { name: /^search-mind/ }).waitFor();
  await page.waitForLoadState("networkidle");
}

async function standing(page, time) {
  await page.locator("#status", { hasText: time }).waitFor();
  await page.waitForTimeout(300);
}

const wanted = process.argv.slice(2);
const server = new RealServer();
await server.start();
const browser = await chromium.launch(launchOptions);
await mkdir(folder, { recursive: true });
try {
  for (const [name, { at, ready, size = wide }] of Object.entries(views)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    for (const colorScheme of ["light", "dark"]) {
      const page = await browser.newPage({ viewport: size, colorScheme });
      await page.goto(`${server.url}/${at}`);
      await ready(page);
      await page.screenshot({ path: `${folder}/${name}-${colorScheme}.png` });
      await page.close();
    }
  }
} finally {
  await browser.close();
  await server.end();
}
