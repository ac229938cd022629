import { RealServer } from "../../dev/real-server.mjs";
import { expect, test as page } from "../page";

/** A page with a real server. */
export const test = page.extend<{ server: RealServer }>({
  server: async ({}, use) => {
    const server = new RealServer();
    await server.start();
    await use(server);
    await server.end();
  },
});

export { expect, type RealServer };
