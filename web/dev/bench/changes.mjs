/** Time from the key press that changes a parameter to the picture with the change. */

const times = 30;
const rest_ms = 500;

/** Records, in the page, the time from each key press to the first picture of the new setting. */
function watch() {
  const seen = { at: 0, isPending: false, isNew: false, took_ms: [] };
  Object.assign(window, { seen });
  addEventListener(
    "keydown",
    () => Object.assign(seen, { at: performance.now(), isPending: true, isNew: false }),
    true,
  );
  const { send } = WebSocket.prototype;
  WebSocket.prototype.send = function (data) {
    if (seen.isPending && seen.isNew && String(data).includes('"acknowledge"')) {
      seen.took_ms.push(performance.now() - seen.at);
      seen.isPending = false;
    }
    return send.call(this, data);
  };
  window.WebSocket = class extends WebSocket {
    constructor(...given) {
      super(...given);
      this.addEventListener("message", ({ data }) => {
        seen.isNew ||= typeof data === "string" && data.includes('"setting"');
      });
    }
  };
}

export async function measureChanges(browser, server) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
  await page.addInitScript(watch);
  await page.goto(`${server.url}/#/run?scenario=search-beliefs&seed=7&run=0`);
  await page.keyboard.press("Space");
  await page.getByRole("tab", { name: "Parameters" }).click();
  await page.getByRole("slider", { name: /^Count of/ }).focus();
  for (let i = 0; i < times; i += 1) {
    await page.keyboard.press(i % 2 ? "ArrowLeft" : "ArrowRight");
    await page.waitForTimeout(rest_ms);
  }
  const took_ms = (await page.evaluate(() => window.seen.took_ms)).sort((a, b) => a - b);
  await page.close();
  const part = (share) => took_ms[Math.floor(share * (times - 1))].toFixed(0);
  return `a parameter change during a run is drawn after ${part(0.5)} ms (median of ${times}), ${part(0.9)} ms (nine of ten), ${part(1)} ms (worst)`;
}
