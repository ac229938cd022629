import { expect, expectAccessible, openRun } from "./page";
import {
  bar,
  button,
  clickUntil,
  clickUntilShown,
  expectStopBy,
  holdUntil,
  isLate,
  open,
  pointer,
  pressShortly,
  stopButton,
  takeControl,
  test,
} from "./robots_page";

test.describe("the emergency stop", () => {
  test("is sent by one press, alone, and confirmed by the standstill of each robot", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await pointer(page, stopButton(page)).begin();
    await expect(bar(page)).toContainText("bender/0: standstill not confirmed");
    await page.mouse.up();
    warden.confirmStandstill();
    await expect(bar(page)).toContainText("bender/0: standstill confirmed (slower than 0.22 m/s)");
    // It is repeated if the answer is late.
    expect(warden.requests("client")[0]).toEqual(["/stop", undefined]);
    expect(new Set(warden.requests().map(String))).toEqual(new Set(["/stop"]));
  });

  for (const [name, hash] of [
    ["gallery", "#/"],
    ["recordings", "#/recordings"],
    ["studies", "#/studies"],
    ["form of a study", "#/study/new?scenario=search"],
    ["run", "#/run?scenario=search"],
    ["robots", "#/robots"],
  ] as const) {
    test(`is in the view ${name}, and is sent by Escape`, async ({ page, server, warden }) => {
      await page.goto(`${server.url}/${hash}`);
      await expect(stopButton(page)).toBeVisible();
      await expectStopBy(page, warden, () => page.keyboard.press("Escape"));
    });
  }

  test("is sent by Escape in a text field and in a dialog, which closes, and by a press above it", async ({
    page,
    server,
    warden,
  }) => {
    await openRun(page, server, "scenario=search");
    const escape = () => page.keyboard.press("Escape");
    const press = () => stopButton(page).click();
    await page.getByRole("button", { name: "Keyboard shortcuts" }).click();
    await expect(page.getByRole("dialog")).toBeVisible();
    await expectStopBy(page, warden, escape);
    await expect(page.getByRole("dialog")).toBeHidden();
    await page.getByRole("button", { name: "New run" }).click();
    await page.getByRole("dialog").getByRole("textbox").first().focus();
    await expectStopBy(page, warden, escape);
    await page.getByRole("button", { name: "New run" }).click();
    await expectStopBy(page, warden, press);
    await page.getByRole("button", { name: "Close" }).click();
    await expectStopBy(page, warden, press);
  });

  test("is repeated until the warden answers, and never called confirmed before", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    warden.confirmStandstill();
    warden.mode = "frozen";
    await page.keyboard.press("Escape");
    await expect(bar(page)).toContainText("Stop requested, not confirmed: the warden does not respond");
    await expect.poll(() => warden.count("/stop")).toBeGreaterThan(3);
    await expect(bar(page)).not.toContainText("standstill confirmed");
    warden.mode = "running";
    await expect(bar(page)).toContainText("bender/0: standstill confirmed (slower than 0.22 m/s)");
  });

  test("never shows that a standstill is confirmed without the number", async ({ page, server, warden }) => {
    await open(page, server);
    await page.keyboard.press("Escape");
    await expect(bar(page)).toContainText("Stop is latched");
    warden.robot.is_standing = true;
    await page.waitForTimeout(1000);
    await expect(bar(page)).toContainText("bender/0: standstill not confirmed");
  });

  test("shows the robots that may move first, and of the others one number, also on a phone", async ({
    page,
    server,
    warden,
  }) => {
    warden.confirmStandstill();
    for (let i = 1; i < 5; i++) warden.state.robots.push({ ...warden.robot, name: `bender/${i}` });
    Object.assign(warden.state.robots[3] as object, { is_standing: false, unseen: null });
    await page.setViewportSize({ width: 390, height: 780 });
    await open(page, server);
    await page.keyboard.press("Escape");
    const text = bar(page).getByRole("status");
    await expect(text).toHaveText(
      "Stop is latched. bender/3: standstill not confirmed · 4 others: standstill confirmed (slower than 0.22 m/s)",
    );
    expect(await text.evaluate((each) => each.scrollHeight <= each.clientHeight)).toBe(true);
  });

  test("reaches a warden that was killed and started again", async ({ page, server, warden }) => {
    await open(page, server);
    await warden.kill();
    await page.keyboard.press("Escape");
    await expect(bar(page)).toContainText("the warden does not respond");
    await warden.start();
    await expect(bar(page)).toContainText("Stop is latched");
  });

  test("works after the page's server has been killed", async ({ page, ownServer, warden }) => {
    await open(page, ownServer);
    await ownServer.kill();
    await expectStopBy(page, warden, () => page.keyboard.press("Escape"));
  });

  test("is released by a hold, which arms nothing, and not by a short press", async ({
    page,
    server,
    warden,
  }) => {
    warden.state.is_stopped = true;
    await open(page, server);
    await takeControl(page);
    await expect(page.getByRole("button", { name: "Release" })).toBeEnabled();
    await page.getByRole("button", { name: "Release" }).evaluate(pressShortly);
    await page.waitForTimeout(1500);
    expect(warden.count("/release")).toBe(0);
    await holdUntil(page, warden, "Release", "/release");
    expect(warden.requests()).toEqual([["/operator"], ["/release"]]);
    await expect(bar(page)).toContainText("Stops all robots at once.");
  });
});

test.describe("autonomous control", () => {
  test("each control sends its request, and nothing else", async ({ page, server, warden }) => {
    await open(page, server);
    await takeControl(page);
    await clickUntilShown(button(page, "Hold all robots"), page.getByText("On hold."));
    await holdUntil(page, warden, "Run bender/0", "/arm");
    const navigates = (checked: boolean) =>
      page.getByRole("checkbox", { name: "Navigate to waypoints", checked });
    await clickUntilShown(navigates(true), navigates(false));
    await clickUntilShown(button(page, "Give up control"), page.getByText("No operator."));
    await expectStopBy(page, warden, () => button(page, "Stop (latched)").click());
    const sent = warden.requests("take", "robots", "robot", "is_on");
    expect(sent.filter(([path]) => path !== "/stop")).toEqual([
      ["/operator", true, undefined, undefined, undefined],
      ["/hold", undefined, undefined, undefined, undefined],
      ["/resume", undefined, undefined, undefined, undefined],
      ["/arm", undefined, ["bender/0"], undefined, undefined],
      ["/navigate", undefined, undefined, "bender/0", false],
      ["/operator", false, undefined, undefined, undefined],
    ]);
  });

  test("Run arms nothing later if a stop comes between", async ({ page, server, warden }) => {
    const held = [{ name: "held", reason: "all robots are held: not resumed" }];
    warden.state.is_held = true;
    warden.robot.blockers = held;
    await open(page, server);
    await takeControl(page);
    await expect(page.getByText("On hold.")).toBeVisible();
    await holdUntil(page, warden, "Run bender/0", "/resume");
    await expectStopBy(page, warden, () => page.keyboard.press("Escape"));
    await expect(page.getByRole("list", { name: "Why not: Run" })).toContainText(
      "emergency stop: not released",
    );
    warden.state.is_stopped = false;
    warden.robot.blockers = [];
    await page.waitForTimeout(4000);
    expect(warden.count("/arm")).toBe(0);
  });

  test("a robot that cannot be armed cannot be run, and the reasons are listed", async ({
    page,
    server,
    warden,
  }) => {
    warden.robot.blockers = [{ name: "stale_input", reason: "sonar: 4.2 s old, at most 0.5 s" }];
    await open(page, server);
    await takeControl(page);
    await expect(page.getByRole("list", { name: "Why not: Run" })).toHaveText(
      /stale input: sonar: 4.2 s old/,
    );
    const { begin, end } = pointer(page, page.getByRole("button", { name: "Run bender/0" }));
    await begin();
    await page.waitForTimeout(1500);
    await end();
    expect(warden.count("/arm")).toBe(0);
  });

  test("a doubted value is shown, and confirmed by a hold of the operator", async ({
    page,
    server,
    warden,
  }) => {
    warden.doubt("compass", "changed by 127.5 degrees at once and is not back");
    Object.assign(warden.robot.heading as object, { magnetic_deg: 187.46 });
    await open(page, server);
    const confirm = button(page, "Confirm compass: 187.5 degrees magnetic hold 1 s");
    await expect(page.getByRole("list", { name: "Why not: Run" })).toHaveText(/jump: compass: changed/);
    await expect(confirm).toBeDisabled();
    await takeControl(page);
    await expect(confirm).toBeEnabled();
    await expectAccessible(page);
    await confirm.evaluate(pressShortly);
    await page.waitForTimeout(1500);
    expect(warden.count("/confirm")).toBe(0);
    await holdUntil(page, warden, "Confirm compass", "/confirm");
    expect(warden.requests("robot", "port").at(-1)).toEqual(["/confirm", "bender/0", "compass"]);
    await expect(confirm).toBeHidden();
    await holdUntil(page, warden, "Run bender/0", "/arm");
    expect(warden.refusals).toEqual([]);
  });

  test("a doubted value is not confirmed while it is old, or the warden does not respond", async ({
    page,
    server,
    warden,
  }) => {
    warden.doubt("gps", "changed by 20.0 m at once");
    warden.doubt("sonar", "no change in 3.0 s of commanded motion");
    await open(page, server);
    await takeControl(page);
    const confirm = (port: string) => page.getByRole("button", { name: `Confirm ${port}:` });
    await expect(confirm("gps")).toHaveText(
      /36°\s35.7241′\sN, 121°\s52.4921′\sW \(12.0,\s15.0\sm\son\sthe\smap\)/,
    );
    await expect(confirm("gps")).toBeEnabled();
    await expect(confirm("sonar")).toBeDisabled();
    await expect(page.getByRole("list", { name: "Why not: Confirm sonar" })).toHaveText(
      "its value is old: 4.2 s of 0.5 s",
    );
    warden.mode = "frozen";
    await expect(page.locator("#connection")).toContainText(isLate);
    await expect(confirm("gps")).toBeDisabled();
  });

  test("another jump ends the hold that confirms a value", async ({ page, server, warden }) => {
    warden.doubt("compass", "changed by 90.0 degrees at once");
    await open(page, server);
    await takeControl(page);
    const hold = pointer(page, page.getByRole("button", { name: "Confirm compass" }));
    await expect(page.getByRole("button", { name: "Confirm compass" })).toBeEnabled();
    await hold.begin();
    await page.waitForTimeout(300);
    warden.robot.faults = [{ name: "jump", reason: "compass: changed by 45.0 degrees at once" }];
    await page.waitForTimeout(1500);
    expect(warden.count("/confirm")).toBe(0);
    await hold.end();
  });

  test("a waypoint is typed in degrees and minutes, or clicked on the map and then added", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await takeControl(page);
    const field = (name: string) => page.getByRole("textbox", { name });
    await field("Degrees of latitude").fill("36");
    await field("Minutes of latitude").fill("61");
    await field("Degrees of longitude").fill("121");
    await field("Minutes of longitude").fill("52.5002");
    const error = page.getByText("Minutes of latitude: expected a number from 0");
    await clickUntilShown(button(page, "Add waypoint"), error);
    expect(warden.count("/waypoint")).toBe(0);
    await field("Minutes of latitude").fill("35.7160");
    await clickUntil(button(page, "Add waypoint"), () => warden.count("/waypoint") === 1);
    expect(warden.requests("robot", "latitude", "longitude").at(-1)).toEqual([
      "/waypoint",
      "bender/0",
      { degrees: 36, minutes: 35.716, hemisphere: "N" },
      { degrees: 121, minutes: 52.5002, hemisphere: "W" },
    ]);
    await page.getByLabel("Map of the robots").click();
    expect(warden.count("/waypoint")).toBe(1);
    await clickUntil(button(page, "Add this waypoint"), () => warden.count("/waypoint") === 2);
    const [x, y] = warden.received.findLast(({ path }) => path === "/waypoint")?.body.point_m as [
      number,
      number,
    ];
    expect(Math.abs(x - 20) + Math.abs(y - 15)).toBeLessThan(0.5);
  });

  test("the console filters by level and text", async ({ page, server, warden }) => {
    warden.robot.is_armed = true;
    await open(page, server);
    const log = page.getByRole("log");
    await expect(log.getByRole("paragraph")).toHaveCount(3);
    await page.getByRole("checkbox", { name: "info" }).uncheck();
    await expect(log.getByRole("paragraph")).toHaveCount(2);
    await page.getByRole("searchbox", { name: "Filter" }).fill("TIMER");
    await expect(log.getByRole("paragraph")).toHaveText([/no motor timer is known/]);
  });
});

test.describe("the connection", () => {
  test("is late when the warden freezes, then lost, and recovers by itself", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await takeControl(page);
    warden.mode = "frozen";
    await expect(page.locator("#connection")).toContainText(isLate);
    await expect(page.getByRole("button", { name: "Hold all robots" })).toBeDisabled();
    await expect(page.locator("#connection")).toContainText("Lost");
    warden.mode = "running";
    await expect(page.locator("#connection")).toBeHidden();
    await expect(page.getByRole("button", { name: "Hold all robots" })).toBeEnabled();
  });

  test("is late when the warden answers but its time does not advance", async ({ page, server, warden }) => {
    await open(page, server);
    warden.mode = "stuck";
    await expect(page.locator("#connection")).toContainText(isLate);
  });

  test("is lost at once when the warden is killed, and recovers when it runs again", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await warden.kill();
    await expect(page.locator("#connection")).toContainText("Lost");
    await expectAccessible(page);
    await warden.start();
    await expect(page.locator("#connection")).toBeHidden();
  });

  test("is refused with a wrong token", async ({ page, server, warden, consoleErrors }) => {
    warden.mode = "refusing";
    await page.goto(`${server.url}/#/robots`);
    await expect(page.locator("#connection")).toContainText("Refused");
    await expect(bar(page)).toContainText("does not respond");
    warden.mode = "running";
    await expect(page.locator("#connection")).toBeHidden();
    await expect(bar(page)).toContainText("Stops all robots at once.");
    // The browser reports each refusal.
    consoleErrors.length = 0;
  });

  test("shows another operator, from which control is taken by a hold", async ({ page, server, warden }) => {
    warden.giveToOther();
    await open(page, server);
    await expect(page.getByText("Controlled by another page.")).toBeVisible();
    await expect(page.getByRole("button", { name: "Run bender/0" })).toBeDisabled();
    await holdUntil(page, warden, "Take over", "/operator");
    await expect(page.getByText("This page is the operator.")).toBeVisible();
    expect(warden.requests("take", "take_over")).toEqual([["/operator", true, true]]);
  });
});

test("a robot shows what is known of it, and no more", async ({ page, server, warden }) => {
  await open(page, server);
  const card = page.getByRole("region", { name: "bender/0" });
  for (const text of ["Requested", "0.40 m/s", "x,3,", "by the robot's kernel", /Standstill\s*not confirmed/])
    await expect(card).toContainText(text);
  await expect(card).toContainText("72% (estimated)");
  await expect(card).toContainText("lost, 4.2 s of 0.5 s · closed by the robot");
  await expect(card).toContainText("not armed since the start");
  Object.assign(warden.robot, { written: null, requested: null });
  warden.confirmStandstill();
  await expect(card).toContainText(/Standstill\s*confirmed \(slower than 0.22 m\/s and 1.44°\/s\)/);
  await expectAccessible(page);
  await page.getByRole("tab", { name: "Manual" }).click();
  await expectAccessible(page);
});

test("Release leaves no button that arms or confirms under the pointer", async ({ page, server, warden }) => {
  warden.doubt("compass", "changed by 90.0 degrees at once");
  for (const tab of ["Autonomous", "Manual"]) {
    warden.robot.mode = tab === "Manual" ? "manual" : "auto";
    Object.assign(warden.state, { is_stopped: true });
    await open(page, server);
    await takeControl(page);
    await page.getByRole("tab", { name: tab }).click();
    const release = page.getByRole("button", { name: "Release" });
    await release.scrollIntoViewIfNeeded();
    const box = await release.boundingBox();
    if (!box) throw new Error("Release is not visible");
    warden.received.length = 0;
    await holdUntil(page, warden, "Release", "/release");
    await expect(release).toBeHidden();
    for (const [x, y] of [
      [4, 4],
      [box.width / 2, box.height / 2],
      [box.width - 4, box.height - 4],
    ] as const) {
      const below = await page.evaluate(
        ([x, y]) => document.elementFromPoint(x, y)?.closest("button")?.textContent ?? "",
        [box.x + x, box.y + y] as const,
      );
      expect(below).not.toMatch(/Arm|Run|Confirm|Take/);
    }
    await page.getByRole("button", { name: "Give up control" }).click();
    await expect(page.getByText("No operator.")).toBeVisible();
  }
});

test("a hold that begins while arming is not possible is reported, and counts only when it is repeated", async ({
  page,
  server,
  warden,
}) => {
  Object.assign(warden.robot, { mode: "auto" });
  await open(page, server);
  await takeControl(page);
  await page.getByRole("tab", { name: "Manual" }).click();
  await clickUntilShown(
    button(page, "Switch to manual mode"),
    page.getByRole("button", { name: "Arm bender/0" }),
  );
  warden.robot.blockers = [{ name: "mode_changed", reason: "switched to manual mode" }];
  const arm = page.getByRole("button", { name: "Arm bender/0" });
  const why = page.getByRole("list", { name: "Why not: Arm bender/0" });
  await expect(why).toHaveText("mode changed: switched to manual mode");
  await expect(arm).toBeDisabled();
  await arm.hover({ force: true });
  await page.mouse.down();
  warden.robot.blockers = [];
  await expect(page.getByText("This hold did not count")).toBeVisible();
  await page.waitForTimeout(1500);
  expect(warden.count("/arm")).toBe(0);
  await page.mouse.up();
  await expectAccessible(page);
  await holdUntil(page, warden, "Arm bender/0", "/arm");
  await expect(page.getByText("This hold did not count")).toBeHidden();
});

test("the reason for which a request is refused is beside its button", async ({ page, server, warden }) => {
  await open(page, server);
  await takeControl(page);
  await page.route("**/arm", (route) =>
    route.fulfill({
      status: 409,
      headers: { "Access-Control-Allow-Origin": "*" },
      json: { message: "nothing is known of it yet" },
    }),
  );
  const run = pointer(page, page.getByRole("button", { name: "Run bender/0" }));
  const refusal = page.getByRole("tabpanel").getByText("Not done: nothing is known of it yet");
  await expect(async () => {
    await run.end();
    await run.begin();
    await expect(refusal).toBeVisible({ timeout: 5000 });
  }).toPass();
  await run.end();
  await expect(page.getByText("nothing is known of it yet")).toHaveCount(1);
  await expectAccessible(page);
  await page.getByRole("button", { name: "Dismiss" }).click();
  await expect(refusal).toBeHidden();
  expect(warden.robot.is_armed).toBe(false);
});

test("a fault is named once", async ({ page, server, warden }) => {
  const stop = { name: "emergency_stop", reason: "emergency stop: not released" };
  Object.assign(warden.robot, {
    faults: [stop],
    blockers: [stop],
    latched: [{ name: "emergency_stop", reason: "emergency stop" }],
  });
  warden.state.is_stopped = true;
  await open(page, server);
  const card = page.getByRole("region", { name: "bender/0" });
  await expect(card.getByRole("listitem")).toHaveText(["emergency stop not released · latched"]);
  const why = page.getByRole("list", { name: "Why not: Run" });
  await expect(why.getByRole("listitem")).toHaveText(["emergency stop: not released"]);
});

test("the view of the robots opens after the page's server has been killed", async ({
  page,
  ownServer,
  warden,
}) => {
  const loaded = page.waitForResponse(/Pages-.*\.js/);
  await page.goto(ownServer.url);
  await expect(page.getByRole("link", { name: "Robots", exact: true })).toBeVisible();
  await (await loaded).finished();
  await page.waitForLoadState("networkidle");
  await ownServer.kill();
  await page.getByRole("link", { name: "Robots", exact: true }).click();
  await expect(page.getByRole("region", { name: "bender/0" })).toBeVisible();
  expect(warden.count("/stop")).toBe(0);
});

test("a server without a drive has no view of robots and no stop", async ({ page, server }) => {
  await page.goto(server.url);
  await expect(page.getByRole("link", { name: "Studies" })).toBeVisible();
  await expect(page.getByRole("link", { name: "Robots", exact: true })).toBeHidden();
  await expect(stopButton(page)).toBeHidden();
  await page.goto(`${server.url}/#/robots`);
  await expect(page.getByText("This server drives no robots.")).toBeVisible();
});
