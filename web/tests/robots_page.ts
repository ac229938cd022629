import type { Locator, Page } from "@playwright/test";
import { expect, test as base } from "./page";
import { FakeWarden, isNeutral } from "./warden";

/** A page whose server belongs to a drive, with a fake warden. */
export const test = base.extend<{ warden: FakeWarden }>({
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

export const bar = (page: Page) => page.getByRole("region", { name: "Emergency stop" });
/** The connection is stale for a moment only, which the test may miss. */
export const isLate = /Stale|Lost/;
export const stopButton = (page: Page) => page.getByRole("button", { name: "Emergency stop of all robots" });

export async function open(page: Page, { url }: { url: string }): Promise<void> {
  await page.goto(`${url}/#/robots`);
  await expect(page.getByRole("region", { name: "bender/0" })).toBeVisible();
}

/**
 * After which an attempt is repeated: while the warden's state is late, as on a busy machine, controls are
 * disabled, so that a click is lost and a hold ends.
 */
const attempt_ms = 5000;

/** Clicks a control until that has had its effect. */
export async function clickUntil(control: Locator, isDone: () => boolean | Promise<boolean>): Promise<void> {
  await expect(async () => {
    if (!(await isDone())) await control.click({ timeout: attempt_ms });
    await expect.poll(isDone, { timeout: attempt_ms }).toBe(true);
  }).toPass();
}

export const clickUntilShown = (control: Locator, shown: Locator) =>
  clickUntil(control, () => shown.isVisible());

export const takeControl = (page: Page) =>
  clickUntilShown(button(page, "Take control"), page.getByText("This page is the operator."));

/** Opens the view as operator, with the robot armed in manual mode. */
export async function openManual(page: Page, server: { url: string }, warden: FakeWarden): Promise<void> {
  Object.assign(warden.robot, { mode: "manual", is_armed: true, action: "move" });
  await open(page, server);
  await takeControl(page);
  await page.getByRole("tab", { name: "Manual" }).click();
  warden.received.length = 0;
}

export const button = (page: Page, name: string) => page.getByRole("button", { name, exact: true });
export const slider = (page: Page, name: string) => page.getByRole("slider", { name });

/** A control that can be held. */
export interface Hold {
  begin(): Promise<void>;
  end(): Promise<void>;
}

export function pointer(page: Page, control: Locator): Hold {
  return {
    async begin() {
      await control.hover({ timeout: attempt_ms });
      await page.mouse.down();
    },
    end: () => page.mouse.up(),
  };
}

/** Drags a slider to its right end. */
export function drag(page: Page, control: Locator): Hold {
  const { begin, end } = pointer(page, control);
  return {
    async begin() {
      await begin();
      const box = await control.boundingBox();
      if (!box) throw new Error("not visible");
      await page.mouse.move(box.x + box.width - 2, box.y + box.height / 2, { steps: 4 });
    },
    end,
  };
}

/** Holds a key, in a control if one is given. */
export function key(page: Page, name: string, control?: Locator): Hold {
  return {
    async begin() {
      await control?.focus();
      await page.keyboard.down(name);
    },
    end: () => page.keyboard.up(name),
  };
}

/** Holds a control until its motor values are sent. */
export async function drive(
  warden: FakeWarden,
  { begin, end }: Hold,
  left: number,
  right: number,
): Promise<void> {
  await expect(async () => {
    await end();
    await begin();
    await expect.poll(() => warden.tracks().at(-1), { timeout: attempt_ms }).toMatchObject({ left, right });
  }).toPass();
}

/** Holds a button until its request has been sent. */
export async function holdUntil(page: Page, warden: FakeWarden, name: string, path: string): Promise<void> {
  const { begin, end } = pointer(page, page.getByRole("button", { name }));
  await expect(async () => {
    if (warden.count(path) === 0) {
      await begin();
      await expect(page.locator(".held")).toHaveCount(0);
      await end();
    }
    await expect.poll(() => warden.count(path), { timeout: attempt_ms }).toBe(1);
  }).toPass();
}

/** Expects neutral values, and no others, once the motion has ended and what was sent before has arrived. */
export async function expectNeutralAfter(warden: FakeWarden, end: () => Promise<unknown>): Promise<void> {
  await end();
  await expect.poll(() => warden.tracks().slice(-5).every(isNeutral)).toBe(true);
}

/** Expects no motor values once the motion has ended and what was sent before has arrived. */
export async function expectNothingAfter(
  page: Page,
  warden: FakeWarden,
  end: () => Promise<unknown>,
): Promise<void> {
  await end();
  await expect(async () => {
    const { length } = warden.tracks();
    await page.waitForTimeout(600);
    expect(warden.tracks()).toHaveLength(length);
  }).toPass();
}

/** Expects an action to latch the stop. */
export async function expectStopBy(
  page: Page,
  warden: FakeWarden,
  action: () => Promise<unknown>,
): Promise<void> {
  warden.state.is_stopped = false;
  await expect(bar(page)).toContainText("Stops all robots at once.");
  await action();
  await expect(bar(page)).toContainText("Stop is latched");
}

export function pressShortly(control: Element): void {
  control.dispatchEvent(new PointerEvent("pointerdown", { bubbles: true }));
  control.dispatchEvent(new PointerEvent("pointerup", { bubbles: true }));
}
