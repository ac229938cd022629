import { copyFile } from "node:fs/promises";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import type { Locator, Page } from "@playwright/test";
import type { Point, Shown } from "../src/api/protocol";
import { inkAt, opens, type View } from "./ink";
import { expect, expectAccessiblePanels, openRun, openTab, type RealServer, test } from "./page";

const small = fileURLToPath(new URL("small_lane.toml", import.meta.url));
/** The middle of the lane, which is from (6, 2) to (46, 12). */
const view: View = [26, 7, 16];
const layers = ["Remaining risk", "Cleared path", "Marks"];

/** Opens the small lane at a tick; the run is over after 516 steps. */
async function openLane(page: Page, server: RealServer, tick: number): Promise<void> {
  await copyFile(small, join(server.folder, "small_lane.toml"));
  const run = `scenario=small_lane.toml&seed=1&run=1&tick=${tick}&${opens(view)}`;
  await openRun(page, server, run, `${(tick / 5).toFixed(1)} s`);
}

/** Opens the panel of the small lane at a tick. */
async function openPanel(page: Page, server: RealServer, tick: number): Promise<Locator> {
  await openLane(page, server, tick);
  await openTab(page, "Lane");
  return page.getByRole("tabpanel");
}

const checkbox = (page: Page, name: string | RegExp) => page.getByRole("checkbox", { name });

/** The pixels of the view around a place. */
async function pixelsAt(page: Page, [x, y]: Point): Promise<string> {
  const box = await page.getByRole("application", { name: "World view" }).boundingBox();
  if (!box) throw new Error("there is no view");
  const left = box.x + box.width / 2 + (x - view[0]) * view[2];
  const top = box.y + box.height / 2 - (y - view[1]) * view[2];
  const png = await page.screenshot({ clip: { x: left - 2, y: top - 2, width: 4, height: 4 } });
  return png.toString("base64");
}

test("the lane is drawn and sent while one of its layers is on", async ({ page, server }) => {
  const requested: string[][] = [];
  const received: Shown[] = [];
  page.on("websocket", (line) => {
    line.on("framesent", ({ payload }) => {
      const message = JSON.parse(String(payload));
      if (message.type === "show") requested.push([...message.layers, ...message.panels]);
    });
    line.on("framereceived", ({ payload }) => {
      const message = typeof payload === "string" ? JSON.parse(payload) : {};
      if (message.type === "shown") received.push(message);
    });
  });
  await openLane(page, server, 150);
  await openTab(page, "Layers");
  const others = ["Grid and scale", "Trails", "Sensor coverage", "Goals and controllers", "Items"];
  for (const name of others) await checkbox(page, name).uncheck();
  await expect.poll(() => received.at(-1)?.tick).toBe(150);
  const drawn = received.at(-1)?.layers["lane-marks"];
  expect(drawn?.markers.length).toBeGreaterThan(2);
  const isMine = (symbol: number) => drawn?.symbols[symbol]?.[0]?.fill?.colour === "item-missed";
  const mine = drawn?.markers.find(({ symbol }) => isMine(symbol))?.at ?? [0, 0];
  await expect.poll(() => inkAt(page, view, mine)).toBe(true);
  // A cell that has not been searched yet, and one at the outline of the cleared path.
  const places: [layer: string, at: Point][] = [
    ["Remaining risk", [43, 11]],
    ["Cleared path", [12, 2]],
  ];
  for (const [layer, at] of places) {
    const pixels = await pixelsAt(page, at);
    await checkbox(page, layer).uncheck();
    await expect.poll(() => pixelsAt(page, at)).not.toBe(pixels);
    await checkbox(page, layer).check();
    await expect.poll(() => pixelsAt(page, at)).toBe(pixels);
  }
  for (const name of layers) await checkbox(page, name).uncheck();
  await expect.poll(() => inkAt(page, view, mine)).toBe(false);
  const ofLane = () => requested.at(-1)?.filter((id) => id.startsWith("lane"));
  await expect.poll(ofLane).toEqual([]);
  // The panel needs it, too.
  await openTab(page, "Lane");
  await expect.poll(ofLane).toEqual(["lane"]);
});

test("the panel has the belief of the chosen controller, and the truth unless it is hidden", async ({
  page,
  server,
}) => {
  const panel = await openPanel(page, server, 150);
  await expect(panel.getByText(/^Remaining risk over 99\.9%/)).toBeVisible();
  await expect(panel.getByText("No statement yet: it declares the lane clear below 5%.")).toBeVisible();
  await expect(panel.getByText("3 mines left in the lane.")).toBeVisible();
  await checkbox(page, /Show the truth/).uncheck();
  await expect(panel.getByText(/left in the lane/)).toHaveCount(0);
  await panel.getByRole("combobox", { name: "Controller" }).selectOption("station/1");
  await expect(panel.getByRole("heading", { name: "Belief of station/1" })).toBeVisible();
});

test("what a controller has declared is shown beside the truth", async ({ page, server }) => {
  const panel = await openPanel(page, server, 531);
  await expect(panel.getByText(/^Declared clear at 106\.0 s, at a risk of 4\.\d%\.$/)).toBeVisible();
  await expect(panel.getByText("No mines left in the lane.")).toBeVisible();
  // The columns declared and declared_s are one row.
  await openTab(page, "Results");
  await expect(page.getByRole("term").getByRole("button", { name: "Declared", exact: true })).toHaveCount(1);
});

test("a person ends the mission, and the controllers give the lane up with the risk of that time", async ({
  page,
  server,
}) => {
  const panel = await openPanel(page, server, 150);
  const callOff = panel.getByRole("button", { name: "Call off the mission" });
  await callOff.click();
  await page.getByRole("button", { name: "Play" }).click();
  await expect(panel.getByText(/^Given up at 30\.0 s, at a risk of over 99\.9%\.$/)).toBeVisible();
  await expect(callOff).toHaveCount(0);
});

test("a run without a lane has neither the layers nor the panel", async ({ page, server }) => {
  await openRun(page, server, "scenario=open-field&seed=7&run=0");
  await openTab(page, "Layers");
  await expect(checkbox(page, "Radio links")).toBeVisible();
  for (const name of layers) await expect(checkbox(page, name)).toHaveCount(0);
  await expect(page.getByRole("tab", { name: "Lane" })).toHaveCount(0);
});

test("the panels of a run with a lane are accessible", async ({ page, server }) => {
  await openLane(page, server, 150);
  await expectAccessiblePanels(page, ["Lane", "Layers"]);
});

test("all panels of a lane fit 1280 pixels: their tabs stand in one row, and no table is cut off", async ({
  page,
  server,
}) => {
  await openPanel(page, server, 100);
  const tabs = page.getByRole("tablist", { name: "Panels" }).getByRole("tab");
  await expect(tabs).toHaveCount(8);
  const tops = await tabs.evaluateAll((all) => all.map((tab) => tab.getBoundingClientRect().top));
  expect(new Set(tops).size).toBe(1);
  for (const name of await tabs.allTextContents()) {
    await openTab(page, name);
    const widths = (panel: Element) => [panel.scrollWidth, panel.clientWidth];
    const [content, visible] = await page.getByRole("tabpanel").evaluate(widths);
    expect(content, name).toBe(visible);
  }
});
