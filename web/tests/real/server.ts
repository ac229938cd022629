import { RealServer } from "../../dev/real-server.mjs";
import { expect, test as page } from "../page";

async function withServer(use: (server: RealServer) => Promise<void>): Promise<void> {
  const server = new RealServer();
  await server.start();
  await use(server);
  await server.end();
}

/** A page with a real server: `server` is shared by the tests of a worker, `ownServer` belongs to one test. */
export const test = page.extend<{ ownServer: RealServer }, { server: RealServer }>({
  server: [({}, use) => withServer(use), { scope: "worker" }],
  ownServer: ({}, use) => withServer(use),
});

export { expect, type RealServer };
