/** The page as one works on it, beside the fake server. With SERVER=no only the page: the real one runs. */
import { createServer } from "vite";
import { serve } from "./fake-server.mjs";

if (process.env.SERVER !== "no") await serve(8123);
const page = await createServer();
await page.listen();
page.printUrls();
