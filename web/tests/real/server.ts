import { type ChildProcess, spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { expect, test as page } from "../page";

const program = process.env.AGENT_ECONOMY ?? "agent-economy";
const start_ms = 30_000;

/** What `agent-economy ui` starts, in an empty folder of its own. */
export class Server {
  url = "";
  private process: ChildProcess | undefined;

  constructor(readonly folder: string) {}

  /** Starts it; once more at the same port, if it has been there before. */
  async start(): Promise<void> {
    const port = this.url ? new URL(this.url).port : "0";
    this.process = spawn(program, ["ui", "--no-browser", "--port", port], {
      cwd: this.folder,
      stdio: ["ignore", "pipe", "inherit"],
    });
    this.url = await this.told();
  }

  /** Ends it as a power cut would. */
  async kill(): Promise<void> {
    const { process: running } = this;
    if (!running || running.exitCode !== null || running.signalCode !== null) return;
    const gone = new Promise((done) => running.once("exit", done));
    running.kill("SIGKILL");
    await gone;
  }

  private async told(): Promise<string> {
    const { process: running } = this;
    if (!running?.stdout) throw new Error(`${program} was not started`);
    const failed = new Promise<never>((_, fail) => {
      running.once("error", fail);
      running.once("exit", (code) => fail(new Error(`${program} ui ended with ${code}`)));
      setTimeout(() => fail(new Error(`${program} ui says nothing`)), start_ms).unref();
    });
    failed.catch(() => {});
    const first = createInterface(running.stdout)[Symbol.asyncIterator]().next();
    const { value } = await Promise.race([first, failed]);
    return /http:\S+/.exec(value ?? "")?.[0].replace(/\/$/, "") ?? "";
  }
}

/** A page beside a server of this test's own. */
export const test = page.extend<{ server: Server }>({
  server: async ({}, use) => {
    const folder = await mkdtemp(join(tmpdir(), "agent-economy-"));
    const server = new Server(folder);
    await server.start();
    await use(server);
    await server.kill();
    await rm(folder, { recursive: true });
  },
});

export { expect };
