import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import { inkAt, opens, type View } from "../ink";
import { expect, type RealServer, test } from "./server";

const view: View = [5, 5, 60];

/** A scenario with robots that stand still and face along x. */
function field(places: [number, number][], world: string): string {
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
count = ${places.length}
radius_m = 0.2
start = { kind = "fixed", at_m = ${JSON.stringify(places)}, heading_deg = ${JSON.stringify(places.map(() => 0))} }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
brain = { behaviours = [] }
radio = { range_m = 4.5, needs_line_of_sight = true }
sensors.camera = { kind = "items", range_m = 3, fov_deg = 90 }
`;
}

async function open(page: Page, server: RealServer, text: string): Promise<void> {
  await writeFile(join(server.folder, "field.toml"), text);
  await page.goto(`${server.url}/#/run?scenario=field.toml&seed=1&run=0&robot=rover/0&${opens(view)}`);
  await expect(page.locator("#status")).toContainText(/[23] robots/);
  await page.getByRole("tab", { name: "Layers" }).click();
  for (const name of ["Trails", "Grid and scale"]) await page.getByRole("checkbox", { name }).uncheck();
}

const link = (page: Page) => page.getByRole("checkbox", { name: "Radio links" });

test("walls cut sensor coverage and radio links", async ({ page, server }) => {
  const wall = "obstacles = [{ polygon_m = [[5.5, 3], [6, 3], [6, 7], [5.5, 7]] }]";
  await open(
    page,
    server,
    field(
      [
        [4, 5],
        [8, 5],
        [4, 8],
      ],
      wall,
    ),
  );
  // The first robot sees up to the wall, and receives from the third only.
  await expect.poll(() => inkAt(page, view, [5, 5])).toBe(true);
  expect(await inkAt(page, view, [6.6, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [4, 6.5])).toBe(true);
  expect(await inkAt(page, view, [7.5, 5])).toBe(false);
  await page.getByRole("tab", { name: "Robot" }).click();
  await expect(page.getByText("1 robot", { exact: true })).toBeVisible();
});

test("without walls, coverage and links extend to their full range", async ({ page, server }) => {
  await open(
    page,
    server,
    field(
      [
        [4, 5],
        [8, 5],
      ],
      "",
    ),
  );
  await expect.poll(() => inkAt(page, view, [6.6, 5])).toBe(true);
  expect(await inkAt(page, view, [7.5, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [7.5, 5])).toBe(true);
});

test("in a periodic world, coverage and links continue at the other side", async ({ page, server }) => {
  await open(
    page,
    server,
    field(
      [
        [1, 5],
        [8.5, 5],
      ],
      "periodic = true",
    ),
  );
  // The coverage of the second robot beyond the right side continues at the left, behind the first.
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(true);
  await page.getByRole("checkbox", { name: "Sensor coverage" }).uncheck();
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(false);
  await link(page).check();
  await expect.poll(() => inkAt(page, view, [0.4, 5])).toBe(true);
  expect(await inkAt(page, view, [9.5, 5])).toBe(true);
  expect(await inkAt(page, view, [5, 5])).toBe(false);
});
