/**
 * Measures the page with the real server, in Chromium without a graphics card, on Linux. Needs the page built
 * (`make web`) and `agent-economy` on the PATH. Arguments: numbers of robots to measure instead of the default, or
 * `--minutes` and for how long to play and measure the memory.
 */
import { chromium } from "@playwright/test";
import { launchOptions } from "../chromium.mjs";
import { RealServer } from "../real-server.mjs";
import { measureChanges } from "./changes.mjs";
import { measureCrowd } from "./crowd.mjs";
import { measureLoad } from "./load.mjs";
import { measureMemory } from "./memory.mjs";

/** Step lengths at the display rate, and above it, so that motion between steps is interpolated. */
const steps_s = [0.0333, 0.1];

const [option, length] = process.argv.slice(2);
const minutes = option === "--minutes" ? Number(length) : null;
const given = minutes === null ? process.argv.slice(2).map(Number) : [];

async function* measurements() {
  if (minutes !== null) return yield* measureMemory(browser, server, { minutes, every_min: minutes / 12 });
  if (given.length === 0) {
    yield await measureLoad(browser, server);
    yield await measureChanges(browser, server);
    yield* measureMemory(browser, server, { minutes: 1, every_min: 1 });
  }
  for (const robots of given.length > 0 ? given : [10_000, 50_000])
    for (const step_s of steps_s) yield await measureCrowd(browser, server, robots, step_s);
}

const server = new RealServer();
await server.start();
const browser = await chromium.launch(launchOptions);
try {
  for await (const line of measurements()) console.log(line);
} finally {
  await browser.close();
  await server.end();
}
