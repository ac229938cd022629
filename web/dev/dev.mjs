/** The page for development, with a server of its own in an empty folder, or with the one at SERVER. */
import { createServer } from "vite";
import { RealServer } from "./real-server.mjs";

const own = process.env.SERVER ? null : new RealServer();
await own?.start();
const target = own?.url ?? process.env.SERVER;
const page = await createServer({
  server: { proxy: { "/api": { target }, "/drive": { target }, "/ws": { target, ws: true } } },
});
await page.listen();
page.printUrls();
for (const signal of ["SIGINT", "SIGTERM"])
  process.once(signal, async () => {
    await page.close();
    await own?.end();
    process.exit();
  });
