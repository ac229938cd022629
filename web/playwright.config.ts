import { defineConfig } from "@playwright/test";
import { launchOptions } from "./dev/chromium.mjs";
import { hang_ms } from "./dev/real-server.mjs";

export default defineConfig({
  testDir: "tests",
  // A drive needs a machine that is not busy: `make drive-browser` tests it alone.
  testIgnore: process.env.DRIVE ? [] : ["drive.spec.ts"],
  workers: 3,
  fullyParallel: true,
  // Tests wait for states, not for times: these limits only end a test that hangs.
  timeout: 5 * hang_ms,
  expect: { timeout: hang_ms },
  // A test that passes only at the second attempt is listed as flaky.
  retries: process.env.CI ? 1 : 0,
  reporter: [["list"]],
  use: { viewport: { width: 1280, height: 800 }, launchOptions },
});
