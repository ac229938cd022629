import { type ChildProcess, spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { connect } from "node:net";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { hang_ms, program } from "../dev/real-server.mjs";

/** A line that the emulated robot received on its motor port. */
export interface MotorLine {
  t_s: number;
  line: string;
}

type Port = "motors" | "compass" | "gps" | "sonar";
const ports: Port[] = ["motors", "compass", "gps", "sonar"];
const stopLine = "x,3,";
const ownFile = "own.toml";
const end_ms = 5000;
const settings = { range_unit_m: 1, no_echo: 99 };

/** The emulator of Bender and a drive of it, as processes with a folder of their own. */
export class RealDrive {
  folder = "";
  /** The address of the page. */
  url = "";
  private numbers = {} as Record<Port, number>;
  private control = 0;
  private log = "";
  private emulator: ChildProcess | null = null;
  private warden: ChildProcess | null = null;

  /** Of a scenario with the robot bender/0: the name of a bundled one, or its text. */
  constructor(private readonly scenario = "bender") {}

  /** Starts both, and waits for the page. Arguments are further ones of `drive`. */
  async start(...more: string[]): Promise<void> {
    this.folder = await mkdtemp(join(tmpdir(), "agent-economy-drive-"));
    if (this.hasOwn) await writeFile(join(this.folder, ownFile), this.scenario);
    await this.startEmulator();
    await writeFile(join(this.folder, "bender.toml"), this.fleet());
    this.warden = this.spawn(["drive", "bender.toml", "--json", "--record", "drive.mcap", ...more]);
    const page = /http:[^"]+#\/robots/;
    const awaited = more.includes("--headless") ? /"type": "plan"/ : page;
    this.url = page.exec(await lineWith(this.warden, awaited))?.[0] ?? "";
  }

  /** Starts the emulator, at the same ports as before if it ran already, with a new log. */
  async startEmulator(): Promise<void> {
    this.log = join(this.folder, `emulator-${this.control}.log`);
    const numbers = ports.map((port) => this.numbers[port] ?? 0).join(",");
    const set = Object.entries(settings).flatMap(([name, value]) => ["--set", `${name}=${value}`]);
    const world = ["--scenario", this.scenarioName];
    this.emulator = this.spawn(["bender-emulator", ...world, "--ports", numbers, "--log", this.log, ...set]);
    const ready = JSON.parse(await lineWith(this.emulator, /"control"/));
    this.numbers = ready.robots[0];
    this.control = ready.control;
  }

  async killEmulator(): Promise<void> {
    await ended(this.emulator, "SIGKILL");
  }

  /** Sends a signal to the loop or to the server of the page, the two children of the warden. */
  async signal(child: "live.loop" | "server.live", signal: NodeJS.Signals): Promise<void> {
    const pid = this.warden?.pid;
    const children = await readFile(`/proc/${pid}/task/${pid}/children`, "utf8");
    for (const each of children.trim().split(" ")) {
      const command = await readFile(`/proc/${each}/cmdline`, "utf8").catch(() => "");
      if (command.includes(`agent_economy.${child}`)) return void process.kill(Number(each), signal);
    }
    throw new Error(`${child} does not run`);
  }

  /** The result of `work`, or an error if the drive ends before it. */
  whileItRuns<Result>(work: Promise<Result>): Promise<Result> {
    const end = once(this.warden as ChildProcess, "exit").then(([code]) => {
      throw new Error(`the drive ended with ${code}`);
    });
    return Promise.race([work, end]);
  }

  /** The recording. */
  get recording(): string {
    return join(this.folder, "drive.mcap");
  }

  /** Ends the drive as Ctrl-C does, and waits for its recording. */
  async interrupt(): Promise<void> {
    await ended(this.warden, "SIGINT");
  }

  async end(): Promise<void> {
    await this.signal("live.loop", "SIGCONT").catch(() => undefined);
    await ended(this.warden, "SIGINT");
    await ended(this.emulator, "SIGINT");
    await rm(this.folder, { recursive: true });
  }

  /** The time of the emulator and its log, and the robot's place. */
  async look(): Promise<{ t_s: number; x_m: number }> {
    const { state } = await this.ask({ get: "state" });
    return { t_s: state.t_s, x_m: state.robots[0].pose.x_m };
  }

  /** Switches a fault of the emulated robot on. */
  async fault(port: Port, fault: string, value: number): Promise<void> {
    await this.ask({ robot: 0, port, fault, value });
  }

  /** Sends a request to the emulator; returns its reply. */
  private async ask(request: object) {
    const link = connect(this.control, "127.0.0.1");
    try {
      link.write(`${JSON.stringify(request)}\n`);
      const { value } = await createInterface(link)[Symbol.asyncIterator]().next();
      return JSON.parse(value as string);
    } finally {
      link.destroy();
    }
  }

  async motorLines(after_s = 0): Promise<MotorLine[]> {
    const rows = (await readFile(this.log, "utf8")).split("\n").slice(0, -1);
    return rows
      .map((row) => JSON.parse(row))
      .filter(({ port, event, t_s }) => port === "motors" && event === "received" && t_s >= after_s);
  }

  /** The first stop line after a time; null if there is none yet. */
  async stopAfter(after_s: number): Promise<number | null> {
    const found = (await this.motorLines(after_s)).find(({ line }) => line === stopLine);
    return found?.t_s ?? null;
  }

  /** The other lines after a time. */
  async movesAfter(after_s: number): Promise<string[]> {
    return (await this.motorLines(after_s)).map(({ line }) => line).filter((line) => line !== stopLine);
  }

  private spawn(args: string[]): ChildProcess {
    const env = { ...process.env, XDG_RUNTIME_DIR: this.folder };
    return spawn(program, args, { cwd: this.folder, env, stdio: ["ignore", "pipe", "inherit"] });
  }

  private get hasOwn(): boolean {
    return this.scenario.includes("\n");
  }

  private get scenarioName(): string {
    return this.hasOwn ? ownFile : this.scenario;
  }

  private fleet(): string {
    const numbers = ports.map((port) => `${port} = ${this.numbers[port]}`).join(", ");
    const set = Object.entries(settings).map(([name, value]) => `${name} = ${value.toFixed(1)}`);
    return `scenario = "${this.scenarioName}"
[robots."bender/0"]
driver = "bender"
host = "127.0.0.1"
ports = { ${numbers} }
fence_m = [[1, 1], [39, 1], [39, 29], [1, 29]]
[robots."bender/0".settings]
${set.join("\n")}
`;
  }
}

/** The first line of a program's output with a pattern; later output is read and dropped. */
async function lineWith(running: ChildProcess, wanted: RegExp): Promise<string> {
  if (!running.stdout) throw new Error("no output");
  const lines = createInterface(running.stdout);
  return new Promise((done, fail) => {
    const limit = setTimeout(() => fail(new Error(`no ${wanted}`)), hang_ms);
    lines.on("line", (line) => wanted.test(line) && (clearTimeout(limit), done(line)));
    lines.on("close", () => fail(new Error(`ended before ${wanted}`)));
  });
}

/** Sends a signal, and waits for the end; a second signal repeats it, and SIGKILL forces it. */
async function ended(running: ChildProcess | null, signal: NodeJS.Signals): Promise<void> {
  for (const each of [signal, signal, "SIGKILL"] as const) {
    if (!running || running.exitCode !== null || running.signalCode !== null) return;
    const gone = once(running, "exit");
    running.kill(each);
    await Promise.race([gone, new Promise((done) => setTimeout(done, end_ms))]);
  }
}
