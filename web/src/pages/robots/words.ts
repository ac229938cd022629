import type { FaultView, WardenLink, WardenRobot } from "../../api/warden";
import { roundedUp, slowerThan } from "../../shared/standstill";
import type { Connection } from "./connection";

export function actionOf({ action, requested }: WardenRobot): string {
  // The rules allow motion; that it is requested is another matter.
  const move = isMotion(requested) ? "moves" : "may move";
  return { move, stop: "stopped", latched_stop: "stopped, latched" }[action];
}

function isMotion(requested: WardenRobot["requested"]): boolean {
  if (!requested) return false;
  const { speed_m_s, turn_rate_rad_s, heading_rad } = requested;
  return speed_m_s !== 0 || turn_rate_rad_s !== 0 || heading_rad !== null;
}

/** What is known of a robot's motion, from the request to the evidence. */
export function motionOf(robot: WardenRobot): [string, string][] {
  const { requested, written } = robot;
  return [
    ["Requested", requested ? setpoint(requested) : "nothing"],
    ["Written", written ? `${written.line.trim()} · ${written.age_s.toFixed(1)} s ago` : "nothing"],
    ["Acknowledged", acknowledged(written)],
    ["Standstill", standstillOf(robot)],
  ];
}

/** Whether a standstill is confirmed, always with the fastest motion that would go unseen. */
function standstillOf({ is_standing, unseen }: WardenRobot): string {
  if (!is_standing || !unseen) return "not confirmed";
  const { speed_m_s, turn_rate_rad_s } = unseen;
  const turn =
    turn_rate_rad_s === null ? "; turns are not measured" : ` and ${roundedUp(degrees(turn_rate_rad_s))}°/s`;
  return `confirmed (${slowerThan(speed_m_s)}${turn})`;
}

function setpoint({ speed_m_s, turn_rate_rad_s, heading_rad }: NonNullable<WardenRobot["requested"]>) {
  const turn =
    heading_rad === null
      ? `turn ${Math.round(degrees(turn_rate_rad_s)) || 0}°/s` // no negative zero
      : `to heading ${degrees(heading_rad).toFixed(0)}°`;
  return `${speed_m_s.toFixed(2)} m/s, ${turn}`;
}

function acknowledged(written: WardenRobot["written"]): string {
  if (!written) return "not confirmed";
  return written.is_acknowledged ? "by the robot's kernel" : "not confirmed";
}

const degrees = (angle_rad: number) => (180 / Math.PI) * angle_rad;

export function batteryOf({ battery }: WardenRobot): string {
  if (!battery) return "not reported";
  return `${Math.round(100 * battery.share)}%${battery.is_estimated ? " (estimated)" : ""}`;
}

export function ageOf({ age_s, max_age_s }: WardenLink): string {
  const age = age_s === null ? "no line yet" : `${age_s.toFixed(1)} s`;
  return max_age_s === null ? age : `${age} of ${max_age_s.toFixed(1)} s`;
}

export function isOld({ state, age_s, max_age_s }: WardenLink): boolean {
  return state !== "connected" || (max_age_s !== null && (age_s === null || age_s > max_age_s));
}

/** The name of a fault or reason as people read it. */
export function readable(name: string): string {
  return name.replaceAll("_", " ");
}

/** What the reason of a fault adds to its name, with which it may begin. */
export function detailOf({ name, reason }: FaultView): string {
  const title = readable(name);
  const rest = reason.slice(title.length);
  return reason.startsWith(title) && /^($|[ :])/.test(rest) ? rest.replace(/^[ :]+/, "") : reason;
}

/** A fault with its reason, in words. */
export function faultOf(fault: FaultView): string {
  return [readable(fault.name), detailOf(fault)].filter((part) => part !== "").join(": ");
}

/** The faults of a robot by title, each once: one that is also latched, or keeps it from being armed, is not repeated. */
export function faultLists(robot: WardenRobot): { title: string; faults: FaultView[] }[] {
  const lists = [
    { title: "Faults", faults: robot.faults },
    { title: "Latched", faults: robot.latched },
    { title: "Warnings", faults: robot.warnings },
    { title: "Cannot be armed", faults: robot.is_armed ? [] : robot.blockers },
  ];
  const shown = new Set<string>();
  return lists
    .map(({ title, faults }) => ({
      title,
      faults: faults.filter(({ name }) => !shown.has(name) && shown.add(name)),
    }))
    .filter(({ faults }) => faults.length > 0);
}

/** The state of the connection in words, and how serious it is. */
export function phaseOf(connection: Connection): { tone: "plain" | "warning" | "error"; text: string } {
  switch (connection.phase) {
    case "connecting":
      return { tone: "plain", text: "Connecting to the warden." };
    case "connected":
      return { tone: "plain", text: "Connected to the warden." };
    case "stale":
      return {
        tone: "warning",
        text: "Stale: the warden has reported nothing for more than 0.5 s. Values are old.",
      };
    case "lost":
      return {
        tone: "error",
        text: "Lost: the warden cannot be reached. Nothing is known of the robots; values are old.",
      };
    case "refused":
      return {
        tone: "error",
        text: "Refused: the warden does not accept this page. Reload it from the server of the drive.",
      };
  }
}
