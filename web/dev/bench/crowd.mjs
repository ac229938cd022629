/** Frames per second with many robots, and the processor time per frame of browser and server. */
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { usedBelow_ms, usedBy_ms } from "./processor.mjs";

export const warm_ms = 4000;
export const measured_ms = 10_000;
const metersEach = 5;

/** Robots that drive straight ahead in a periodic world. */
const crowd = (robots, step_s) => {
  const side_m = Math.ceil(Math.sqrt(robots)) * metersEach;
  return `engine = "metric"
summary = "${robots} robots."
merit = "equation-5.2"
clock = { step_s = ${step_s}, time_limit_s = 1e5 }
world = { size_m = [${side_m}, ${side_m}], periodic = true }
[robots.rover]
count = ${robots}
radius_m = 0
drive = { max_speed_m_s = 1 }
[robots.rover.sensors.eyes]
kind = "robots"
range_m = 3
course_noise_deg = 0
[[robots.rover.brain.behaviours]]
kind = "flock"
separation_m = 1
separation = 0.015
alignment = 0.05
cohesion = 0.03
`;
};

/** Counts how often robots are drawn, interpolated frames included. */
export function countPictures() {
  let isDrawn = false;
  globalThis.pictures = 0;
  for (const name of ["drawElements", "drawArrays"]) {
    const draw = WebGL2RenderingContext.prototype[name];
    WebGL2RenderingContext.prototype[name] = function (...given) {
      isDrawn = true;
      return draw.apply(this, given);
    };
  }
  const ask = globalThis.requestAnimationFrame.bind(globalThis);
  globalThis.requestAnimationFrame = (act) =>
    ask((time_ms) => {
      isDrawn = false;
      act(time_ms);
      if (isDrawn) globalThis.pictures += 1;
    });
}

export async function measureCrowd(browser, server, robots, step_s) {
  const name = `crowd-${robots}-${step_s}`;
  await writeFile(join(server.folder, `${name}.toml`), crowd(robots, step_s));
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  await page.addInitScript(countPictures);
  await page.goto(`${server.url}/#/run?scenario=${name}.toml&seed=0&run=0`);
  await page.getByRole("button", { name: "Play", exact: true }).click();
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  await pause(warm_ms);
  const { pid } = server.process;
  const now = async () => [
    await page.evaluate("pictures"),
    usedBelow_ms(pid),
    usedBy_ms(pid),
    performance.now(),
  ];
  const before = await now();
  await pause(measured_ms);
  const [frames, browser_ms, server_ms, time_ms] = (await now()).map((value, i) => value - before[i]);
  await page.close();
  const perFrame = (ms) => (ms / frames).toFixed(1);
  return `${robots} robots, steps of ${step_s} s: ${((1000 * frames) / time_ms).toFixed(1)} frames/s; processor time per frame: browser ${perFrame(browser_ms)} ms, server with simulation ${perFrame(server_ms)} ms`;
}
