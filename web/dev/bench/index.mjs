/**
 * Measures the page with the real server, in Chromium without a graphics card, on Linux. Needs the page built
 * (`make web`) and `agent-economy` on the PATH. Arguments: numbers of robots to measure instead of the default.
 */
import { chromium } from "@playwright/test";
import { launchOptions } from "../chromium.mjs";
import { RealServer } from "../real-server.mjs";
import { measureChanges } from "./changes.mjs";
import { measureCrowd } from "./crowd.mjs";
import { measureLoad } from "./load.mjs";

/** Step lengths at the display rate, and above it, so that motion between steps is interpolated. */
const steps_s = [0.0333, 0.1];

const given = process.argv.slice(2).map(Number);
const server = new RealServer();
await server.start();
const browser = await chromium.launch(launchOptions);
try {
  if (given.length === 0) {
    console.log(await measureLoad(browser, server));
    console.log(await measureChanges(browser, server));
  }
  for (const robots of given.length > 0 ? given : [10_000, 50_000])
    for (const step_s of steps_s) console.log(await measureCrowd(browser, server, robots, step_s));
} finally {
  await browser.close();
  await server.end();
}
