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

const live = "#/run?scenario=search-beliefs&seed=7&run=0&tick=220";

/** Each view: where it is, what must be there before, and what is done before the picture is taken. */
const views = {
  gallery: { at: "#/", ready: (page) => pictured(page) },
  live: { at: `${live}&robot=rover/0`, ready: (page) => standing(page, "22.0 s") },
  classic: {
    at: "#/run?scenario=classic&seed=7&run=0&tick=400&robot=wanderer/0",
    ready: (page) => standing(page, "7.1 s"),
  },
  parameters: {
    at: live,
    ready: async (page) => {
      await standing(page, "22.0 s");
      await page.getByRole("tab", { name: "Parameters" }).click();
    },
  },
  studies: { at: "#/studies", before: answered, ready: (page) => page.getByText("Send").first().waitFor() },
  ask: {
    at: "#/study/new?scenario=search",
    ready: (page) => page.getByText("20 configurations").first().waitFor(),
  },
  race: {
    at: "#/study?id=studies/search",
    before: (server) => ask(server, { scenario: "search", delta: 0.002 }),
    ready: (page) => page.waitForTimeout(6000),
  },
  answer: {
    at: "#/study?id=studies/classic",
    before: answered,
    ready: async (page) => {
      await page.getByText("Send 4 wanderers").first().waitFor();
      await page.waitForLoadState("networkidle");
      await page.waitForTimeout(1500);
    },
  },
  phone: { at: live, size: phone, ready: (page) => standing(page, "22.0 s") },
};

/** Begins a study, unless there is one already. */
async function ask({ url }, wanted) {
  const asked = { scenario: null, text: null, vary: {}, design: null, delta: null, confidence: null };
  const rest = { guarantee: null, merit: null, runs: null, max_runs: null, seed: "0" };
  const body = JSON.stringify({ ...asked, ...rest, ...wanted });
  const headers = { "content-type": "application/json" };
  await fetch(`${url}/api/studies`, { method: "POST", headers, body });
}

async function answered(server) {
  await ask(server, { scenario: "classic" });
  const isAnswered = async () => {
    const { studies } = await (await fetch(`${server.url}/api/studies`)).json();
    return studies.some(({ name, state }) => name === "classic" && state === "answered");
  };
  while (!(await isAnswered())) await new Promise((done) => setTimeout(done, 200));
}

/** All pictures of the gallery are there. */
async function pictured(page) {
  await page.getByRole("link", { name: /^search-beliefs/ }).waitFor();
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
  for (const [name, { at, before, ready, size = wide }] of Object.entries(views)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    await before?.(server);
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
