import type { PageMessage, ServerMessage } from "../src/api/protocol";
import { times } from "../src/shared/format";
import {
  asOnPhone,
  downloaded,
  expect,
  expectAccessible,
  expectAccessiblePanels,
  expectToFit,
  hash,
  openRun,
  openTab,
  runAt,
  status,
  test,
  time_s,
} from "./page";

const scenario = "scenario=search-beliefs&seed=7&run=2";

test("a run plays, pauses, steps, and returns to the same state, and the status follows", async ({
  page,
  server,
}) => {
  const [requested, measured]: [(number | null)[], string[]] = [[], []];
  page.on("websocket", (line) => {
    line.on("framesent", ({ payload }) => {
      const message = JSON.parse(String(payload)) as PageMessage;
      if (message.type === "play") requested.push(message.speed ?? null);
    });
    line.on("framereceived", ({ payload }) => {
      const message = typeof payload === "string" ? (JSON.parse(payload) as ServerMessage) : null;
      if (message?.type === "state") measured.push(times(message.measured_speed));
    });
  });
  await openRun(page, server, scenario, /^0\.0 s, 4 robots: .*; 0 of 4 items found; paused\.$/);
  await page.keyboard.press("Space");
  // Real time is requested; a slow machine may run at less, and the page displays what the server measures.
  await expect(status(page)).toContainText(/running at [\d.]+ × real time/);
  expect(requested).toEqual([1]);
  const displayed = /running at ([\d.]+) ×/.exec((await status(page).textContent()) ?? "")?.[1];
  await expect.poll(() => measured).toContain(displayed);
  await expect.poll(() => time_s(page)).toBeGreaterThan(1);
  await page.keyboard.press("Space");
  await expect(status(page)).toContainText("paused");
  const [there, where] = [await hash(page), (await status(page).textContent()) ?? ""];
  await page.keyboard.press(".");
  await expect(status(page)).not.toHaveText(where);
  await expect.poll(() => hash(page)).not.toBe(there);
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill("3");
  await expect(status(page)).toContainText("0.3 s");
  await slider.fill((await slider.getAttribute("max")) ?? "");
  await page.keyboard.press(",");
  await expect(status(page)).toHaveText(where);
  await expect.poll(() => hash(page)).toBe(there);
});

test("an address opens the same run with the same changes and view in another tab, which is independent", async ({
  page,
  server,
  context,
}) => {
  await openRun(page, server, scenario);
  await page.keyboard.press("Space");
  await expect.poll(() => time_s(page)).toBeGreaterThan(0.5);
  await openTab(page, "Parameters");
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("9");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("9 robots");
  await page.getByRole("application").focus();
  for (const key of ["ArrowLeft", "+", "Space"]) await page.keyboard.press(key);
  await expect(status(page)).toContainText("paused");
  const there = await hash(page);
  await expect.poll(() => page.url()).toContain(`tick=${Math.round(10 * (await time_s(page)))}`);
  const other = await context.newPage();
  await other.goto(page.url());
  // The robots of a status are those of the last picture, which may arrive after the pause.
  const texts = () => Promise.all([page, other].map((each) => status(each).textContent()));
  await expect.poll(async () => new Set(await texts()).size).toBe(1);
  await expect.poll(() => hash(other)).toBe(there);
  await expect.poll(() => other.url()).toBe(page.url());
  await other.keyboard.press(".");
  await expect.poll(() => hash(other)).not.toBe(there);
  expect(await hash(page)).toBe(there);
});

test("a page opened while the run's address changes stays open", async ({ page, server }) => {
  // The browser reports the new address to the page only after the run has had the time to write its own.
  await page.clock.install();
  await page.addInitScript(() => {
    addEventListener("hashchange", (event) => {
      if (event.isTrusted) event.stopImmediatePropagation();
    });
  });
  await openRun(page, server, "scenario=flock&tick=20");
  await page.keyboard.press("ArrowRight");
  await page.evaluate(() => (location.hash = "#/recordings"));
  await page.clock.runFor(3000);
  await page.evaluate(() => dispatchEvent(new HashChangeEvent("hashchange")));
  await expect(page.getByRole("heading", { name: "Recordings" })).toBeVisible();
  expect(page.url()).toContain("#/recordings");
});

test("each parameter of the schema can be found and changed; an invalid value is refused; changes are undone", async ({
  page,
  server,
}) => {
  await openRun(page, server, `${scenario}&tick=10`);
  await openTab(page, "Parameters");
  await page.getByRole("searchbox").fill("camera range_m");
  const box = page.getByRole("spinbutton", { name: "robots.rover.sensors.camera.range_m" });
  const before = await box.inputValue();
  await box.fill("5.123");
  await box.press("Enter");
  await expect.poll(() => page.url()).toContain("5.123");
  await box.fill("-1");
  await box.press("Enter");
  await expect.poll(() => box.evaluate((input: HTMLInputElement) => input.validity.valid)).toBe(false);
  await openTab(page, "Events");
  const made = page.getByRole("button", { name: "robots.rover.sensors.camera.range_m = 5.123" });
  await expect(made).toHaveAttribute("aria-current", "true");
  await page.keyboard.press("Control+z");
  await expect(made).toHaveAttribute("aria-current", "false");
  await openTab(page, "Parameters");
  await page.getByRole("searchbox").fill("camera range_m");
  await expect(box).toHaveValue(before);
});

test("dialogs open with a key and close with Escape, and a new run starts", async ({ page, server }) => {
  await openRun(page, server, scenario, "0.0 s, 4 robots");
  const first = await hash(page);
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "Keyboard shortcuts" })).toBeVisible();
  await expectAccessible(page);
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "New run" }).click();
  await expectAccessible(page);
  await page.getByRole("textbox", { name: "Seed" }).fill("12345678901234567890");
  await page.getByRole("button", { name: "Start" }).click();
  await expect.poll(() => page.url()).toContain("seed=12345678901234567890&run=3");
  await expect.poll(() => hash(page)).not.toBe(first);
});

test("the error of a refused change is displayed beside its switch, which stays unchanged", async ({
  page,
  server,
}) => {
  await page.goto(runAt(server, scenario));
  await openTab(page, "Parameters");
  const flock = page.getByRole("checkbox", { name: "Flock" });
  await flock.click();
  await expect(page.getByText('flock needs, for example, eye = { kind = "robots"').first()).toBeVisible();
  await expect(flock).not.toBeChecked();
  await expect(flock).toBeDisabled();
  await page.getByRole("checkbox", { name: "Follow" }).click();
  await expect(page.getByRole("checkbox", { name: "Follow" })).toBeChecked();
  await expect(flock).toBeEnabled();
});

test("a robot is selected by address and by button, and its brain is displayed", async ({ page, server }) => {
  await page.goto(runAt(server, `${scenario}&robot=rover/1`));
  await expect(page.getByRole("combobox", { name: "Robot", exact: true })).toHaveValue("rover/1");
  await expect(page.getByRole("cell", { name: "bayesian_search" }).first()).toBeVisible();
  await page.getByRole("button", { name: "Next" }).click();
  await expect.poll(() => page.url()).toContain("robot=rover/2");
});

test("obstacles are added on the canvas, and removed in the list", async ({ page, server }) => {
  await openRun(page, server, scenario);
  await openTab(page, "Edit");
  await page.getByRole("button", { name: "Add circle" }).click();
  await page.mouse.move(450, 330);
  await page.mouse.down();
  await page.mouse.move(470, 330, { steps: 3 });
  await page.mouse.up();
  const added = page.getByRole("button", { name: /^Remove circle/ });
  await expect(added).toHaveCount(3);
  await added.last().click();
  await expect(added).toHaveCount(2);
});

test("a full server is reported, and the run can be reopened", async ({ page, server }) => {
  const message = "This server has 16 runs open, which is its maximum. Close one.";
  await page.routeWebSocket(/\/ws/, async (line) => {
    line.send(JSON.stringify({ type: "ended", reason: "full", message }));
    await line.close({ code: 1013 });
  });
  await page.goto(runAt(server, scenario));
  await expect(page.getByRole("alert")).toContainText(message);
  await expectAccessible(page);
});

test("the panels of a run pass axe", async ({ page, server }) => {
  await openRun(page, server, `${scenario}&changes=[[0,%22robots.rover.count%22,6]]`);
  await expectAccessiblePanels(page, ["Layers", "Edit", "Events"]);
  await openTab(page, "Parameters");
  await page.getByRole("searchbox").fill("rover");
  await expectAccessible(page, "aside");
  await openTab(page, "Results");
  await expectAccessible(page, "aside");
  await page.getByRole("button", { name: "Table" }).click();
  await expectAccessible(page, "aside");
});

test("the page is usable on a phone", async ({ page, server }) => {
  await asOnPhone(page);
  await openRun(page, server, scenario);
  await expectToFit(page);
  await page.getByRole("button", { name: "Panels", exact: true }).click();
  await expect(page.getByRole("tab", { name: "Results" })).toBeVisible();
  await expectAccessible(page);
  await page.keyboard.press("Escape");
  await expect(page.getByRole("tab", { name: "Results" })).toBeHidden();
});

test("the picture and the time series can be saved", async ({ page, server }) => {
  await openRun(page, server, `${scenario}&tick=20`, "2.0 s");
  for (const [name, file] of [
    ["Picture", "search-beliefs-20.png"],
    ["Time series", "search-beliefs-20.csv"],
  ] as const) {
    await page.locator("summary", { hasText: "Export" }).click();
    const saved = await downloaded(page, () => page.getByRole("button", { name }).click());
    expect(saved.suggestedFilename()).toBe(file);
  }
});

test("robots are drawn without WebGL2", async ({ page, server }) => {
  await page.addInitScript(() => {
    const get = HTMLCanvasElement.prototype.getContext;
    // @ts-expect-error one signature stands for all
    HTMLCanvasElement.prototype.getContext = function (kind: string, options: unknown) {
      return kind === "webgl2" ? null : get.call(this, kind, options);
    };
  });
  await openRun(page, server, "scenario=flock", "400 robots");
  const blue = await page
    .locator("canvas")
    .first()
    .evaluate((canvas: HTMLCanvasElement) => {
      const data = canvas.getContext("2d")?.getImageData(0, 0, canvas.width, canvas.height).data ?? [];
      return Array.from(data).filter((value, i) => i % 4 === 2 && value > 180 && (data[i - 2] ?? 255) < 60)
        .length;
    });
  expect(blue).toBeGreaterThan(400);
});
