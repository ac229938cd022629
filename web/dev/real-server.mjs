/** The real server, for the page's checks in a browser, its benchmark and its pictures. */
import { spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

const program = process.env.AGENT_ECONOMY ?? "agent-economy";
const start_ms = 30_000;

/** What `agent-economy ui` starts, in an empty folder of its own. */
export class RealServer {
  url = "";
  folder = "";
  process = null;

  /** Starts it; once more at the same port, if it has been there before. */
  async start() {
    this.folder ||= await mkdtemp(join(tmpdir(), "agent-economy-"));
    const port = this.url ? new URL(this.url).port : "0";
    this.process = spawn(program, ["ui", "--no-browser", "--port", port], {
      cwd: this.folder,
      stdio: ["ignore", "pipe", "inherit"],
    });
    this.url = await addressFrom(this.process);
  }

  /** Ends it as a power cut would. */
  async kill() {
    const { process: running } = this;
    if (running?.exitCode !== null || running.signalCode !== null) return;
    const gone = new Promise((done) => running.once("exit", done));
    running.kill("SIGKILL");
    await gone;
  }

  /** Ends it, and takes its folder away. */
  async end() {
    await this.kill();
    await rm(this.folder, { recursive: true });
  }
}

/** The address that the program prints first. */
async function addressFrom(running) {
  const failed = new Promise((_, fail) => {
    running.once("error", fail);
    running.once("exit", (code) => fail(new Error(`${program} ui ended with ${code}`)));
    setTimeout(() => fail(new Error(`${program} ui says nothing`)), start_ms).unref();
  });
  failed.catch(() => {});
  const first = createInterface(running.stdout)[Symbol.asyncIterator]().next();
  const { value } = await Promise.race([first, failed]);
  return /http:\S+/.exec(value ?? "")?.[0].replace(/\/$/, "") ?? "";
}
