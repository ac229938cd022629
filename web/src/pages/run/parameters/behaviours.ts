import type { Json, PathStep, Table } from "../../../api/protocol";
import { isTable, valueAt } from "./list";

export interface Behaviour {
  kind: string;
  [key: string]: Json;
}

/** A switch of the page, and the behaviours that it turns on and off. */
export interface Switch {
  name: string;
  help: string;
  kinds: string[];
}

export const switches: Switch[] = [
  {
    name: "Search",
    help: "Searches for items",
    kinds: ["bayesian_search", "frontier", "lawnmower", "spiral", "random_bounce"],
  },
  { name: "Follow", help: "Follows the robot ahead", kinds: ["follow"] },
  { name: "Flock", help: "Moves with neighbouring robots", kinds: ["flock"] },
];

/** Behaviours of a robot kind that lists none. */
const defaultBehaviours: Behaviour[] = [{ kind: "cruise" }, { kind: "random_bounce" }, { kind: "avoid" }];

/** Reflexes have priority over all other behaviours. */
const reflexes = new Set(["avoid", "return_home"]);

export function behavioursOf(document: Table, robotKind: string): Behaviour[] {
  const given = valueOfKind(document, robotKind, ["brain", "behaviours"]);
  return Array.isArray(given) ? given.filter(isBehaviour) : defaultBehaviours;
}

export function behavioursPath(robotKind: string): string {
  return `robots.${robotKind}.brain.behaviours`;
}

export function isOn(behaviours: Behaviour[], { kinds }: Switch): boolean {
  return behaviours.some((behaviour) => kinds.includes(behaviour.kind));
}

/** Removes a switch's behaviours, or restores those it removed, or adds the first that the brain supports. */
export function switched(
  behaviours: Behaviour[],
  toggle: Switch,
  removed: Behaviour[],
  usesGoals: boolean,
): Behaviour[] {
  if (isOn(behaviours, toggle)) return behaviours.filter((one) => !toggle.kinds.includes(one.kind));
  const added = removed.length > 0 ? removed : [{ kind: firstKind(toggle, usesGoals) }];
  const reflex = behaviours.findIndex((one) => reflexes.has(one.kind));
  const place = reflex < 0 ? behaviours.length : reflex;
  return [...behaviours.slice(0, place), ...added, ...behaviours.slice(place)];
}

/** Whether the brain of a robot kind selects goals. */
export function usesGoals(document: Table, robotKind: string): boolean {
  const arbitration = valueOfKind(document, robotKind, ["brain", "arbitration"]);
  return isTable(arbitration) && arbitration.kind === "goals";
}

/** A value of a robot kind, or of the models of the scenario that it is based on. */
function valueOfKind(document: Table, robotKind: string, steps: PathStep[]): Json | undefined {
  const known = new Set<string>();
  let place: [string, string] = ["robots", robotKind];
  while (true) {
    const value = valueAt(document, [...place, ...steps]);
    const model = valueAt(document, [...place, "model"]);
    if (value !== undefined || typeof model !== "string" || known.has(model)) return value;
    known.add(model);
    place = ["models", model];
  }
}

function firstKind(toggle: Switch, goals: boolean): string {
  const first = toggle.kinds[0] ?? "";
  return first === "bayesian_search" && !goals ? "random_bounce" : first;
}

function isBehaviour(value: Json): value is Behaviour {
  return isTable(value) && typeof value.kind === "string";
}
