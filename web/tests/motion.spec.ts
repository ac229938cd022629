import type { Page } from "@playwright/test";
import { expect, runAt, status, test } from "./page";

/** Counts the pictures drawn of robots, and the frames and states received, while a run plays. */
async function play(
  page: Page,
  url: string,
): Promise<() => Promise<[pictures: number, frames: number, states: number]>> {
  await page.addInitScript(() => {
    const draw = WebGL2RenderingContext.prototype.drawElements;
    Object.assign(globalThis, { pictures: 0 });
    WebGL2RenderingContext.prototype.drawElements = function (...given) {
      // Only calls that draw all robots; marks are drawn by other calls.
      if (given[3] === 0 && given[1] === 6 * 4) (globalThis as unknown as { pictures: number }).pictures += 1;
      return draw.apply(this, given);
    };
  });
  let frames = 0;
  let states = 0;
  page.on("websocket", (socket) => {
    socket.on("framesent", ({ payload }) => (frames += String(payload).includes('"acknowledge"') ? 1 : 0));
    socket.on("framereceived", ({ payload }) => (states += /"type": ?"state"/.test(String(payload)) ? 1 : 0));
  });
  await page.goto(url);
  await expect(status(page)).toContainText("4 robots");
  await page.getByRole("application").focus();
  await page.keyboard.press("Space");
  await expect.poll(() => frames).toBeGreaterThan(3);
  const begun = { frames, states, pictures: Number(await page.evaluate("pictures")) };
  return async () => [
    Number(await page.evaluate("pictures")) - begun.pictures,
    frames - begun.frames,
    states - begun.states,
  ];
}

test("motion between two steps is interpolated", async ({ page, server }) => {
  // The page's clock advances by 200 ms at a time, however long a slow machine takes for the pictures. A frame that
  // arrives while the clock stands is drawn at its next advance.
  await page.clock.install();
  const drawn = await play(page, runAt(server, "scenario=search-beliefs&seed=7"));
  await page.clock.pauseAt(await page.evaluate(() => Date.now() + 1000));
  for (let frames = 0; frames <= 5;) {
    await page.clock.runFor(200);
    [, frames] = await drawn();
  }
  const [pictures, frames] = await drawn();
  expect(pictures).toBeGreaterThan(1.5 * frames);
});

test("with reduced motion each step is drawn as received", async ({ page, server }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const drawn = await play(page, runAt(server, "scenario=search-beliefs&seed=7"));
  await expect.poll(async () => (await drawn())[1]).toBeGreaterThan(10);
  const [pictures, frames, states] = await drawn();
  // Each frame and each state message causes one redraw.
  expect(pictures).toBeLessThanOrEqual(frames + states + 3);
});
