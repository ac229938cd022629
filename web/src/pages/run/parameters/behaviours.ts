import type { Json, Table } from "../../../api/protocol";
import { valueAt } from "./list";
import { isTable } from "./schema";

export interface Behaviour {
  kind: string;
  [key: string]: Json;
}

/** A switch of the page, and the behaviours that it stands for. */
export interface Switch {
  name: string;
  help: string;
  kinds: string[];
}

export const switches: Switch[] = [
  {
    name: "Search",
    help: "looks for items",
    kinds: ["bayesian_search", "frontier", "lawnmower", "spiral", "random_bounce"],
  },
  { name: "Follow", help: "goes behind the robot before it", kinds: ["follow"] },
  { name: "Swarm", help: "goes with the others", kinds: ["flock"] },
];

/** What a robot does whose scenario does not say. */
const usual: Behaviour[] = [{ kind: "cruise" }, { kind: "random_bounce" }, { kind: "avoid" }];

/** These have their way before all others. */
const reflexes = new Set(["avoid", "return_home"]);

export function behavioursOf(document: Table, robotKind: string): Behaviour[] {
  const given = valueAt(document, ["robots", robotKind, "brain", "behaviours"]);
  return Array.isArray(given) ? given.filter(isBehaviour) : usual;
}

export function behavioursPath(robotKind: string): string {
  return `robots.${robotKind}.brain.behaviours`;
}

export function isOn(behaviours: Behaviour[], { kinds }: Switch): boolean {
  return behaviours.some((behaviour) => kinds.includes(behaviour.kind));
}

/** The list without a switch's behaviours, or with what it had of them; otherwise with one that fits. */
export function switched(
  behaviours: Behaviour[],
  toggle: Switch,
  removed: Behaviour[],
  wantsGoals: boolean,
): Behaviour[] {
  if (isOn(behaviours, toggle)) return behaviours.filter((one) => !toggle.kinds.includes(one.kind));
  const added = removed.length > 0 ? removed : [{ kind: firstKind(toggle, wantsGoals) }];
  const reflex = behaviours.findIndex((one) => reflexes.has(one.kind));
  const place = reflex < 0 ? behaviours.length : reflex;
  return [...behaviours.slice(0, place), ...added, ...behaviours.slice(place)];
}

/** Whether a kind's robots go for goals; those that do not search by bouncing. */
export function wantsGoals(document: Table, robotKind: string): boolean {
  const arbitration = valueAt(document, ["robots", robotKind, "brain", "arbitration"]);
  return isTable(arbitration) && arbitration.kind === "goals";
}

function firstKind(toggle: Switch, goals: boolean): string {
  const first = toggle.kinds[0] ?? "";
  return first === "bayesian_search" && !goals ? "random_bounce" : first;
}

function isBehaviour(value: Json): value is Behaviour {
  return isTable(value) && typeof value.kind === "string";
}
