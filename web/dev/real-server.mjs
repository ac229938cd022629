/** The real server, for browser tests, benchmark and pictures. */
import { spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";

export const program = process.env.AGENT_ECONOMY ?? "agent-economy";
/**
 * The longest wait for anything that a test, the benchmark or a picture waits for: it is only reached when
 * something hangs, also on a machine that is many times slower than ours.
 */
export const hang_ms = 120_000;

/** The process `agent-economy ui`, in an empty folder of its own. */
export class RealServer {
  url = "";
  folder = "";
  process = null;

  /** Starts the server, at the same port as before if it ran already. */
  async start() {
    this.folder ||= await mkdtemp(join(tmpdir(), "agent-economy-"));
    const port = this.url ? new URL(this.url).port : "0";
    this.process = spawn(program, ["ui", "--no-browser", "--port", port], {
      cwd: this.folder,
      stdio: ["ignore", "pipe", "inherit"],
    });
    this.url = await addressFrom(this.process);
  }

  /** Kills the server without a clean shutdown. */
  async kill() {
    const { process: running } = this;
    if (running?.exitCode !== null || running.signalCode !== null) return;
    const gone = new Promise((done) => running.once("exit", done));
    running.kill("SIGKILL");
    await gone;
  }

  /** Ends the server and removes its folder. */
  async end() {
    await this.kill();
    // A study that it has started ends a moment later, and may write until then.
    await rm(this.folder, { recursive: true, maxRetries: 20, retryDelay: 100 });
  }
}

/** The address that the program prints in its first line. */
async function addressFrom(running) {
  const failed = new Promise((_, fail) => {
    running.once("error", fail);
    running.once("exit", (code) => fail(new Error(`${program} ui ended with ${code}`)));
    setTimeout(() => fail(new Error(`${program} ui printed no address`)), hang_ms).unref();
  });
  failed.catch(() => {});
  const first = createInterface(running.stdout)[Symbol.asyncIterator]().next();
  const { value } = await Promise.race([first, failed]);
  return /http:\S+/.exec(value ?? "")?.[0].replace(/\/$/, "") ?? "";
}
