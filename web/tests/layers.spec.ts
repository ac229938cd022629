import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { inkAt, opens, pixelsOf, type View, withoutWebGl } from "./ink";
import { expect, openRun, openTab, type RealServer, test } from "./page";

const view: View = [5, 5, 60];

/** A scenario with stationary robots that face along x, given as a list of places. */
function field(places: string, world = ""): string {
  const count = JSON.parse(places).length as number;
  return `
engine = "metric"
summary = "Robots that stand."
merit = "equation-5.2"
clock.time_limit_s = 100
[world]
size_m = [10, 10]
${world}
[items.mine]
count = 1
target = false
placement = { kind = "fixed", at_m = [[1, 1]] }
[robots.rover]
count = ${count}
radius_m = 0.2
start = { kind = "fixed", at_m = ${places}, heading_deg = [${Array(count).fill(0)}] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
brain = { behaviours = [] }
radio = { range_m = 4.5, needs_line_of_sight = true }
sensors.camera = { kind = "items", range_m = 3, fov_deg = 90 }
`;
}

async function open(page: Page, server: RealServer, text: string): Promise<void> {
  await writeFile(join(server.folder, "field.toml"), text);
  await openRun(page, server, `scenario=field.toml&seed=1&run=0&robot=rover/0&${opens(view)}`, /[23] robots/);
  await openTab(page, "Layers");
  for (const name of ["Trails", "Grid and scale"]) await page.getByRole("checkbox", { name }).uncheck();
}

/** The wall is between the first two robots; the last receives from the first only. */
const threeRobots = field(
  "[[4, 5], [8, 5], [4, 8]]",
  "obstacles = [{ polygon_m = [[5.5, 3], [6, 3], [6, 7], [5.5, 7]] }]",
);

const link = (page: Page) => page.getByRole("checkbox", { name: "Radio links" });

test("walls cut sensor coverage and radio links", async ({ page, server }) => {
  await open(page, server, threeRobots);
  // The first robot sees up to the wall, and receives from the third only.
  await expect.poll(() => inkAt(page, view, [5, 5])).toBe(true);
  expect(await inkAt(page, view, [6.6, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [4, 6.5])).toBe(true);
  expect(await inkAt(page, view, [7.5, 5])).toBe(false);
  await openTab(page, "Robot");
  await expect(page.getByText("1 robot", { exact: true })).toBeVisible();
});

test("without walls, coverage and links extend to their full range", async ({ page, server }) => {
  await open(page, server, field("[[4, 5], [8, 5]]"));
  await expect.poll(() => inkAt(page, view, [6.6, 5])).toBe(true);
  expect(await inkAt(page, view, [7.5, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [7.5, 5])).toBe(true);
});

test("in a periodic world, coverage and links continue at the other side", async ({ page, server }) => {
  await open(page, server, field("[[1, 5], [8.5, 5]]", "periodic = true"));
  // The coverage of the second robot beyond the right side continues at the left, behind the first.
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(true);
  await page.getByRole("checkbox", { name: "Sensor coverage" }).uncheck();
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(true);
  expect(await inkAt(page, view, [9.5, 5])).toBe(true);
  expect(await inkAt(page, view, [5, 5])).toBe(false);
});

test("radio links are requested while their layer is on, and drawn as received", async ({ page, server }) => {
  const requested: string[] = [];
  const received: Buffer[] = [];
  page.on("websocket", (line) => {
    line.on("framesent", ({ payload }) => {
      if (String(payload).includes('"show"')) requested.push(String(payload));
    });
    line.on("framereceived", ({ payload }) => {
      if (Buffer.isBuffer(payload)) received.push(payload);
    });
  });
  await open(page, server, threeRobots);
  await page.getByRole("checkbox", { name: "Sensor coverage" }).uncheck();
  const frame = received.at(-1);
  if (!frame) throw new Error("no frame has come");
  const robot = (i: number) => [0, 1].map((axis) => frame.readFloatLE(32 + 16 * i + 4 * axis));
  const [first = [], second = [], third = []] = [robot(0), robot(1), robot(2)];
  const middle = (a: number[], b: number[]): [number, number] => [
    ((a[0] ?? 0) + (b[0] ?? 0)) / 2,
    ((a[1] ?? 0) + (b[1] ?? 0)) / 2,
  ];
  expect(await inkAt(page, view, middle(first, third))).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, middle(first, third))).toBe(true);
  expect(await inkAt(page, view, middle(second, third))).toBe(false);
  await link(page).uncheck();
  await expect.poll(() => inkAt(page, view, middle(first, third))).toBe(false);
  const overlays = ["links", "footprints"];
  const requests = requested.map((text) => overlays.filter((id) => JSON.parse(text).layers.includes(id)));
  // The first request is repeated when the layers that the server offers are known.
  expect(requests.filter((ids, i) => ids.join() !== requests[i - 1]?.join())).toEqual([
    ["footprints"],
    [],
    ["links"],
    [],
  ]);
  // With both layers off, frames come without overlays.
  const before = received.length;
  await page.keyboard.press(".");
  await expect.poll(() => received.length).toBeGreaterThan(before);
  expect(received.slice(before).map((bytes) => bytes.readUInt32LE(0))).not.toContain(2);
});

const clear = [26, 95, 208];
const small = field("[[40, 250], [150, 150], [260, 50]]")
  .replace("size_m = [10, 10]", "size_m = [300, 300]")
  .replace("radius_m = 0.2", "radius_m = 0.15")
  .replace(/sensors.camera.*/, "");

for (const painter of ["WebGL", "Canvas 2D"])
  test(`robots of 0.3 m are seen in a world of 300 m: ${painter}`, async ({ page, server }) => {
    if (painter === "Canvas 2D") await withoutWebGl(page);
    await writeFile(join(server.folder, "small.toml"), small);
    await openRun(page, server, "scenario=small.toml&seed=1&run=0", /3 robots/);
    await expect.poll(() => pixelsOf(page, clear)).toBeGreaterThan(3 * 30);
    expect(await pixelsOf(page, clear)).toBeLessThan(3 * 100);
    const box = await page.locator("canvas").first().boundingBox();
    if (!box) throw new Error("there is no canvas");
    await page.mouse.click(box.x + box.width / 2 + 4, box.y + box.height / 2 + 4);
    await openTab(page, "Robot");
    await expect(page.getByRole("combobox", { name: "Robot" })).toHaveValue("rover/1");
  });
