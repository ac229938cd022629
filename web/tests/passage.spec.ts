import { readFile, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Page } from "@playwright/test";
import { inkAt, opens, type View } from "./ink";
import { expect, expectAccessiblePanels, openRun, openTab, type RealServer, test } from "./page";

const small = fileURLToPath(new URL("small_lane.toml", import.meta.url));
/** The middle of the lane, which is from (6, 2) to (46, 12). */
const view: View = [26, 7, 16];
/** Three vehicles, which begin when the small lane is declared clear, after 531 steps. */
const passage = `
[passage]
width_m = 3
vehicles = 3
speed_m_s = 2
gap_m = 8
destroy_probability = 0.8
`;

async function openPassage(page: Page, server: RealServer, tick: number): Promise<void> {
  const text = await readFile(small, "utf8");
  await writeFile(join(server.folder, "passage.toml"), text + passage);
  const run = `scenario=passage.toml&seed=1&run=1&tick=${tick}&${opens(view)}`;
  await openRun(page, server, run, `${(tick / 5).toFixed(1)} s`);
}

const checkbox = (page: Page, name: string) => page.getByRole("checkbox", { name });

test("the path is drawn and vehicles drive on it", async ({ page, server }) => {
  await openPassage(page, server, 581);
  await openTab(page, "Layers");
  const others = ["Grid and scale", "Trails", "Sensor coverage", "Goals and controllers", "Items", "Marks"];
  for (const name of others) await checkbox(page, name).uncheck();
  // 10 s after the declaration, at 2 m/s.
  const first: [number, number] = [26.2, 5.6];
  await expect.poll(() => inkAt(page, view, first)).toBe(true);
  if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, "drive.png") });
  await checkbox(page, "Vehicles").uncheck();
  await expect.poll(() => inkAt(page, view, first)).toBe(false);
  const clip = { x: 0, y: 0, width: 900, height: 800 };
  const drawn = (await page.screenshot({ clip })).toString("base64");
  await checkbox(page, "Passage").uncheck();
  await expect.poll(async () => (await page.screenshot({ clip })).toString("base64")).not.toBe(drawn);
});

test("the panel states the risks of the vehicles, what is cleared, and what became of them", async ({
  page,
  server,
}) => {
  await openPassage(page, server, 675);
  await openTab(page, "Lane");
  const panel = page.getByRole("tabpanel");
  await expect(
    panel.getByText(/^Risk of the first vehicle 0\.\d+%, last of 3 (0\.\d+%|under 0\.01%)\.$/),
  ).toBeVisible();
  await expect(
    panel.getByText(/^Path of 4\d(\.\d)? m, 3 m wide: 0\.00\d+ mines expected in it\.$/),
  ).toBeVisible();
  await expect(panel.getByText("3 vehicles passed, 0 lost.")).toBeVisible();
  await expect(
    panel.getByRole("cell", { name: /^9\d(\.\d+)?% \(95% interval \d+(\.\d+)?% to 100%\)$/ }),
  ).toBeVisible();
  if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, "panel.png") });
  await expectAccessiblePanels(page, ["Lane", "Layers"]);
});

test("before a statement and without a passage, nothing of it is shown", async ({ page, server }) => {
  await openPassage(page, server, 150);
  await openTab(page, "Lane");
  await expect(page.getByRole("heading", { name: "Passage", exact: true })).toHaveCount(0);
  await openRun(page, server, "scenario=open-field&seed=7&run=0");
  await openTab(page, "Layers");
  for (const name of ["Passage", "Vehicles"]) await expect(checkbox(page, name)).toHaveCount(0);
});
