import { inkAt, opens, type View } from "./ink";
import { expect, expectAccessible, runAt, test } from "./page";

const view: View = [30, 20, 12];
const scenario = `scenario=search-beliefs&seed=7&run=2&${opens(view)}`;

test("radio links are requested while their layer is on, and drawn as received", async ({ page, fake }) => {
  const requested: string[] = [];
  const received: Buffer[] = [];
  page.on("websocket", (line) => {
    line.on("framesent", ({ payload }) => {
      if (String(payload).includes('"layers"')) requested.push(String(payload));
    });
    line.on("framereceived", ({ payload }) => {
      if (Buffer.isBuffer(payload)) received.push(payload);
    });
  });
  await page.goto(runAt(fake, scenario));
  await expect(page.locator("#status")).toContainText("4 robots");
  await page.getByRole("tab", { name: "Layers" }).click();
  for (const name of ["Sensor coverage", "Trails", "Beliefs and goals", "Heading options"]) {
    await page.getByRole("checkbox", { name }).uncheck();
  }
  const frame = received.at(-1);
  if (!frame) throw new Error("no frame has come");
  const robot = (i: number) => [0, 1].map((axis) => frame.readFloatLE(32 + 16 * i + 4 * axis));
  const [first = [], second = [], third = []] = [robot(0), robot(1), robot(2)];
  const middle = (a: number[], b: number[]): [number, number] => [
    ((a[0] ?? 0) + (b[0] ?? 0)) / 2,
    ((a[1] ?? 0) + (b[1] ?? 0)) / 2,
  ];
  expect(await inkAt(page, view, middle(first, second))).toBe(false);
  await page.getByRole("checkbox", { name: "Radio links" }).check();
  await expect.poll(() => inkAt(page, view, middle(first, second))).toBe(true);
  expect(await inkAt(page, view, middle(second, third))).toBe(false);
  await page.getByRole("checkbox", { name: "Radio links" }).uncheck();
  await expect.poll(() => inkAt(page, view, middle(first, second))).toBe(false);
  expect(
    requested.map((text) => JSON.parse(text)).map(({ links, footprints }) => [links, footprints]),
  ).toEqual([
    [false, true],
    [false, false],
    [true, false],
    [false, false],
  ]);
  // With both layers off, frames come without overlays.
  const before = received.length;
  await page.keyboard.press(".");
  await expect.poll(() => received.length).toBeGreaterThan(before);
  expect(received.slice(before).map((bytes) => bytes.readUInt32LE(0))).not.toContain(2);
});

test("layers and legend pass axe", async ({ page, fake }) => {
  await page.goto(runAt(fake, scenario));
  await page.getByRole("tab", { name: "Layers" }).click();
  await page.getByRole("checkbox", { name: "Radio links" }).check();
  await expectAccessible(page);
});
