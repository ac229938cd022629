import AxeBuilder from "@axe-core/playwright";
import { test as base, expect, type Page } from "@playwright/test";
import { serve } from "../dev/fake-server.mjs";

interface Fake {
  url: string;
  drop(): void;
}

/** A page with a fake server of its own. Errors in the browser console fail the test. */
export const test = base.extend<{ fake: Fake; consoleErrors: string[] }>({
  fake: async ({}, use) => {
    const server = await serve(0);
    await use(server);
    server.stop();
  },
  consoleErrors: [
    async ({ page }, use) => {
      const consoleErrors: string[] = [];
      page.on("pageerror", (error) => consoleErrors.push(error.message));
      page.on("console", (message) => {
        if (
          message.type() === "error" &&
          !/422|ERR_(CONNECTION|EMPTY_RESPONSE|INTERNET)/.test(message.text())
        )
          consoleErrors.push(message.text());
      });
      await use(consoleErrors);
      expect(consoleErrors).toEqual([]);
    },
    { auto: true },
  ],
});

export { expect };

export function runAt(fake: Fake, query: string): string {
  return `${fake.url}/#/run?${query}`;
}

/** Expects no violation of axe's rules in the light theme, nor of those about colours in the dark theme. */
export async function expectAccessible(page: Page): Promise<void> {
  await page.emulateMedia({ colorScheme: "light" });
  await expectNoViolations(new AxeBuilder({ page }));
  await page.emulateMedia({ colorScheme: "dark" });
  await expectNoViolations(new AxeBuilder({ page }).withRules(["color-contrast", "link-in-text-block"]));
}

async function expectNoViolations(axe: AxeBuilder): Promise<void> {
  const { violations } = await axe.analyze();
  expect(violations.map(({ id, nodes }) => `${id}: ${nodes[0]?.html}`)).toEqual([]);
}
