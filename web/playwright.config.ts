import { defineConfig } from "@playwright/test";
import { launchOptions } from "./dev/chromium.mjs";

export default defineConfig({
  testDir: "tests",
  workers: 2,
  fullyParallel: true,
  timeout: 30_000,
  // On a busy machine; what passes only then is listed as flaky.
  retries: process.env.CI ? 1 : 0,
  reporter: [["list"]],
  use: { viewport: { width: 1280, height: 800 }, launchOptions },
});
