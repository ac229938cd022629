/** The page for development, with the fake server; with SERVER=no, for a real server that is running. */
import { createServer } from "vite";
import { serve } from "./fake-server.mjs";

if (process.env.SERVER !== "no") await serve(8123);
const page = await createServer();
await page.listen();
page.printUrls();
