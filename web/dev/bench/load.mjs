/** Size of the first load, and time until the page is usable. */
import { gzipSync } from "node:zlib";

const times = 9;

export async function measureLoad(browser, server) {
  const loads = [];
  let bytes = 0;
  for (let i = 0; i < times; i += 1) {
    const context = await browser.newContext();
    const page = await context.newPage();
    const answers = [];
    page.on("response", (answer) => answers.push(answer));
    const began = performance.now();
    await page.goto(server.url);
    await page.getByRole("link", { name: /^search-beliefs/ }).waitFor();
    loads.push(performance.now() - began);
    const ours = answers.filter((answer) => /(\/|js|css|svg)$/.test(new URL(answer.url()).pathname));
    const bodies = await Promise.all(ours.map((answer) => answer.body()));
    bytes = bodies.reduce((sum, body) => sum + gzipSync(body).length, 0);
    await context.close();
  }
  const ready_ms = loads.sort((a, b) => a - b)[Math.floor(times / 2)];
  return `first load: ${(bytes / 1000).toFixed(1)} kB compressed (gzip); scenarios can be opened after ${ready_ms.toFixed(0)} ms (median of ${times})`;
}
