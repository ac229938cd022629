import { tokenFields } from "./token";

/**
 * The endpoint of the warden, the process that owns the robots of a drive. Every request is POST with a JSON body
 * of content type text/plain (no preflight) that contains the token; every answer is JSON. It does not pass
 * through the server of the page.
 */
export interface WardenState {
  /** Since the start of the drive. */
  time_s: number;
  fleet: string;
  recording: string;
  is_ending: boolean;
  is_held: boolean;
  /** Whether the emergency stop is latched. */
  is_stopped: boolean;
  operator: "you" | "other" | null;
  robots: WardenRobot[];
  events: WardenEvent[];
}

export interface WardenRobot {
  /** Such as `bender/0`. */
  name: string;
  driver: string;
  mode: Mode;
  is_armed: boolean;
  action: "move" | "stop" | "latched_stop";
  /** The setpoint. */
  requested: { speed_m_s: number; turn_rate_rad_s: number; heading_rad: number | null } | null;
  /** The newest motor line or lines, and whether the robot's kernel has acknowledged it. */
  written: { line: string; age_s: number; is_acknowledged: boolean } | null;
  /** Whether the inputs confirm a standstill. */
  is_standing: boolean;
  /** The fastest motion that the inputs do not exclude; null unless they confirm a standstill. */
  unseen: Unseen | null;
  /** The ports whose values are doubted: they have to change, or to be confirmed by hand. */
  doubted: string[];
  faults: Reason[];
  latched: Reason[];
  blockers: Reason[];
  warnings: Reason[];
  links: WardenLink[];
  position: Position | null;
  /** `world_deg` is counterclockwise from the x axis of the world. */
  heading: { port: string; magnetic_deg: number; world_deg: number; age_s: number } | null;
  /** A null value is a range without an echo, or without any value if it is not known. */
  ranges: { port: string; values_m: (number | null)[]; is_known: boolean[]; age_s: number } | null;
  battery: { share: number; is_estimated: boolean } | null;
  waypoints: Waypoint[];
  navigates: boolean;
}

export type Mode = "auto" | "manual";

export interface Unseen {
  speed_m_s: number;
  /** Null without an input for headings. */
  turn_rate_rad_s: number | null;
}

export interface WardenLink {
  port: string;
  state: "connecting" | "connected" | "lost";
  age_s: number | null;
  max_age_s: number | null;
  reason: string;
}

export interface Position {
  port: string;
  x_m: number;
  y_m: number;
  latitude_deg: number;
  longitude_deg: number;
  uncertainty_m: number;
  age_s: number;
}

export interface Waypoint {
  goal: string;
  x_m: number;
  y_m: number;
  latitude_deg: number;
  longitude_deg: number;
  verdict: string;
  served_by: string | null;
  /** Why it is not served, in words; null if it is, or may still be. */
  reason: string | null;
}

export interface Reason {
  name: string;
  reason: string;
}

export interface WardenEvent {
  number: number;
  time_s: number;
  level: Level;
  robot: string | null;
  text: string;
}

export const levels = ["info", "warning", "error"] as const;
export type Level = (typeof levels)[number];

/** The port of the warden on this machine, and its token. */
export interface Warden {
  port: number;
  token: string;
}

/** The drive that the page's server belongs to. */
export interface Drive {
  warden: Warden;
  fleet: string;
  /** Where the world lies; see `[world.origin]` of a scenario. */
  origin: Origin;
  /** What the map draws of each robot, by name. */
  robots?: Record<string, RobotOnMap>;
}

export interface Origin {
  latitude_deg: number;
  longitude_deg: number;
  rotation_deg?: number;
  declination_deg?: number;
}

export interface RobotOnMap {
  fence_m: [number, number][] | null;
  /** The direction of each sonar from the robot's heading, counterclockwise, and its longest range. */
  sonars: { facing_deg: number; max_m: number }[];
}

/** A degree and minute of a latitude or longitude, as the warden takes it. */
export interface Angle {
  degrees: number;
  minutes: number;
  hemisphere: string;
}

export type Answer<Body> =
  | { kind: "answered"; body: Body }
  /** The request is not possible now. */
  | { kind: "conflict"; reasons: Reason[] }
  /** The token is wrong, or this page's origin is not the warden's. */
  | { kind: "refused" }
  | { kind: "failed" };

/** The drive of this page's server; null if it has none. Throws if the server does not respond. */
export async function findDrive(): Promise<Drive | null> {
  const response = await fetch("drive", { cache: "no-store", headers: tokenFields() });
  if (response.status === 404) return null;
  if (!response.ok) throw new Error(`The server responded ${response.status} ${response.statusText}.`);
  return (await response.json()) as Drive | null;
}

/** Sends a request to the warden. `keepalive` lets it outlive the page. */
export function post(
  { port, token }: Warden,
  path: string,
  body: object,
  options: { signal?: AbortSignal; keepalive?: boolean } = {},
): Promise<Response> {
  return fetch(`http://127.0.0.1:${port}${path}`, {
    method: "POST",
    headers: { "Content-Type": "text/plain" },
    body: JSON.stringify({ token, ...body }),
    credentials: "omit",
    ...options,
  });
}

/** As `post`, with the answer sorted by its kind. Never throws. */
export async function ask<Body>(
  warden: Warden,
  path: string,
  body: object,
  signal: AbortSignal,
): Promise<Answer<Body>> {
  try {
    const response = await post(warden, path, body, { signal });
    if (response.status === 401 || response.status === 403) return { kind: "refused" };
    const content: unknown = await response.json();
    if (response.ok) return { kind: "answered", body: content as Body };
    return { kind: "conflict", reasons: reasonsOf(content) };
  } catch {
    return { kind: "failed" };
  }
}

/** The reason of a refusal. */
function reasonsOf(content: unknown): Reason[] {
  const { message } = (content ?? {}) as { message?: unknown };
  return [{ name: "refused", reason: typeof message === "string" ? message : "The warden gave no reason." }];
}
