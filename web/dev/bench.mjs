/**
 * Frames a second that the page draws of 10,000 and 50,000 robots, and milliseconds of processor that the
 * browser's processes take a frame, in Chromium without a graphics card. Needs `npm run build`.
 */
import { readdirSync, readFileSync } from "node:fs";
import { chromium } from "@playwright/test";
import { serve } from "./fake-server.mjs";

const warm_ms = 4000;
const measured_ms = 8000;
const tick_ms = 10; // of /proc/PID/stat
const flags = [
  "--no-sandbox",
  "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader",
  "--ignore-gpu-blocklist",
];

function stat(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
    return { parent: Number(fields[1]), used_ms: tick_ms * (Number(fields[11]) + Number(fields[12])) };
  } catch {
    return null; // it has ended meanwhile
  }
}

/** What all processes below this one have used: the browser's, as there are no others. */
function used_ms() {
  const all = new Map(
    readdirSync("/proc")
      .filter((name) => /^\d+$/.test(name))
      .map((pid) => [Number(pid), stat(pid)]),
  );
  const isBelow = (pid) => {
    const parent = all.get(pid)?.parent ?? 0;
    return parent === process.pid || (parent > 1 && isBelow(parent));
  };
  return [...all].reduce((sum, [pid, found]) => sum + (found && isBelow(pid) ? found.used_ms : 0), 0);
}

const pause = (ms) => new Promise((done) => setTimeout(done, ms));

async function measure(browser, robots) {
  const server = await serve();
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  await page.goto(`${server.url}/#/live?scenario=crowd-${robots}&seed=0&run=0`);
  await page.getByRole("button", { name: "Play", exact: true }).click();
  await pause(warm_ms);
  const [frames, cpu, began] = [server.counter.drawn, used_ms(), performance.now()];
  await pause(measured_ms);
  const drawn = server.counter.drawn - frames;
  const seconds = (performance.now() - began) / 1000;
  const taken = used_ms() - cpu;
  console.log(
    `${robots} robots: ${(drawn / seconds).toFixed(1)} frames/s, ${(taken / drawn).toFixed(1)} ms CPU a frame`,
  );
  await page.close();
  server.stop();
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: flags,
});
for (const robots of process.argv
  .slice(2)
  .map(Number)
  .concat(process.argv.length > 2 ? [] : [10_000, 50_000])) {
  await measure(browser, robots);
}
await browser.close();
