/** Memory of the server and of a page that plays for a long time, and frames per second with a robot inspected. */
import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { countPictures, measured_ms, warm_ms } from "./crowd.mjs";
import { below } from "./processor.mjs";

const bundled = new URL("../../../python/agent_economy/scenarios/search-beliefs.toml", import.meta.url);
const kB = 1024;
const MB = 1e6;

const changes = {
  '"1..20"': '"1..4"',
  "time_limit_s = 120": "time_limit_s = 1e5",
  "obstacles = [": "obstacles = [{ polygon_m = [[0, 23.8], [25, 23.8], [25, 24], [0, 24]] },",
  "[items.mine]":
    "[items.mine]\nplacement = { kind = 'fixed', at_m = [[2, 24.5], [9, 24.5], [16, 24.5], [23, 24.5]] }",
  "[robots.rover.drive]":
    "battery = { capacity_j = 1e12 }\nstart = { kind = 'fixed', at_m = [[2, 2], [6, 2], [10, 2], [14, 2]] }\n[robots.rover.drive]",
};

/** A search that does not end: its items stand in a closed room, and nothing drains the batteries. */
const endless = (scenario) =>
  Object.entries(changes).reduce((text, [from, to]) => text.replace(from, to), scenario);

async function resident_MB(pid) {
  const status = await readFile(`/proc/${pid}/status`, "utf8");
  return (kB * Number(/VmRSS:\s+(\d+)/.exec(status)?.[1])) / MB;
}

/** The resident memory of this browser's processes that render pages. */
async function renderers_MB(server) {
  let sum = 0;
  for (const pid of below(server.process.pid).keys()) {
    const command = await readFile(`/proc/${pid}/cmdline`, "utf8").catch(() => "");
    if (command.includes("--type=renderer")) sum += await resident_MB(pid).catch(() => 0);
  }
  return sum;
}

/** Plays with a robot inspected and two charts: frames per second, then the memory, a line for each `every_min`. */
export async function* measureMemory(browser, server, { minutes, every_min }) {
  const context = await browser.newContext({ viewport: { width: 1280, height: 720 } });
  const page = await context.newPage();
  const network = await context.newCDPSession(page);
  await page.addInitScript(countPictures);
  await writeFile(join(server.folder, "endless.toml"), endless(await readFile(bundled, "utf8")));
  const shown = "robot=rover/1&chart=body/rover/1/x_m&chart=outcome/false_alarms";
  await page.goto(`${server.url}/#/run?scenario=endless.toml&seed=7&run=0&${shown}`);
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await page.waitForTimeout(warm_ms);
  const [before, began_ms] = [await page.evaluate("pictures"), performance.now()];
  await page.waitForTimeout(measured_ms);
  const frames = (await page.evaluate("pictures")) - before;
  yield `a robot inspected: ${((1000 * frames) / (performance.now() - began_ms)).toFixed(1)} frames/s`;
  for (let minute = 0; minute <= minutes; minute += every_min) {
    await page.waitForTimeout(minute === 0 ? 0 : 60_000 * every_min);
    await network.send("HeapProfiler.collectGarbage");
    const heap = await page.evaluate("performance.memory.usedJSHeapSize");
    const played = await page.locator("#status").textContent();
    const [served, tab] = [await resident_MB(server.process.pid), await renderers_MB(server)];
    yield `${minute} min (${played}): server ${served.toFixed(0)} MB, tab ${tab.toFixed(0)} MB, of that ${(heap / MB).toFixed(1)} MB of objects`;
  }
  await context.close();
}
