import { defineConfig } from "@playwright/test";
import { launchOptions } from "./dev/chromium.mjs";

export default defineConfig({
  testDir: "tests",
  workers: 2,
  fullyParallel: true,
  timeout: 30_000,
  reporter: [["list"]],
  use: { viewport: { width: 1280, height: 800 }, launchOptions },
});
