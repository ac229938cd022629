import type { Locator, Page } from "@playwright/test";
import { expect, expectAccessible, openRun, test as base } from "./page";
import { FakeWarden, isNeutral, type Received } from "./warden";

/** A page whose server belongs to a drive, with a fake warden. */
const test = base.extend<{ warden: FakeWarden }>({
  // The policy of this server does not name the fake warden's port; python/tests/test_server_drive.py tests that.
  bypassCSP: true,
  warden: async ({ page }, use) => {
    const warden = new FakeWarden();
    await warden.start();
    await warden.attach(page);
    await use(warden);
    await warden.kill();
  },
});

const bar = (page: Page) => page.getByRole("region", { name: "Emergency stop" });
const stopButton = (page: Page) => page.getByRole("button", { name: "Emergency stop of all robots" });

async function open(page: Page, { url }: { url: string }): Promise<void> {
  await page.goto(`${url}/#/robots`);
  await expect(page.getByRole("region", { name: "bender/0" })).toBeVisible();
}

/** Opens the view as operator, with the robot armed in manual mode. */
async function openManual(page: Page, server: { url: string }, warden: FakeWarden): Promise<void> {
  Object.assign(warden.robot, { mode: "manual", is_armed: true, action: "move" });
  await open(page, server);
  await page.getByRole("button", { name: "Take control" }).click();
  await page.getByRole("tab", { name: "Manual" }).click();
  await expect(button(page, "Forward")).toBeEnabled();
  warden.received.length = 0;
}

const button = (page: Page, name: string) => page.getByRole("button", { name, exact: true });
const slider = (page: Page, name: string) => page.getByRole("slider", { name });

async function press(page: Page, control: Locator, hold_ms: number): Promise<void> {
  const box = await control.boundingBox();
  if (!box) throw new Error("not visible");
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.waitForTimeout(hold_ms);
}

/** Presses a control until motion is sent. A press ends by itself if a busy machine delays the warden's state. */
async function drive(page: Page, warden: FakeWarden, control: Locator): Promise<void> {
  await expect(async () => {
    await page.mouse.up();
    await press(page, control, 300);
    expect(warden.requests().length).toBeGreaterThan(1);
  }).toPass();
}

/** Holds a button until a request arrives. */
async function holdUntil(page: Page, warden: FakeWarden, name: string, path: string): Promise<void> {
  await press(page, page.getByRole("button", { name }), 0);
  await expect.poll(() => warden.count(path)).toBe(1);
  await page.mouse.up();
}

/** Lets the caller end the motion, and returns what is sent from then on: neutral values, or nothing. */
async function afterEnd(page: Page, warden: FakeWarden, end: () => Promise<unknown>): Promise<Received[]> {
  await end();
  await page.waitForTimeout(150);
  const { length } = warden.received;
  await page.waitForTimeout(600);
  return warden.received.slice(length).filter(({ path }) => path === "/manual");
}

/** As `afterEnd`, and expects neutral values. */
async function expectNeutralAfter(
  page: Page,
  warden: FakeWarden,
  end: () => Promise<unknown>,
): Promise<void> {
  const sent = await afterEnd(page, warden, end);
  expect(sent.length).toBeGreaterThan(0);
  expect(sent.every(({ body }) => isNeutral(body))).toBe(true);
}

test.describe("the emergency stop", () => {
  test("is sent by one press, alone, and confirmed by the standstill of each robot", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await press(page, stopButton(page), 0);
    await expect(bar(page)).toContainText("bender/0: standstill not confirmed");
    await page.mouse.up();
    warden.robot.is_standing = true;
    await expect(bar(page)).toContainText("bender/0: standstill confirmed");
    expect(warden.requests("client")).toEqual([["/stop", undefined]]);
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
      await page.keyboard.press("Escape");
      await expect.poll(() => warden.count("/stop")).toBe(1);
      await expect(bar(page)).toContainText("Stop is latched");
    });
  }

  test("is sent by Escape in a text field and in a dialog, which closes, and by a press above it", async ({
    page,
    server,
    warden,
  }) => {
    await openRun(page, server, "scenario=search");
    await page.getByRole("button", { name: "Keyboard shortcuts" }).click();
    await expect(page.getByRole("dialog")).toBeVisible();
    await page.keyboard.press("Escape");
    await expect(page.getByRole("dialog")).toBeHidden();
    await expect.poll(() => warden.count("/stop")).toBe(1);
    await page.getByRole("button", { name: "New run" }).click();
    await page.getByRole("dialog").getByRole("textbox").first().focus();
    await page.keyboard.press("Escape");
    await expect.poll(() => warden.count("/stop")).toBe(2);
    await page.getByRole("button", { name: "New run" }).click();
    await stopButton(page).click();
    await expect.poll(() => warden.count("/stop")).toBe(3);
    await page.getByRole("button", { name: "Close" }).click();
    await stopButton(page).click();
    await expect.poll(() => warden.count("/stop")).toBe(4);
  });

  test("is repeated until the warden answers, and never called confirmed before", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    warden.robot.is_standing = true;
    warden.mode = "frozen";
    await page.keyboard.press("Escape");
    await expect(bar(page)).toContainText("Stop requested, not confirmed: the warden does not respond");
    await expect.poll(() => warden.count("/stop")).toBeGreaterThan(3);
    await expect(bar(page)).not.toContainText("standstill confirmed");
    warden.mode = "running";
    await expect(bar(page)).toContainText("bender/0: standstill confirmed");
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
    await page.keyboard.press("Escape");
    await expect.poll(() => warden.count("/stop")).toBe(1);
  });

  test("is released by a hold of 1 s, which arms nothing", async ({ page, server, warden }) => {
    warden.state.is_stopped = true;
    await open(page, server);
    await page.getByRole("button", { name: "Take control" }).click();
    await expect(page.getByRole("button", { name: "Release" })).toBeEnabled();
    await press(page, page.getByRole("button", { name: "Release" }), 500);
    await page.mouse.up();
    await page.waitForTimeout(800);
    expect(warden.count("/release")).toBe(0);
    await holdUntil(page, warden, "Release", "/release");
    expect(warden.requests()).toEqual([["/operator"], ["/release"]]);
    await expect(bar(page)).toContainText("Stops all robots at once.");
  });
});

test.describe("manual control", () => {
  const buttons: [string, string, number, number][] = [
    ["Forward", "ArrowUp", 175, 175],
    ["Reverse", "ArrowDown", 125, 125],
    ["Left", "ArrowLeft", 125, 175],
    ["Right", "ArrowRight", 175, 125],
  ];
  for (const [name, key, left, right] of buttons) {
    test(`${name} is sent every 0.1 s while the button or the key is held, neutral values after`, async ({
      page,
      server,
      warden,
    }) => {
      await openManual(page, server, warden);
      await drive(page, warden, button(page, name));
      await expectNeutralAfter(page, warden, () => page.mouse.up());
      await page.locator("h1").click({ position: { x: 0, y: 0 }, force: true });
      await page.keyboard.down(key);
      await expectNeutralAfter(page, warden, () => page.keyboard.up(key));
      const all = warden.requests("robot", "left", "right");
      expect(new Set(all.map(String))).toEqual(new Set([`/manual,bender/0,${left},${right}`]));
      const numbers = warden.received.map(({ body }) => body.number).filter((each) => each !== undefined);
      expect(numbers).toEqual([...numbers].sort((a, b) => Number(a) - Number(b)));
    });
  }

  test("the period is 0.1 s", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    await press(page, button(page, "Forward"), 2000);
    await page.mouse.up();
    // A busy machine delays some of them; more often than every 0.1 s is never right.
    expect(warden.requests().length).toBeGreaterThan(10);
    expect(warden.requests().length).toBeLessThanOrEqual(22);
  });

  test("a slider sends what the sliders show, only while it is held", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    const box = await slider(page, "Left track").boundingBox();
    if (!box) throw new Error("not visible");
    const y = box.y + box.height / 2;
    await page.mouse.move(box.x + box.width / 2, y);
    await page.mouse.down();
    await page.mouse.move(box.x + box.width - 2, y, { steps: 4 });
    await expect(slider(page, "Left track")).toHaveValue("200");
    await expect.poll(() => warden.requests("left", "right").at(-1)).toEqual(["/manual", 200, 150]);
    await expectNeutralAfter(page, warden, () => page.mouse.up());
    await slider(page, "Right track").focus();
    await page.keyboard.down("ArrowUp");
    await expect.poll(() => warden.requests("left", "right").at(-1)).toEqual(["/manual", 200, 155]);
    await expectNeutralAfter(page, warden, () => page.keyboard.up("ArrowUp"));
    await slider(page, "Both tracks").focus();
    await page.keyboard.down("Home");
    await expect.poll(() => warden.requests("left", "right").at(-1)).toEqual(["/manual", 100, 100]);
    await expectNeutralAfter(page, warden, () => page.keyboard.up("Home"));
    await expect(slider(page, "Left track")).toHaveValue("100");
  });

  test("stop sends stop only, and moves no slider", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    await slider(page, "Left track").press("ArrowUp");
    warden.received.length = 0;
    await button(page, "Stop (latched)").click();
    await expect.poll(() => warden.requests()).toEqual([["/stop"]]);
    await expect(slider(page, "Left track")).toHaveValue("155");
    await expect(button(page, "Forward")).toBeDisabled();
    expect(warden.requests()).toEqual([["/stop"]]);
  });

  const releases: [string, (page: Page) => Promise<unknown>][] = [
    ["the window loses the focus", (page) => page.evaluate("dispatchEvent(new Event('blur'))")],
    ["the pointer is cancelled", (page) => page.evaluate("dispatchEvent(new Event('pointercancel'))")],
    ["Escape is pressed", (page) => page.keyboard.press("Escape")],
  ];
  for (const [name, end] of releases) {
    test(`only neutral values are sent once ${name}`, async ({ page, server, warden }) => {
      await openManual(page, server, warden);
      await drive(page, warden, button(page, "Forward"));
      await expectNeutralAfter(page, warden, () => end(page));
      await page.mouse.up();
    });
  }

  const ends: [string, (page: Page, warden: FakeWarden) => Promise<unknown>][] = [
    ["the tab is hidden", (page) => page.evaluate(hide)],
    ["the tab Autonomous is opened", (page) => page.getByRole("tab", { name: "Autonomous" }).press("Enter")],
    ["the view is left", (page) => page.evaluate("location.hash = '#/'")],
    [
      "another page takes over",
      async (page, warden) => {
        warden.giveToOther();
        await expect(page.getByText("Controlled by another page.")).toBeVisible();
      },
    ],
    [
      "the warden freezes",
      async (page, warden) => {
        warden.mode = "frozen";
        await expect(page.locator("#connection")).toContainText("Stale");
      },
    ],
  ];
  for (const [name, end] of ends) {
    test(`nothing is sent any more once ${name}`, async ({ page, server, warden }) => {
      await openManual(page, server, warden);
      await drive(page, warden, button(page, "Forward"));
      expect(await afterEnd(page, warden, () => end(page, warden))).toEqual([]);
      await page.mouse.up();
    });
  }
});

function hide(): void {
  Object.defineProperty(document, "hidden", { value: true, configurable: true });
  document.dispatchEvent(new Event("visibilitychange"));
}

test.describe("autonomous control", () => {
  test("each control sends its request, and nothing else", async ({ page, server, warden }) => {
    await open(page, server);
    await page.getByRole("button", { name: "Take control" }).click();
    await page.getByRole("button", { name: "Hold all robots" }).click();
    await expect(page.getByText("On hold.")).toBeVisible();
    await holdUntil(page, warden, "Run bender/0", "/arm");
    await page.getByRole("checkbox", { name: "Navigate to waypoints" }).click();
    await expect(page.getByRole("checkbox", { name: "Navigate to waypoints" })).not.toBeChecked();
    await page.getByRole("button", { name: "Give up control" }).click();
    await expect(page.getByText("No operator.")).toBeVisible();
    await button(page, "Stop (latched)").click();
    await expect
      .poll(() => warden.requests("take", "robots", "robot", "is_on"))
      .toEqual([
        ["/operator", true, undefined, undefined, undefined],
        ["/hold", undefined, undefined, undefined, undefined],
        ["/resume", undefined, undefined, undefined, undefined],
        ["/arm", undefined, ["bender/0"], undefined, undefined],
        ["/navigate", undefined, undefined, "bender/0", false],
        ["/operator", false, undefined, undefined, undefined],
        ["/stop", undefined, undefined, undefined, undefined],
      ]);
  });

  test("a robot that cannot be armed cannot be run, and the reasons are listed", async ({
    page,
    server,
    warden,
  }) => {
    warden.robot.blockers = [{ name: "stale_input", reason: "sonar: 4.2 s old, at most 0.5 s" }];
    await open(page, server);
    await page.getByRole("button", { name: "Take control" }).click();
    await expect(page.getByRole("list", { name: "Why not: Run" })).toHaveText(
      /stale input: sonar: 4.2 s old/,
    );
    await press(page, page.getByRole("button", { name: "Run bender/0" }), 1200);
    await page.mouse.up();
    expect(warden.count("/arm")).toBe(0);
  });

  test("a waypoint is typed in degrees and minutes, or clicked on the map and then added", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await page.getByRole("button", { name: "Take control" }).click();
    const field = (name: string) => page.getByRole("textbox", { name });
    await field("Degrees of latitude").fill("36");
    await field("Minutes of latitude").fill("61");
    await field("Degrees of longitude").fill("121");
    await field("Minutes of longitude").fill("52.5002");
    await button(page, "Add waypoint").click();
    await expect(page.getByText("Minutes of latitude: expected a number from 0")).toBeVisible();
    expect(warden.count("/waypoint")).toBe(0);
    await field("Minutes of latitude").fill("35.7160");
    await button(page, "Add waypoint").click();
    await expect
      .poll(() => warden.requests("robot", "latitude", "longitude").at(-1))
      .toEqual([
        "/waypoint",
        "bender/0",
        { degrees: 36, minutes: 35.716, hemisphere: "N" },
        { degrees: 121, minutes: 52.5002, hemisphere: "W" },
      ]);
    await page.getByLabel("Map of the robots").click();
    expect(warden.count("/waypoint")).toBe(1);
    await button(page, "Add this waypoint").click();
    await expect.poll(() => warden.count("/waypoint")).toBe(2);
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
  test("is stale when the warden freezes, then lost, and recovers by itself", async ({
    page,
    server,
    warden,
  }) => {
    await open(page, server);
    await page.getByRole("button", { name: "Take control" }).click();
    warden.mode = "frozen";
    await expect(page.locator("#connection")).toContainText("Stale");
    await expect(page.getByRole("button", { name: "Hold all robots" })).toBeDisabled();
    await expect(page.locator("#connection")).toContainText("Lost");
    warden.mode = "running";
    await expect(page.locator("#connection")).toBeHidden();
    await expect(page.getByRole("button", { name: "Hold all robots" })).toBeEnabled();
  });

  test("is stale when the warden answers but its time does not advance", async ({ page, server, warden }) => {
    await open(page, server);
    warden.mode = "stuck";
    await expect(page.locator("#connection")).toContainText("Stale");
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

  test("has one request for the state in flight at most", async ({ page, server, warden }) => {
    await open(page, server);
    warden.mode = "frozen";
    const { length } = warden.received;
    await page.waitForTimeout(2000);
    // One per 0.5 s of this view, and of the stop's own path.
    expect(warden.received.length - length).toBeLessThan(12);
  });
});

test("a robot shows what is known of it, and no more", async ({ page, server, warden }) => {
  await open(page, server);
  const card = page.getByRole("region", { name: "bender/0" });
  for (const text of [
    "Requested",
    "0.40 m/s",
    "x,3,",
    "by the robot's kernel",
    "Standstill",
    "not confirmed",
  ])
    await expect(card).toContainText(text);
  await expect(card).toContainText("72% (estimated)");
  await expect(card).toContainText("lost, 4.2 s of 0.5 s · closed by the robot");
  await expect(card).toContainText("not armed since the start");
  Object.assign(warden.robot, { is_standing: true, written: null, requested: null });
  await expect(card).toContainText("confirmed");
  await expectAccessible(page);
  await page.getByRole("tab", { name: "Manual" }).click();
  await expectAccessible(page);
});

test("a server without a drive has no view of robots and no stop", async ({ page, server }) => {
  await page.goto(server.url);
  await expect(page.getByRole("link", { name: "Studies" })).toBeVisible();
  await expect(page.getByRole("link", { name: "Robots", exact: true })).toBeHidden();
  await expect(stopButton(page)).toBeHidden();
  await page.goto(`${server.url}/#/robots`);
  await expect(page.getByText("This server drives no robots.")).toBeVisible();
});
