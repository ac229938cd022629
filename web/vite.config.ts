import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";

export default defineConfig({
  base: "./",
  plugins: [svelte()],
  // Data in addresses would need `font-src data:` and the like in the policy that the server sends.
  // The large chunk is Vega, which draws the charts of studies and is loaded with the first.
  build: { assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  test: { include: ["src/**/*.test.ts", "dev/**/*.test.mjs"], environment: "node" },
});
