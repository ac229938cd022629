import { readFileSync } from "node:fs";
import { copyFile } from "node:fs/promises";
import { join } from "node:path";
import { monitorEventLoopDelay } from "node:perf_hooks";
import { fileURLToPath } from "node:url";
import type { Locator, Page } from "@playwright/test";
import { pixelsOf } from "./ink";
import { expect, expectAccessiblePanels, hash, openTab, status, test } from "./page";
import { RealDrive } from "./real_drive";

// One drive at a time: several would delay each other.
test.describe.configure({ mode: "default" });

/** Of a machine that is busy with something else: the safety rules then stop the robot, as they have to. */
const maxLate_ns = 1e8;
const attempts = 3;
const forward = "x,2,175,";

/** A test with a drive of its own, which is repeated if it fails while the machine is late. */
function driveTest(
  name: string,
  trial: (page: Page, drive: RealDrive) => Promise<void>,
  scenario?: string,
): void {
  test(name, async ({ page: first, context }) => {
    for (let attempt = 1; ; attempt++) {
      const page = attempt === 1 ? first : await context.newPage();
      const [drive, delay] = [new RealDrive(scenario), monitorEventLoopDelay({ resolution: 10 })];
      delay.enable();
      try {
        await drive.start();
        await page.goto(drive.url);
        await drive.whileItRuns(trial(page, drive));
        return;
      } catch (error) {
        if (attempt === attempts || delay.max < maxLate_ns) throw error;
        await page.close();
        await context.setOffline(false);
      } finally {
        delay.disable();
        await drive.end();
      }
    }
  });
}

const button = (page: Page, name: string) => page.getByRole("button", { name });
const card = (page: Page) => page.getByRole("region", { name: "bender/0" });
const isArmed = (page: Page) => card(page).getByText("armed", { exact: true });

async function press(page: Page, control: Locator): Promise<void> {
  await expect(control).toBeEnabled();
  await control.hover();
  await page.mouse.down();
}

/** A hold ends by itself if a busy machine delays the warden's state or an input. */
async function arm(page: Page, name: string): Promise<void> {
  await expect(async () => {
    await page.mouse.up();
    await press(page, button(page, name));
    await expect(isArmed(page)).toBeVisible({ timeout: 2000 });
  }).toPass();
  await page.mouse.up();
}

/** Arms the robot, and waits until it drives to its first waypoint. */
async function run(page: Page, drive: RealDrive): Promise<void> {
  await arm(page, "Run bender/0");
  await expect.poll(async () => (await drive.look()).x_m).toBeGreaterThan(5.2);
  await expect(card(page)).toContainText("moves");
}

/** Takes control, and arms the robot in manual mode. */
async function armByHand(page: Page): Promise<void> {
  await button(page, "Take control").click();
  await page.getByRole("tab", { name: "Manual" }).click();
  await button(page, "Switch to manual mode").click();
  await arm(page, "Arm bender/0");
}

/** Holds *Forward* until the robot obeys; returns the time before. */
async function holdForward(page: Page, drive: RealDrive): Promise<number> {
  const { t_s } = await drive.look();
  await expect(async () => {
    await page.mouse.up();
    await press(page, button(page, "Forward"));
    await page.waitForTimeout(600);
    expect((await drive.movesAfter((await drive.look()).t_s - 0.3)).length).toBeGreaterThan(0);
  }).toPass();
  return t_s;
}

async function shot(page: Page, name: string): Promise<void> {
  if (process.env.SHOTS) await page.screenshot({ path: join(process.env.SHOTS, `${name}.png`) });
}

/** All notices of refused requests from now on, also of those that vanish. */
function recordNotices(): string[] {
  const found: string[] = [];
  const look = () => {
    const notices = [...document.querySelectorAll(".notices > *, [role=alert]")].map(
      ({ textContent }) => textContent ?? "",
    );
    found.push(...notices.filter((text) => text.includes("Not done:") && !found.includes(text)));
  };
  new MutationObserver(look).observe(document.body, { subtree: true, childList: true, characterData: true });
  return found;
}

/** Sends requests as the page does, which has no control for them in this tab. */
async function requestsAsOperator(page: Page): Promise<(path: string) => Promise<void>> {
  const manual = await page.waitForRequest(/\/manual$/);
  const { token, client } = manual.postDataJSON() as Record<string, string>;
  return async (path) => {
    const body = JSON.stringify({ token, client });
    const response = await fetch(new URL(path, manual.url()), { method: "POST", body });
    expect(response.status).toBe(200);
  };
}

/** Expects stop on the wire within a time, and no motion in the second after it. */
async function expectStop(drive: RealDrive, after_s: number, within_s: number): Promise<void> {
  await expect.poll(() => drive.stopAfter(after_s)).not.toBeNull();
  const stopped_s = (await drive.stopAfter(after_s)) ?? Infinity;
  expect(stopped_s - after_s).toBeLessThan(within_s);
  await new Promise((done) => setTimeout(done, 1000));
  expect(await drive.movesAfter(stopped_s)).toEqual([]);
}

driveTest("a robot is armed by a hold, drives, and is stopped by Escape", async (page, drive) => {
  await button(page, "Take control").click();
  await press(page, button(page, "Run bender/0"));
  await page.waitForTimeout(400);
  await page.mouse.up();
  await page.waitForTimeout(800);
  await expect(isArmed(page)).toBeHidden();
  expect(await drive.movesAfter(0)).toEqual([]);
  await run(page, drive);
  const { t_s } = await drive.look();
  await page.keyboard.press("Escape");
  await expectStop(drive, t_s, 0.3);
  await expect(isArmed(page)).toBeHidden();
  await expect(page.getByRole("region", { name: "Emergency stop" })).toContainText(
    /Stop is latched. bender\/0: standstill confirmed \(slower than \d\.\d\d m\/s\)/,
  );
});

driveTest("a hand that is released, or cut off, stops the robot", async (page, drive) => {
  await armByHand(page);
  const begun_s = await holdForward(page, drive);
  const released_s = (await drive.look()).t_s;
  await page.mouse.up();
  await expectStop(drive, released_s, 0.5);
  expect(new Set(await drive.movesAfter(begun_s))).toEqual(new Set([forward]));
  await holdForward(page, drive);
  await page.context().setOffline(true);
  await expectStop(drive, (await drive.look()).t_s, 0.5);
  await expect(page.locator("#connection")).toContainText("Lost");
  const back_s = (await drive.look()).t_s;
  await page.context().setOffline(false);
  await expect(page.locator("#connection")).toBeHidden();
  await page.waitForTimeout(1500);
  await page.mouse.up();
  expect(await drive.movesAfter(back_s)).toEqual([]);
});

driveTest(
  "a control that is held through a hold moves nothing until it was released",
  async (page, drive) => {
    await armByHand(page);
    await holdForward(page, drive);
    const request = await requestsAsOperator(page);
    const held_s = (await drive.look()).t_s;
    await request("/hold");
    await expectStop(drive, held_s, 0.3);
    await request("/resume");
    await expect(card(page)).toContainText("controls deflected");
    await expect(card(page)).not.toContainText("all robots are held");
    await expect(page.getByText("The controls are not neutral: release them first.")).toBeVisible();
    await page.waitForTimeout(2000);
    expect(await drive.movesAfter(held_s + 0.3)).toEqual([]);
    await page.mouse.up();
    await holdForward(page, drive);
    await page.mouse.up();
  },
);

driveTest(
  "a compass that has turned keeps the robot stopped until its value is confirmed",
  async (page, drive) => {
    await button(page, "Take control").click();
    await run(page, drive);
    await drive.fault("compass", "jump", 90);
    await expect(page.getByRole("list", { name: "Why not: Run" })).toHaveText(/jump: compass: changed by/);
    await page.waitForTimeout(3000);
    await expect(button(page, "Run bender/0")).toBeDisabled();
    const confirm = button(page, "Confirm compass");
    await expect(confirm).toHaveText(/^Confirm compass: \d+\.\d degrees magnetic/);
    await press(page, confirm);
    await expect(confirm).toBeHidden();
    await page.mouse.up();
    await arm(page, "Run bender/0");
    await page.keyboard.press("Escape");
  },
);

driveTest("normal use shows no error notice", async (page, drive) => {
  const notices = await page.evaluateHandle(recordNotices);
  await armByHand(page);
  await holdForward(page, drive);
  await page.mouse.up();
  await page.getByRole("tab", { name: "Autonomous" }).click();
  await button(page, "Switch to automatic mode").click();
  await run(page, drive);
  await button(page, "Hold all robots").click();
  await expect(page.getByText("On hold.")).toBeVisible();
  await press(page, button(page, "Run bender/0"));
  await expect(page.getByText("On hold.")).toBeHidden();
  await page.mouse.up();
  const navigates = page.getByRole("checkbox", { name: "Navigate to waypoints" });
  await navigates.click();
  await expect(navigates).not.toBeChecked();
  await page.keyboard.press("Escape");
  await press(page, button(page, "Release"));
  await expect(button(page, "Release")).toBeHidden();
  await page.mouse.up();
  await page.getByRole("tab", { name: "Manual" }).click();
  await button(page, "Switch to manual mode").click();
  await arm(page, "Arm bender/0");
  await button(page, "Give up control").click();
  await expect(page.getByText("No operator.")).toBeVisible();
  expect(await notices.jsonValue()).toEqual([]);
});

driveTest("a robot whose connections were lost remains stopped when it is back", async (page, drive) => {
  await button(page, "Take control").click();
  await run(page, drive);
  await drive.killEmulator();
  await expect(card(page)).toContainText("stopped, latched");
  await expect(card(page)).toContainText(/motors\s*(lost|connecting)/);
  await expect(card(page)).toContainText("lost link");
  await drive.startEmulator();
  await expect(card(page)).toContainText(/motors\s*connected/);
  await expect(button(page, "Run bender/0")).toBeEnabled();
  expect(await drive.movesAfter(0)).toEqual([]);
  expect(await drive.stopAfter(0)).not.toBeNull();
  await expect(isArmed(page)).toBeHidden();
});

driveTest("a loop that is suspended stops the robot, and the page shows it", async (page, drive) => {
  await button(page, "Take control").click();
  await run(page, drive);
  const { t_s } = await drive.look();
  await drive.signal("live.loop", "SIGSTOP");
  await expectStop(drive, t_s, 0.6);
  await expect(card(page)).toContainText("loop silent");
  await expect(card(page)).toContainText("stopped, latched");
  await expect(button(page, "Run bender/0")).toBeDisabled();
  await drive.signal("live.loop", "SIGCONT");
  await expect(button(page, "Run bender/0")).toBeEnabled();
  expect(await drive.movesAfter(t_s + 0.6)).toEqual([]);
});

driveTest(
  "a killed server of the page takes no control from an open page, and is replaced",
  async (page, drive) => {
    await armByHand(page);
    await holdForward(page, drive);
    await drive.signal("server.live", "SIGKILL");
    const killed_s = (await drive.look()).t_s;
    await page.waitForTimeout(1000);
    expect((await drive.movesAfter(killed_s + 0.5)).length).toBeGreaterThan(1);
    expect(await drive.stopAfter(killed_s)).toBeNull();
    const left_s = (await drive.look()).t_s;
    await expect(async () => void (await page.reload())).toPass();
    await expectStop(drive, left_s, 0.6);
    await expect(page.getByText("No operator.")).toBeVisible();
    await expect(card(page)).toContainText("no setpoint");
    await page.mouse.up();
  },
);

const textOf = (file: string) => readFileSync(fileURLToPath(new URL(file, import.meta.url)), "utf8");
/** One real robot with a virtual sensor, and simulated ones. */
const mixed = textOf("../../scenarios/bender.toml") + textOf("simulated_robots.toml");
const checkbox = (page: Page, name: string) => page.getByRole("checkbox", { name, exact: true });
/** Virtual readings. */
const magenta = [163, 25, 91];

driveTest(
  "what a real robot perceives of simulated ones is shown, and where it may be once it is silent",
  async (page, drive) => {
    await button(page, "Take control").click();
    await run(page, drive);
    await page.goto(drive.url.replace("#/robots", "#/run?live=1&robot=bender/0"));
    await expect(status(page)).toContainText("4 robots");
    await openTab(page, "Layers");
    for (const name of ["Uncertainty", "Real readings", "Virtual readings"])
      await expect(checkbox(page, name)).toBeChecked();
    for (const of of ["real: echo", "virtual: echo", "virtual: robot", "silent", "uncertainty", "real robot"])
      await expect(page.getByRole("listitem").filter({ hasText: of }).first()).toBeVisible();
    await expect.poll(() => pixelsOf(page, magenta)).toBeGreaterThan(20);
    await shot(page, "mixed");
    await checkbox(page, "Virtual readings").uncheck();
    await expect.poll(() => pixelsOf(page, magenta)).toBe(0);
    await openTab(page, "Robot");
    const row = (name: string) => page.getByRole("row").filter({ hasText: name });
    await expect(row("Virtual sensors")).toContainText("eye");
    await expect(row("Real sensors")).toContainText("compass, gps, sonar_0, sonar_1");
    await expect(row("Uncertainty")).toContainText(/0\.\d\d m/);
    await expectAccessiblePanels(page, ["Layers", "Robot"]);
    await drive.killEmulator();
    await expect(page.getByText(/^Silent for \d+\.\d s: it may be anywhere/)).toBeVisible();
    await shot(page, "silent");
  },
  mixed,
);

test("the recording of a drive opens, and seeks forth and back", async ({ page, server }) => {
  const drive = new RealDrive();
  try {
    await drive.start("--headless", "--arm");
    await expect.poll(async () => (await drive.look()).x_m).toBeGreaterThan(5.5);
    await drive.interrupt();
    await copyFile(drive.recording, join(server.folder, "drive.mcap"));
  } finally {
    await drive.end();
  }
  await page.goto(`${server.url}/#/recordings`);
  await expect(page.getByRole("row", { name: /^drive.mcap bender 0 0 \d+/ })).toBeVisible();
  await page.getByRole("link", { name: "drive.mcap", exact: true }).click();
  const slider = page.getByRole("slider", { name: "Time" });
  await expect(status(page)).toContainText("0.0 s, 1 robot");
  const last = Number(await slider.getAttribute("max"));
  const hashes = new Map<number, string | null>();
  for (const tick of [last, 20, last, 20]) {
    await slider.fill(String(tick));
    await expect(status(page)).toContainText(`${(tick / 10).toFixed(1)} s, 1 robot`);
    const there = await hash(page);
    expect(hashes.get(tick) ?? there).toBe(there);
    hashes.set(tick, there);
  }
  expect(new Set(hashes.values()).size).toBe(2);
  await expect(page.getByRole("alert")).toHaveCount(0);
});
