/** Frames a second of many robots, and what browser and server take of the processor for one. */
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { usedBelow_ms, usedBy_ms } from "./processor.mjs";

const warm_ms = 4000;
const measured_ms = 10_000;
const metersEach = 5;

/** Robots that go straight on over a field without edges, a step a thirtieth of a second. */
const crowd = (robots) => {
  const side_m = Math.ceil(Math.sqrt(robots)) * metersEach;
  return `engine = "metric"
summary = "${robots} robots."
merit = "equation-5.2"
clock = { step_s = 0.03333, cap_s = 1e5 }
world = { size_m = [${side_m}, ${side_m}], wraps = true }
[robots.rover]
count = ${robots}
radius_m = 0
drive = { max_speed_m_s = 1 }
[robots.rover.sensors.eyes]
kind = "robots"
range_m = 3
course_noise_deg = 0
[[robots.rover.brain.behaviours]]
kind = "swarm"
separation_m = 1
separation = 0.015
alignment = 0.05
cohesion = 0.03
`;
};

export async function measureCrowd(browser, server, robots) {
  const name = `crowd-${robots}`;
  await writeFile(join(server.folder, `${name}.toml`), crowd(robots));
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  let drawn = 0;
  page.on("websocket", (socket) =>
    socket.on("framesent", ({ payload }) => (drawn += String(payload).includes('"got"') ? 1 : 0)),
  );
  await page.goto(`${server.url}/#/live?scenario=${name}.toml&seed=0&run=0`);
  await page.getByRole("button", { name: "Play", exact: true }).click();
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  await pause(warm_ms);
  const { pid } = server.process;
  const now = () => [drawn, usedBelow_ms(pid), usedBy_ms(pid), performance.now()];
  const before = now();
  await pause(measured_ms);
  const [frames, browser_ms, server_ms, time_ms] = now().map((value, i) => value - before[i]);
  await page.close();
  const a = (ms) => (ms / frames).toFixed(1);
  return `${robots} robots: ${((1000 * frames) / time_ms).toFixed(1)} frames/s; of the processor a frame: browser ${a(browser_ms)} ms, server with its simulation ${a(server_ms)} ms`;
}
