import { createServer, type IncomingMessage, type Server, type ServerResponse } from "node:http";
import type { AddressInfo } from "node:net";
import type { Page } from "@playwright/test";
import type { Drive, WardenRobot, WardenState } from "../src/api/warden";

/** A request as the fake warden received it, without its token. */
export interface Received {
  path: string;
  body: Record<string, unknown>;
}

export const token = "secret";

/** The HTTP endpoint of a warden that drives nothing: it records requests, and fails on command. */
export class FakeWarden {
  readonly received: Received[] = [];
  /** The requests that it has refused, with the reasons. */
  readonly refusals: string[] = [];
  readonly state: WardenState = stateOf();
  /** `frozen`: it accepts connections and never answers; `refusing`: it accepts no token. */
  mode: "running" | "frozen" | "refusing" | "stuck" = "running";
  private operator: unknown = null;
  private readonly started_ms = performance.now();
  private server: Server | null = null;
  port = 0;

  async start(): Promise<void> {
    this.server = createServer((request, response) => void this.serve(request, response));
    await new Promise<void>((done) => this.server?.listen(this.port, "127.0.0.1", done));
    this.port = (this.server.address() as AddressInfo).port;
  }

  async kill(): Promise<void> {
    this.server?.closeAllConnections();
    await new Promise((done) => this.server?.close(done));
  }

  get robot(): WardenRobot {
    return this.state.robots[0] as WardenRobot;
  }

  /** What was received except states and neutral motor values: the path and the named parts of each body. */
  requests(...parts: string[]): unknown[][] {
    return this.received
      .filter(({ path, body }) => path !== "/state" && !isNeutral(body))
      .map(({ path, body }) => [path, ...parts.map((part) => body[part])]);
  }

  /** The motor values that were received. */
  tracks(): Received["body"][] {
    return this.received.filter(({ path }) => path === "/manual").map(({ body }) => body);
  }

  count(path: string): number {
    return this.received.filter((each) => each.path === path).length;
  }

  /** Answers GET `drive` of a page in place of its server. */
  async attach(page: Page): Promise<void> {
    const drive: Drive = { warden: { port: this.port, token }, fleet: "bender", origin, robots };
    await page.route("**/drive", (route) => route.fulfill({ json: drive }));
  }

  /** Lets the inputs confirm the standstill of the robot. */
  confirmStandstill(): void {
    Object.assign(this.robot, { is_standing: true, unseen: { speed_m_s: 0.2149, turn_rate_rad_s: 0.0251 } });
  }

  /** Lets a value be doubted, which keeps the robot from being armed in automatic mode. */
  doubt(port: string, reason: string): void {
    this.robot.doubted.push(port);
    const jump = { name: "jump", reason: `${port}: ${reason}` };
    Object.assign(this.robot, { faults: [jump], blockers: [jump] });
  }

  /** Makes another client the operator. */
  giveToOther(): void {
    this.operator = "other";
  }

  private async serve(request: IncomingMessage, response: ServerResponse): Promise<void> {
    const parts: Buffer[] = [];
    for await (const part of request) parts.push(part as Buffer);
    const { token: sent, ...body } = JSON.parse(Buffer.concat(parts).toString()) as Received["body"];
    const path = request.url ?? "";
    this.received.push({ path, body });
    if (this.mode === "frozen") return;
    const isSimple = request.method === "POST" && request.headers["content-type"] === "text/plain";
    const isAllowed = isSimple && sent === token && this.mode !== "refusing";
    const refusal = isAllowed ? this.act(path, body) : "the token is missing or wrong";
    if (isAllowed && refusal) this.refusals.push(`${path}: ${refusal}`);
    if (this.mode !== "stuck") this.state.time_s = (performance.now() - this.started_ms) / 1000;
    response.writeHead(isAllowed ? (refusal ? 409 : 200) : 403, {
      "Content-Type": "application/json",
      "Access-Control-Allow-Origin": request.headers.origin ?? "",
    });
    const isState = path === "/state" || path === "/manual";
    const message = { message: refusal || "done" };
    response.end(JSON.stringify(isState && !refusal ? this.seenBy(body.client, body.since) : message));
  }

  private seenBy(client: unknown, since: unknown): WardenState {
    const operator = this.operator === null ? null : this.operator === client ? "you" : "other";
    const events = this.state.events.filter(({ number }) => number > Number(since));
    return { ...this.state, operator, events };
  }

  /** Why a request is refused; empty if it is not. Requests without an effect are. */
  private act(path: string, { client, ...body }: Received["body"]): string {
    const { robot, state } = this;
    const needsOperator = !["/state", "/stop", "/hold", "/operator"].includes(path);
    if (needsOperator && this.operator !== client) return "this client is not the operator";
    switch (path) {
      case "/stop":
        state.is_stopped = true;
        Object.assign(robot, { is_armed: false, action: "latched_stop" });
        return "";
      case "/release":
        if (!state.is_stopped) return "no emergency stop is latched";
        state.is_stopped = false;
        return "";
      case "/hold":
        state.is_held = true;
        return "";
      case "/resume":
        if (!state.is_held) return "the robots are not held";
        state.is_held = false;
        return "";
      case "/arm":
        return this.arm();
      case "/confirm":
        return this.confirm(String(body.port));
      case "/mode":
        if (robot.mode === body.mode) return `in ${robot.mode} mode already`;
        Object.assign(robot, { mode: body.mode, is_armed: false, action: "latched_stop" });
        return "";
      case "/navigate":
        if (robot.navigates === body.is_on) return "the navigation has that state already";
        robot.navigates = body.is_on === true;
        return "";
      case "/manual":
        return robot.mode === "manual" ? "" : "not in manual mode";
      case "/operator":
        return this.operate(client, body);
      default:
        return "";
    }
  }

  private arm(): string {
    const { robot, state } = this;
    if (state.is_held) return "held: on hold";
    if (robot.is_armed) return "armed already";
    if (robot.blockers.length > 0) return robot.blockers.map(({ reason }) => reason).join("; ");
    Object.assign(robot, { is_armed: true, action: "move" });
    return "";
  }

  private confirm(port: string): string {
    const { robot } = this;
    if (!robot.doubted.includes(port)) return `${port} is not doubted: there is nothing to confirm`;
    const doubted = robot.doubted.filter((each) => each !== port);
    Object.assign(robot, { doubted, faults: [], blockers: [] });
    return "";
  }

  private operate(client: unknown, body: Received["body"]): string {
    const [isOwn, isTaken] = [this.operator === client, this.operator !== null];
    if (body.take === true && isOwn) return "this client is the operator already";
    if (body.take !== true && !isOwn) return "this client is not the operator";
    if (body.take === true && isTaken && body.take_over !== true) return "another client is the operator";
    this.operator = body.take === true ? client : null;
    return "";
  }
}

export function isNeutral({ left, right }: Received["body"]): boolean {
  return left === 150 && right === 150;
}

const origin = {
  latitude_deg: 36.595267,
  longitude_deg: -121.875003,
  rotation_deg: 0,
  declination_deg: 14.5,
};
const facings_deg = [20, -20, 160, -160, -90, 90];
const robots: Drive["robots"] = {
  "bender/0": {
    fence_m: [
      [1, 1],
      [39, 1],
      [39, 29],
      [1, 29],
    ],
    sonars: facings_deg.map((facing_deg) => ({ facing_deg, max_m: 6 })),
  },
};

function stateOf(): WardenState {
  return {
    time_s: 0,
    fleet: "bender",
    recording: "bender-20261125-101500.mcap",
    is_ending: false,
    is_held: false,
    is_stopped: false,
    operator: null,
    robots: [robotOf()],
    events: [
      { number: 1, time_s: 0.4, level: "info", robot: "bender/0", text: "all ports are connected" },
      { number: 2, time_s: 0.9, level: "warning", robot: "bender/0", text: "no motor timer is known" },
      { number: 3, time_s: 1.2, level: "error", robot: "bender/0", text: "stopped because of stale input" },
    ],
  };
}

function robotOf(): WardenRobot {
  return {
    name: "bender/0",
    driver: "bender",
    mode: "auto",
    is_armed: false,
    action: "latched_stop",
    requested: { speed_m_s: 0.4, turn_rate_rad_s: 0, heading_rad: null },
    written: { line: "x,3,", age_s: 0.1, is_acknowledged: true },
    is_standing: false,
    unseen: null,
    doubted: [],
    faults: [],
    latched: [{ name: "not_armed", reason: "not armed since the start" }],
    blockers: [],
    warnings: [],
    links: [
      { port: "motors", state: "connected", age_s: 0.1, max_age_s: null, reason: "" },
      { port: "compass", state: "connected", age_s: 0.1, max_age_s: 1, reason: "" },
      { port: "gps", state: "connected", age_s: 0.7, max_age_s: 3, reason: "" },
      { port: "sonar", state: "lost", age_s: 4.2, max_age_s: 0.5, reason: "closed by the robot" },
    ],
    position: {
      port: "gps",
      x_m: 12,
      y_m: 15,
      latitude_deg: 36.595402,
      longitude_deg: -121.874869,
      uncertainty_m: 2.5,
      age_s: 0.7,
    },
    heading: { port: "compass", magnetic_deg: 60, world_deg: 15.5, age_s: 0.1 },
    ranges: {
      port: "sonar",
      values_m: [2.2, 3.1, null, null, 4.5, null],
      is_known: [true, true, true, true, true, false],
      age_s: 4.2,
    },
    battery: { share: 0.72, is_estimated: true },
    waypoints: [
      {
        goal: "operator/1",
        x_m: 30,
        y_m: 10,
        latitude_deg: 36.595357,
        longitude_deg: -121.874668,
        verdict: "approaching",
        served_by: "bender/0",
        reason: null,
      },
      {
        goal: "operator/2",
        x_m: 30,
        y_m: 22,
        latitude_deg: 36.595465,
        longitude_deg: -121.874668,
        verdict: "pending",
        served_by: null,
        reason: null,
      },
    ],
    navigates: true,
  };
}
