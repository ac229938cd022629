import { expect, expectAccessible, runAt, test } from "./page";

const scenario = "scenario=search-beliefs&seed=7&run=2";

test("a run plays, pauses and steps, and the status follows", async ({ page, server }) => {
  await page.goto(runAt(server, scenario));
  const status = page.locator("#status");
  await expect(status).toHaveText(/^0\.0 s, 4 robots: .*; 0 of 4 items found; paused\.$/);
  await page.keyboard.press("Space");
  await expect(status).toContainText("running at 1 × real time");
  await page.keyboard.press("Space");
  await expect(status).toContainText("paused");
  const words = (await status.textContent()) ?? "";
  await page.keyboard.press(".");
  await expect(status).not.toHaveText(words);
  await page.keyboard.press(",");
  await expect(status).toHaveText(words);
});

test("the address opens the same run at the same tick with the same changes and view", async ({
  page,
  server,
  context,
}) => {
  await page.goto(runAt(server, scenario));
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("9");
  await page.keyboard.press("Enter");
  await expect(page.locator("#status")).toContainText("9 robots");
  await page.getByRole("application").focus();
  for (const key of ["ArrowLeft", "+", ".", ".", "."]) await page.keyboard.press(key);
  await expect.poll(() => page.url()).toContain("tick=3");
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(other.locator("#status")).toContainText("0.3 s, 9 robots");
  await expect.poll(() => other.url()).toBe(page.url());
});

test("the error of a refused change is displayed beside its switch, which stays unchanged", async ({
  page,
  server,
}) => {
  await page.goto(runAt(server, scenario));
  await page.getByRole("tab", { name: "Parameters" }).click();
  const flock = page.getByRole("checkbox", { name: "Flock" });
  await flock.click();
  await expect(page.getByText('flock needs, for example, eye = { kind = "robots"').first()).toBeVisible();
  await expect(flock).not.toBeChecked();
  await expect(flock).toBeDisabled();
  await page.getByRole("checkbox", { name: "Follow" }).click();
  await expect(page.getByRole("checkbox", { name: "Follow" })).toBeChecked();
  await expect(flock).toBeEnabled();
});

test("each parameter of the schema can be found and changed, and undone", async ({ page, server }) => {
  await page.goto(runAt(server, scenario));
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("searchbox").fill("camera range_m");
  const box = page.getByRole("spinbutton", { name: "robots.rover.sensors.camera.range_m" });
  await box.fill("5");
  await box.press("Enter");
  await page.getByRole("tab", { name: "Changes" }).click();
  await expect(page.getByRole("cell", { name: "robots.rover.sensors.camera.range_m" })).toBeVisible();
  await page.keyboard.press("Control+z");
  await expect(page.getByText("No changes yet")).toBeVisible();
});

test("a robot is selected by address and by button, and its brain is displayed", async ({ page, server }) => {
  await page.goto(runAt(server, `${scenario}&robot=rover/1`));
  await expect(page.getByRole("combobox", { name: "Robot", exact: true })).toHaveValue("rover/1");
  await expect(page.getByRole("cell", { name: "bayesian_search" }).first()).toBeVisible();
  await page.getByRole("button", { name: "Next" }).click();
  await expect.poll(() => page.url()).toContain("robot=rover/2");
  await expectAccessible(page);
});

test("obstacles are added on the canvas, and removed in the list", async ({ page, server }) => {
  await page.goto(runAt(server, scenario));
  await page.getByRole("tab", { name: "Edit" }).click();
  await page.getByRole("button", { name: "Add circle" }).click();
  await page.mouse.move(450, 330);
  await page.mouse.down();
  await page.mouse.move(470, 330, { steps: 3 });
  await page.mouse.up();
  const added = page.getByRole("button", { name: /^Remove circle/ });
  await expect(added).toHaveCount(3);
  await expectAccessible(page);
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

for (const tab of ["Results", "Robot", "Parameters", "Layers", "Edit", "Changes"]) {
  test(`the panel ${tab} passes axe`, async ({ page, server }) => {
    await page.goto(runAt(server, `${scenario}&changes=[[0,%22robots.rover.count%22,6]]`));
    await page.getByRole("tab", { name: tab }).click();
    if (tab === "Parameters") await page.getByRole("searchbox").fill("rover");
    if (tab === "Results") await page.getByRole("button", { name: "Table" }).click();
    await expectAccessible(page);
  });
}

test("the page is usable on a phone", async ({ page, server }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  await page.goto(runAt(server, scenario));
  await expect(page.locator("#status")).toContainText("4 robots");
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(360);
  await page.getByRole("button", { name: "Panels", exact: true }).click();
  await expect(page.getByRole("tab", { name: "Results" })).toBeVisible();
  await expectAccessible(page);
  await page.keyboard.press("Escape");
  await expect(page.getByRole("tab", { name: "Results" })).toBeHidden();
});

test("dialogs open with a key and close with Escape", async ({ page, server }) => {
  await page.goto(runAt(server, scenario));
  await page.keyboard.press("?");
  await expect(page.getByRole("dialog", { name: "Keyboard shortcuts" })).toBeVisible();
  await expectAccessible(page);
  await page.keyboard.press("Escape");
  await page.getByRole("button", { name: "New run" }).click();
  await expectAccessible(page);
  await page.getByRole("textbox", { name: "Seed" }).fill("12");
  await page.getByRole("button", { name: "Start" }).click();
  await expect.poll(() => page.url()).toContain("seed=12&run=3");
});

test("the picture and the time series can be saved", async ({ page, server }) => {
  await page.goto(runAt(server, `${scenario}&tick=20`));
  await expect(page.locator("#status")).toContainText("2.0 s");
  for (const [name, file] of [
    ["Picture", "search-beliefs-20.png"],
    ["Time series", "search-beliefs-20.csv"],
  ] as const) {
    await page.locator("summary", { hasText: "Export" }).click();
    const [saved] = await Promise.all([
      page.waitForEvent("download"),
      page.getByRole("button", { name }).click(),
    ]);
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
  await page.goto(runAt(server, "scenario=flock"));
  await expect(page.locator("#status")).toContainText("400 robots");
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
