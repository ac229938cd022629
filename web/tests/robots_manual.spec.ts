import type { Page } from "@playwright/test";
import { expect } from "./page";
import {
  button,
  clickUntilShown,
  drag,
  drive,
  expectNeutralAfter,
  expectNothingAfter,
  expectStopBy,
  type Hold,
  holdUntil,
  isLate,
  key,
  openManual,
  pointer,
  slider,
  takeControl,
  test,
} from "./robots_page";
import { type FakeWarden, isNeutral } from "./warden";

test.describe("manual control", () => {
  const buttons: [string, string, number, number][] = [
    ["Forward", "ArrowUp", 175, 175],
    ["Reverse", "ArrowDown", 125, 125],
    ["Left", "ArrowLeft", 125, 175],
    ["Right", "ArrowRight", 175, 125],
  ];
  for (const [name, arrow, left, right] of buttons) {
    test(`${name} is sent while the button or the key is held, neutral values after`, async ({
      page,
      server,
      warden,
    }) => {
      await openManual(page, server, warden);
      for (const hold of [pointer(page, button(page, name)), key(page, arrow)]) {
        await drive(warden, hold, left, right);
        await expectNeutralAfter(warden, hold.end);
      }
      const all = warden.requests("robot", "left", "right");
      expect(new Set(all.map(String))).toEqual(new Set([`/manual,bender/0,${left},${right}`]));
    });
  }

  test("a slider sends what the sliders show, only while it is held", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    const holds: [Hold, number, number][] = [
      [drag(page, slider(page, "Left track")), 200, 150],
      [key(page, "Home", slider(page, "Right track")), 200, 100],
      [key(page, "Home", slider(page, "Both tracks")), 100, 100],
    ];
    for (const [hold, left, right] of holds) {
      await drive(warden, hold, left, right);
      await expectNeutralAfter(warden, hold.end);
      await expect(slider(page, "Left track")).toHaveValue(String(left));
      await expect(slider(page, "Right track")).toHaveValue(String(right));
    }
  });

  test("stop sends stop only, and moves no slider", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    const hold = key(page, "End", slider(page, "Left track"));
    await drive(warden, hold, 200, 150);
    await expectNeutralAfter(warden, hold.end);
    warden.received.length = 0;
    await expectStopBy(page, warden, () => button(page, "Stop (latched)").click());
    await expect(slider(page, "Left track")).toHaveValue("200");
    await expect(button(page, "Forward")).toBeDisabled();
    expect(new Set(warden.requests().map(String))).toEqual(new Set(["/stop"]));
  });

  test("a key that is held while the robot is armed is a reason against it", async ({
    page,
    server,
    warden,
  }) => {
    await openManual(page, server, warden);
    Object.assign(warden.robot, { is_armed: false, action: "latched_stop" });
    const why = page.getByRole("list", { name: "Why not: Arm" });
    const arm = button(page, "Arm bender/0 hold 1 s");
    await expect(arm).toBeEnabled();
    await arm.focus(); // in the tabs, arrow keys would select tabs
    await page.keyboard.down("ArrowUp");
    await expect(why).toHaveText("controls deflected: the controls are not neutral: release them first");
    await expect(arm).toBeDisabled();
    await page.keyboard.up("ArrowUp");
    await expect(why).toBeHidden();
    await holdUntil(page, warden, "Arm bender/0", "/arm");
    expect(warden.tracks().every(isNeutral)).toBe(true);
  });

  test("a control that is held since before a stop is a reason against arming, and moves nothing", async ({
    page,
    server,
    warden,
  }) => {
    await openManual(page, server, warden);
    const hold = pointer(page, button(page, "Forward"));
    await drive(warden, hold, 175, 175);
    Object.assign(warden.robot, { is_armed: false, action: "latched_stop" });
    await expect(page.getByRole("list", { name: "Why not: Arm" })).toHaveText(/controls are not neutral/);
    warden.received.length = 0;
    Object.assign(warden.robot, { is_armed: true, action: "move" });
    await expect(button(page, "Forward")).toBeEnabled();
    await page.waitForTimeout(1000);
    expect(warden.tracks().every(isNeutral)).toBe(true);
    await hold.end();
    await drive(warden, hold, 175, 175);
    await hold.end();
  });

  test("controls that the warden finds deflected are named where they are held", async ({
    page,
    server,
    warden,
  }) => {
    await openManual(page, server, warden);
    warden.robot.faults = [
      { name: "controls_deflected", reason: "the controls are not neutral: release them first" },
    ];
    const hint = page.getByText("The controls are not neutral: release them first.");
    await expect(page.getByRole("region", { name: "bender/0" })).toContainText("controls deflected");
    await expect(hint).toBeHidden();
    await drive(warden, pointer(page, button(page, "Forward")), 175, 175);
    await expect(hint).toBeVisible();
    await page.mouse.up();
    await expect(hint).toBeHidden();
  });

  test("giving up control, and taking it again, shows no error", async ({ page, server, warden }) => {
    await openManual(page, server, warden);
    for (let i = 0; i < 3; i++) {
      await clickUntilShown(button(page, "Give up control"), page.getByText("No operator."));
      await takeControl(page);
    }
    await expect(page.getByText("Not done:")).toBeHidden();
    warden.received.length = 0;
    await expect.poll(() => warden.tracks().length).toBeGreaterThan(3);
  });

  const releases: [string, (page: Page) => Promise<unknown>][] = [
    ["the window loses the focus", (page) => page.evaluate("dispatchEvent(new Event('blur'))")],
    ["the pointer is cancelled", (page) => page.evaluate("dispatchEvent(new Event('pointercancel'))")],
    ["Escape is pressed", (page) => page.keyboard.press("Escape")],
  ];
  for (const [name, end] of releases) {
    test(`only neutral values are sent once ${name}`, async ({ page, server, warden }) => {
      await openManual(page, server, warden);
      await drive(warden, pointer(page, button(page, "Forward")), 175, 175);
      await expectNeutralAfter(warden, () => end(page));
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
        await expect(page.locator("#connection")).toContainText(isLate);
      },
    ],
  ];
  for (const [name, end] of ends) {
    test(`nothing is sent any more once ${name}`, async ({ page, server, warden }) => {
      await openManual(page, server, warden);
      await drive(warden, pointer(page, button(page, "Forward")), 175, 175);
      await expectNothingAfter(page, warden, () => end(page, warden));
      await page.mouse.up();
    });
  }
});

function hide(): void {
  Object.defineProperty(document, "hidden", { value: true, configurable: true });
  document.dispatchEvent(new Event("visibilitychange"));
}
