/** What crosses the wire until the gallery shows, and time until the page is usable. */

const times = 9;

/** Counts the bytes of all responses of a page, with their headers, as they were transferred. */
async function counted(page) {
  const network = await page.context().newCDPSession(page);
  await network.send("Network.enable");
  const wire = { bytes: 0 };
  network.on("Network.loadingFinished", ({ encodedDataLength }) => (wire.bytes += encodedDataLength));
  return wire;
}

async function load(browser, server) {
  const context = await browser.newContext();
  const page = await context.newPage();
  const wire = await counted(page);
  const began = performance.now();
  await page.goto(server.url);
  await page.getByRole("link", { name: /^search-beliefs/ }).waitFor();
  const ready_ms = performance.now() - began;
  await page.waitForFunction(() => [...document.images].some(({ naturalWidth }) => naturalWidth > 0));
  const first = wire.bytes;
  await page.waitForLoadState("networkidle");
  await context.close();
  return { ready_ms, first, all: wire.bytes };
}

export async function measureLoad(browser, server) {
  const loads = [];
  for (let i = 0; i < times; i += 1) loads.push(await load(browser, server));
  const median = (key) => loads.map((each) => each[key]).sort((a, b) => a - b)[Math.floor(times / 2)];
  const kB = (key) => `${(median(key) / 1000).toFixed(1)} kB`;
  return `first load: ${kB("first")} on the wire until the first picture of the gallery, ${kB("all")} with all of its pictures; scenarios can be opened after ${median("ready_ms").toFixed(0)} ms (medians of ${times})`;
}
