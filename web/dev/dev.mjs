/** The page for development, with a server of its own in an empty folder, or with the one at SERVER. */
import { createServer } from "vite";
import { RealServer } from "./real-server.mjs";

const own = process.env.SERVER ? null : new RealServer();
await own?.start();
const { origin: target, searchParams } = new URL(own?.url ?? process.env.SERVER);
const token = searchParams.get("token");

/** The server of a drive needs the token of its printed address, and the cookie is of another port. */
function rewrite(path) {
  if (!token) return path;
  return `${path}${path.includes("?") ? "&" : "?"}token=${encodeURIComponent(token)}`;
}

const page = await createServer({
  server: {
    proxy: {
      "/api": { target, rewrite },
      "/drive": { target, rewrite },
      "/ws": { target, ws: true, rewrite },
    },
  },
});
await page.listen();
page.printUrls();
for (const signal of ["SIGINT", "SIGTERM"])
  process.once(signal, async () => {
    await page.close();
    await own?.end();
    process.exit();
  });
