import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vitest/config";

const server = "http://127.0.0.1:8123";

export default defineConfig({
  base: "./",
  plugins: [svelte()],
  // Data in addresses would need `font-src data:` and the like in the policy that the server sends.
  // The large chunk is Vega, which draws the charts of studies and is loaded with the first.
  build: { assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  server: { proxy: { "/api": server, "/ws": { target: server, ws: true } } },
  test: { include: ["src/**/*.test.ts", "dev/**/*.test.mjs"], environment: "node" },
});
