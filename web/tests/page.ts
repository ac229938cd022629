import type { ServerMessage } from "../src/api/protocol";
import AxeBuilder from "@axe-core/playwright";
import { test as base, type Download, expect, type Page, type WebSocketRoute } from "@playwright/test";
import { RealServer } from "../dev/real-server.mjs";

async function withServer(use: (server: RealServer) => Promise<void>): Promise<void> {
  const server = new RealServer();
  await server.start();
  await use(server);
  await server.end();
}

interface TestFixtures {
  ownServer: RealServer;
  consoleErrors: string[];
}

/**
 * A page with a server: `server` is shared by the tests of a worker, `ownServer` belongs to one test. Errors in
 * the browser console fail the test.
 */
export const test = base.extend<TestFixtures, { server: RealServer }>({
  server: [({}, use) => withServer(use), { scope: "worker" }],
  ownServer: ({}, use) => withServer(use),
  consoleErrors: [
    async ({ page }, use) => {
      const consoleErrors: string[] = [];
      page.on("pageerror", (error) => consoleErrors.push(error.message));
      page.on("console", (message) => {
        if (
          message.type() === "error" &&
          !/409|422|ERR_(CONNECTION|EMPTY_RESPONSE|INTERNET)/.test(message.text())
        )
          consoleErrors.push(message.text());
      });
      await use(consoleErrors);
      expect(consoleErrors).toEqual([]);
    },
    { auto: true },
  ],
});

export { expect, type RealServer };

export function runAt({ url }: { url: string }, query: string): string {
  return `${url}/#/run?${query}`;
}

export const status = (page: Page) => page.locator("#status");
export const hash = (page: Page) => page.getByTitle("Hash of the run's state").getAttribute("title");
export const time_s = async (page: Page) => Number.parseFloat((await status(page).textContent()) ?? "");

/** Opens a run and waits until its status contains `text`. */
export async function openRun(
  page: Page,
  server: { url: string },
  query: string,
  text: string | RegExp = "robots",
): Promise<void> {
  await page.goto(runAt(server, query));
  await expect(status(page)).toContainText(text);
}

export const openTab = (page: Page, name: string) => page.getByRole("tab", { name }).click();

/** Opens each panel of a run in turn, and expects no violation of axe's rules in it, nor in the page around it. */
export async function expectAccessiblePanels(page: Page, names: string[]): Promise<void> {
  for (const [i, name] of names.entries()) {
    await openTab(page, name);
    await expectAccessible(page, i === 0 ? "html" : "aside");
  }
}

/** Opens a file of the user's own in the gallery. */
export async function openFile(
  page: Page,
  { url }: { url: string },
  content: string | Buffer,
): Promise<void> {
  await page.goto(url);
  const file = { name: "my.toml", mimeType: "application/toml", buffer: Buffer.from(content) };
  await page.locator("input[type=file]").setInputFiles(file);
}

/** What a click downloads. */
export async function downloaded(page: Page, click: () => Promise<void>): Promise<Download> {
  const [download] = await Promise.all([page.waitForEvent("download"), click()]);
  return download;
}

/** Makes the page as narrow as on a phone. */
export const asOnPhone = (page: Page) => page.setViewportSize({ width: 360, height: 740 });

/** Expects the page not to be wider than a phone. */
export async function expectToFit(page: Page): Promise<void> {
  const widths = () => [document.documentElement.scrollWidth, document.body.scrollWidth];
  expect(await page.evaluate(widths)).toEqual([360, 360]);
}

/** Routes the page's connections to the server through the test, which drops them and later restores them. */
export async function droppable(page: Page): Promise<{ drop(): Promise<void>; restore(): void }> {
  const open: WebSocketRoute[] = [];
  let isDown = false;
  await page.routeWebSocket(/\/ws/, async (line) => {
    if (isDown) await line.close();
    else open.push(line, line.connectToServer());
  });
  return {
    async drop() {
      isDown = true;
      await Promise.all(open.splice(0).map((line) => line.close()));
    },
    restore() {
      isDown = false;
    },
  };
}

/**
 * Expects the page to report a lost connection at once when `lose` ends it: before it does anything else about
 * it, such as connecting again. The page records the order itself, so that it does not depend on how soon the
 * test sees it. To be called before the page is opened.
 */
export async function expectReportAtOnce(page: Page): Promise<(lose: () => Promise<void>) => Promise<void>> {
  await page.addInitScript(recordConnection, report);
  const events = () => page.evaluate<string[]>("connectionEvents");
  return async (lose) => {
    const { length } = await events();
    await lose();
    await expect(page.getByText(report).first()).toBeVisible();
    await expect.poll(async () => (await events()).slice(length)).toContain("connecting");
    expect((await events()).slice(length, length + 3)).toEqual(["closed", "reported", "connecting"]);
  };
}

const report = "The connection is lost.";

/** Records, in the page, when connections open and close, and when it reports that one is lost. */
function recordConnection(report: string): void {
  const events: string[] = [];
  Object.assign(globalThis, { connectionEvents: events });
  globalThis.WebSocket = class extends WebSocket {
    constructor(url: string | URL) {
      super(url);
      events.push("connecting");
      this.addEventListener("close", () => events.push("closed"));
    }
  };
  let isReported = false;
  const look = () => {
    const was = isReported;
    isReported = document.body?.textContent.includes(report) ?? false;
    if (isReported && !was) events.push("reported");
  };
  new MutationObserver(look).observe(document, { childList: true, characterData: true, subtree: true });
}

/**
 * Routes the page's connections through the test, which alters or delays the server's messages; all later ones
 * wait for a delayed one.
 */
export async function altered(
  page: Page,
  alter: (message: ServerMessage) => ServerMessage | Promise<ServerMessage>,
): Promise<void> {
  await page.routeWebSocket(/\/ws/, (line) => {
    const server = line.connectToServer();
    let sent = Promise.resolve();
    server.onMessage((data) => {
      sent = sent.then(async () => {
        line.send(typeof data === "string" ? JSON.stringify(await alter(JSON.parse(data))) : data);
      });
    });
    server.onClose((code, reason) => {
      sent = sent.then(() => line.close({ code, reason }));
    });
  });
}

/** A scenario of the user's own, with four robots. */
export const ownScenario = `engine = "metric"
summary = "Four rovers."
merit = "equation-5.2"
clock = { time_limit_s = 60 }
world = { size_m = [20, 20] }
items.mine.count = 2
[robots.rover]
model = "ugv"
count = 4
`;

/**
 * Expects no violation of axe's rules in the light theme, nor of those about colours in the dark theme; in the
 * whole page, or in a part of it.
 */
export async function expectAccessible(page: Page, part = "html"): Promise<void> {
  const axe = () => new AxeBuilder({ page }).include(part);
  await page.emulateMedia({ colorScheme: "light" });
  await expectNoViolations(axe());
  await page.emulateMedia({ colorScheme: "dark" });
  await expectNoViolations(axe().withRules(["color-contrast", "link-in-text-block"]));
}

async function expectNoViolations(axe: AxeBuilder): Promise<void> {
  const { violations } = await axe.analyze();
  expect(violations.map(({ id, nodes }) => `${id}: ${nodes[0]?.html}`)).toEqual([]);
}
