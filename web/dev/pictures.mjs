/**
 * Takes the pictures of docs/ui: each view in the light and the dark theme, with the real server. Needs the
 * page built (`make web`) and `agent-economy` on the PATH. Arguments: names of views, to take only those.
 */
import { mkdir } from "node:fs/promises";
import { fileURLToPath } from "node:url";
import { chromium } from "@playwright/test";
import { runnerImport } from "vite";
import { launchOptions } from "./chromium.mjs";
import { RealServer } from "./real-server.mjs";

const folder = fileURLToPath(new URL("../../docs/ui", import.meta.url));
const wide = { width: 1280, height: 800 };
const phone = { width: 390, height: 780 };

const run = "#/run?scenario=search-beliefs&seed=7&run=0&tick=220";

/** The views: address, preparation of the server, and what to wait for before the picture is taken. */
const views = {
  gallery: { at: "#/", ready: (page) => pictured(page) },
  run: { at: `${run}&robot=rover/0`, ready: (page) => paused(page, "22.0 s") },
  classic: {
    at: "#/run?scenario=classic&seed=7&run=0&tick=400&robot=wanderer/0",
    ready: (page) => paused(page, "7.1 s"),
  },
  parameters: {
    at: run,
    ready: async (page) => {
      await paused(page, "22.0 s");
      await page.getByRole("tab", { name: "Parameters" }).click();
    },
  },
  studies: { at: "#/studies", before: answered, ready: (page) => page.getByText("Send").first().waitFor() },
  form: {
    at: "#/study/new?scenario=search",
    ready: (page) => page.getByText("20 configurations").first().waitFor(),
  },
  requirement: {
    at: "#/study/new?scenario=warehouse",
    size: { width: 1280, height: 1150 },
    ready: async (page) => {
      await page.getByRole("button", { name: "Start" }).and(page.locator(":enabled")).waitFor();
      await page.getByText("Add a factor").click();
      await page.getByRole("searchbox", { name: "Search factors" }).fill("time_limit");
    },
  },
  race: {
    at: "#/study?id=studies/search",
    before: (server) => startStudy(server, { scenario: "search", delta: 0.002 }),
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
  robots: {
    drives: true,
    ready: async (page) => {
      await holdUntilArmed(page, "Run bender/0");
      await page.waitForTimeout(9000);
    },
  },
  "robots-manual": {
    drives: true,
    ready: async (page) => {
      await page.getByRole("tab", { name: "Manual" }).click();
      await page.getByRole("button", { name: "Switch to manual mode" }).click();
      await holdUntilArmed(page, "Arm bender/0");
      await page.keyboard.down("ArrowUp");
      await page.getByText("Sending every 0.1 s.").waitFor();
      await page.waitForTimeout(2000);
    },
  },
  phone: { at: run, size: phone, ready: (page) => paused(page, "22.0 s") },
};

/** Starts a study, unless it exists already. */
async function startStudy({ url }, wanted) {
  const defaults = { scenario: null, text: null, vary: {}, design: null, delta: null, confidence: null };
  const rest = { guarantee: null, merit: null, runs: null, max_runs: null, seed: "0" };
  const body = JSON.stringify({ ...defaults, ...rest, ...wanted });
  const headers = { "content-type": "application/json" };
  await fetch(`${url}/api/studies`, { method: "POST", headers, body });
}

async function answered(server) {
  await startStudy(server, { scenario: "classic" });
  const isAnswered = async () => {
    const { studies } = await (await fetch(`${server.url}/api/studies`)).json();
    return studies.some(({ name, state }) => name === "classic" && state === "answered");
  };
  while (!(await isAnswered())) await new Promise((done) => setTimeout(done, 200));
}

/** Waits until the gallery has loaded its pictures. */
async function pictured(page) {
  await page.getByRole("link", { name: /^search-beliefs/ }).waitFor();
  await page.waitForLoadState("networkidle");
}

async function paused(page, time) {
  await page.locator("#status", { hasText: time }).waitFor();
  await page.waitForTimeout(300);
}

/** A hold does not count if the button was disabled meanwhile, as on a busy machine. */
const [maxHolds, hold_ms] = [10, 3000];

/** Holds a button as operator until the robot is armed. */
async function holdUntilArmed(page, name) {
  const button = page.getByRole("button", { name }).and(page.locator(":enabled"));
  const armed = page.getByRole("region", { name: "bender/0" }).getByText("armed", { exact: true });
  for (let hold = 1; !(await armed.isVisible()); hold++) {
    if (hold > maxHolds) throw new Error(`${name}: not armed after ${maxHolds} holds`);
    await button.waitFor();
    await button.hover();
    await page.mouse.down();
    await armed.waitFor({ timeout: hold_ms }).catch(() => {});
    await page.mouse.up();
  }
}

/** Starts a drive of the emulated robot, and opens its page as operator. */
async function openDrive(page) {
  const { module } = await runnerImport(fileURLToPath(new URL("../tests/real_drive.ts", import.meta.url)));
  const drive = new module.RealDrive();
  await drive.start();
  await page.goto(drive.url);
  await page.getByRole("button", { name: "Take control" }).click();
  return drive;
}

const wanted = process.argv.slice(2);
const server = new RealServer();
await server.start();
const browser = await chromium.launch(launchOptions);
await mkdir(folder, { recursive: true });
try {
  for (const [name, { at, before, drives, ready, size = wide }] of Object.entries(views)) {
    if (wanted.length > 0 && !wanted.includes(name)) continue;
    await before?.(server);
    for (const colorScheme of ["light", "dark"]) {
      const page = await browser.newPage({ viewport: size, colorScheme, reducedMotion: "reduce" });
      const drive = drives ? await openDrive(page) : null;
      try {
        if (!drive) await page.goto(`${server.url}/${at}`);
        await ready(page);
        await page.screenshot({ path: `${folder}/${name}-${colorScheme}.png` });
      } finally {
        await page.close();
        await drive?.end();
      }
    }
  }
} finally {
  await browser.close();
  await server.end();
}
