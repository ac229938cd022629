/** From the key that changes a parameter to the picture that shows the change. */

const times = 30;
const rest_ms = 500;

/** Notes, in the page, when a key was pressed and when the first picture of another setting was drawn. */
function watch() {
  const seen = { at: 0, isAwaited: false, isNew: false, took_ms: [] };
  Object.assign(window, { seen });
  addEventListener(
    "keydown",
    () => Object.assign(seen, { at: performance.now(), isAwaited: true, isNew: false }),
    true,
  );
  const { send } = WebSocket.prototype;
  WebSocket.prototype.send = function (data) {
    if (seen.isAwaited && seen.isNew && String(data).includes('"got"')) {
      seen.took_ms.push(performance.now() - seen.at);
      seen.isAwaited = false;
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
  return `a parameter changed in mid-run is in the picture after ${part(0.5)} ms (median of ${times}), ${part(0.9)} ms (nine of ten), ${part(1)} ms (worst)`;
}
