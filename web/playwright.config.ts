import { defineConfig } from "@playwright/test";
import { launchOptions } from "./dev/chromium.mjs";

export default defineConfig({
  testDir: "tests",
  workers: 3,
  fullyParallel: true,
  // Generous, for busy machines: a passing test does not wait for them.
  timeout: 90_000,
  expect: { timeout: 20_000 },
  // A test that passes only at the second attempt is listed as flaky.
  retries: process.env.CI ? 1 : 0,
  reporter: [["list"]],
  use: { viewport: { width: 1280, height: 800 }, launchOptions },
});
