import type { Inspection, Offer, SignalOffer, State } from "../../../api/protocol";
import { named, withoutFindTimes } from "../../../shared/outcome";

export const outcome = "outcome/";

/** Units by the endings of names, the longest first. */
const units: [ending: string, unit: string][] = [
  ["_rad_s", "rad/s"],
  ["_m_s2", "m/s²"],
  ["_m_s", "m/s"],
  ["_rad", "rad"],
  ["_m2", "m²"],
  ["_m", "m"],
  ["_s", "s"],
  ["_j", "J"],
  ["_w", "W"],
];

/** A number at a path in the inspection of a robot, such as `percept/battery/value`. */
export function inspected(robot: string, path: string): SignalOffer {
  const keys = path.split("/");
  const name = keys.findLast((key) => units.some(([ending]) => key.endsWith(ending))) ?? "";
  const [ending = "", unit = ""] = units.find(([each]) => name.endsWith(each)) ?? [];
  const words = keys
    .filter((key) => key !== "value")
    .map((key) => (key === name ? key.slice(0, -ending.length) : key));
  return { id: `robot/${robot}/${path}`, label: words.join(" ").replaceAll("_", " "), unit, of: robot };
}

/** A number of the outcome; the server sends it with the outcome over time. */
export function ofOutcome(column: string): SignalOffer {
  const { words, unit } = named(column);
  return { id: `${outcome}${column}`, label: words, unit, of: "" };
}

/** The signals of a robot that the server offers for each. */
export function ofBody(offers: SignalOffer[], robot: string): SignalOffer[] {
  return offers.map((offer) => ({ ...offer, id: offer.id.replace("{robot}", robot), of: robot }));
}

/** The paths of all numbers and truth values in a value. */
export function paths(value: unknown, path: string[] = []): string[] {
  if (typeof value === "number" || typeof value === "boolean") return [path.join("/")];
  if (typeof value !== "object" || value === null) return [];
  return Object.entries(value).flatMap(([key, part]) => paths(part, [...path, key]));
}

const maxOfRobot = 400;

/** Everything that can be drawn now: numbers of the outcome, of controllers, and of the selected robot. */
export function available(offer: Offer, state: State | null, robot: string | null): SignalOffer[] {
  const columns = withoutFindTimes(Object.keys(state?.outcome ?? {})).filter(
    (column) => typeof state?.outcome[column] === "number" && column !== "run",
  );
  const own = robot === null ? [] : ofBody(offer.robot_signals, robot);
  const inspection = state?.inspection?.robot === robot ? state?.inspection : null;
  return [...columns.map(ofOutcome), ...own, ...ofInspection(inspection), ...offer.signals];
}

function ofInspection(inspection: Inspection | null | undefined): SignalOffer[] {
  if (!inspection) return [];
  const { robot, tick: _, ...rest } = inspection;
  return paths(rest)
    .slice(0, maxOfRobot)
    .map((path) => inspected(robot, path));
}

/** What is known of a signal by its id, also if the present state does not have it. */
export function described(id: string, offer: Offer): SignalOffer {
  if (id.startsWith(outcome)) return ofOutcome(id.slice(outcome.length));
  const own = offer.signals.find((each) => each.id === id);
  if (own) return own;
  const [kind = "", name = "", index = "", ...path] = id.split("/");
  const robot = `${name}/${index}`;
  const body = ofBody(offer.robot_signals, robot).find((each) => each.id === id);
  if (body) return body;
  return kind === "robot" ? inspected(robot, path.join("/")) : { id, label: id, unit: "", of: "" };
}
