import { svelte } from "@sveltejs/vite-plugin-svelte";
import { writeFile } from "node:fs/promises";
import { join } from "node:path";
import { brotliCompressSync, gzipSync } from "node:zlib";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/** Writes the compressed forms of scripts and styles beside them, which the server sends. */
const compress: Plugin = {
  name: "compress",
  async writeBundle({ dir = "dist" }, bundle) {
    for (const [name, part] of Object.entries(bundle)) {
      if (!/\.(css|js)$/.test(name)) continue;
      const content = Buffer.from(part.type === "chunk" ? part.code : part.source);
      await writeFile(join(dir, `${name}.br`), brotliCompressSync(content));
      await writeFile(join(dir, `${name}.gz`), gzipSync(content, { level: 9 }));
    }
  },
};

export default defineConfig({
  base: "./",
  plugins: [svelte(), compress],
  // Data in addresses would need `font-src data:` and the like in the policy that the server sends.
  // The large chunk is Vega, which draws the charts of studies and is loaded with the first.
  build: { assetsInlineLimit: 0, modulePreload: { polyfill: false }, chunkSizeWarningLimit: 900 },
  test: { include: ["src/**/*.test.ts", "dev/**/*.test.mjs"], environment: "node" },
});
