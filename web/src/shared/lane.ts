/** The mined lane of a run: what a controller believes of it, in numbers, words and shapes. */
import type { Lanes, LaneScale, LaneView, MarkView, Point, Setting } from "../api/protocol";
import { plural, seconds } from "./format";
import { tableOf } from "./world";

/** Whether controllers of a run are to clear a lane. */
export function hasLane(setting: Setting): boolean {
  return clearingKind(setting) !== undefined;
}

/** The name of the kind of controllers that are to clear the lane. */
function clearingKind({ document }: Setting): string | undefined {
  const kinds = Object.entries(tableOf(document.controllers));
  return kinds.find(([, kind]) => "clearance" in tableOf(kind))?.[0];
}

/** The key with which a person ends the mission on the lane. */
export function calledOffPath(setting: Setting): string {
  return `controllers.${clearingKind(setting)}.clearance.called_off`;
}

/** What a controller believes of the lane; that of the first if it is null or does not exist. */
export function laneOf(lanes: Lanes | null, controller: string | null): LaneView | null {
  return lanes?.lanes.find((lane) => lane.controller === controller) ?? lanes?.lanes[0] ?? null;
}

const decoded = new WeakMap<LaneView, Uint8Array>();

/** A byte for each cell, the lowest row first: see `LaneScale`. */
export function cellsOf(lane: LaneView): Uint8Array {
  const known = decoded.get(lane);
  if (known) return known;
  const cells = Uint8Array.from(atob(lane.expected), (character) => character.charCodeAt(0));
  decoded.set(lane, cells);
  return cells;
}

/** Decades of the colour scale: its first colour is of cells that are cleared. */
const decades = 3;

/** The place of a byte on the colour scale, 0 to 1. */
export function shadeOf(scale: LaneScale, byte: number): number {
  const perDecade = 255 / Math.log10(scale.max / scale.min);
  return Math.min(1, Math.max(0, (byte - scale.cleared) / (decades * perDecade)));
}

/** The powers of ten within the colour scale, with the place of each. */
export function ticksOf(scale: LaneScale): { label: string; place: number }[] {
  const perDecade = Math.log10(scale.max / scale.min) / 255;
  const first = Math.log10(scale.min) + scale.cleared * perDecade;
  const powers = Array.from({ length: decades + 1 }, (_, i) => Math.ceil(first) + i);
  const inside = powers.filter((power) => power <= first + decades);
  return inside.map((power) => ({ label: numberLabel(10 ** power), place: (power - first) / decades }));
}

/** The share of cells that are cleared. */
export function clearedShare(lane: LaneView): number {
  const cells = cellsOf(lane);
  return cells.filter((byte) => byte <= lane.scale.cleared).length / Math.max(1, cells.length);
}

/** The sides of cells between a cleared one and one that is not, or the outside; in cells from the lower left corner. */
export function borderOf(lane: LaneView): [from: Point, to: Point][] {
  const { columns, rows, scale } = lane;
  const cells = cellsOf(lane);
  const isCleared = (column: number, row: number) =>
    column >= 0 &&
    row >= 0 &&
    column < columns &&
    row < rows &&
    (cells[row * columns + column] ?? 255) <= scale.cleared;
  const sides: [Point, Point][] = [];
  for (let row = 0; row <= rows; row++)
    for (let column = 0; column <= columns; column++) {
      const here = isCleared(column, row);
      if (here !== isCleared(column - 1, row))
        sides.push([
          [column, row],
          [column, row + 1],
        ]);
      if (here !== isCleared(column, row - 1))
        sides.push([
          [column, row],
          [column + 1, row],
        ]);
    }
  return sides;
}

export type MarkState = "unverified" | NonNullable<MarkView["verdict"]>;

export const markStates: MarkState[] = [
  "unverified",
  "confirmed",
  "rejected",
  "missed",
  "neutralised",
  "isolated",
];

export function stateOf({ verdict }: MarkView): MarkState {
  return verdict ?? "unverified";
}

/** Whether the controller believes that there is a mine. */
export function isBelievedMine({ mine }: MarkView): boolean {
  return mine >= 0.5;
}

/** The number of marks of each state that occurs, such as `3 unverified, 2 neutralised`. */
export function markCounts(marks: MarkView[]): string {
  const counts = markStates.map((state) => {
    const count = marks.filter((mark) => stateOf(mark) === state).length;
    return count > 0 ? `${count} ${state}` : "";
  });
  return counts.filter(Boolean).join(", ") || "no marks";
}

/** Such as `Remaining risk 3.1%: 0.021 mines expected without a mark, 0.010 at marks.` */
export function riskLabel({ risk }: LaneView): string {
  const { unmarked, marked, probability } = risk;
  return `Remaining risk ${percent(probability)}: ${expectedLabel(unmarked)} mines expected without a mark, ${expectedLabel(marked)} at marks.`;
}

/** What the controller has stated, such as `Declared clear at 412.0 s, at a risk of 4.6%.` */
export function statementLabel({ statement, declare_below }: LaneView): string {
  if (!statement) return `No statement yet: it declares the lane clear below ${percent(declare_below)}.`;
  const { is_clear, at_s, risk } = statement;
  return `${is_clear ? "Declared clear" : "Given up"} at ${seconds(at_s)}, at a risk of ${percent(risk)}.`;
}

/** Such as `2 mines left in the lane.` */
export function truthLabel(mines: number): string {
  return `${mines === 0 ? "No mines" : plural(mines, "mine")} left in the lane.`;
}

/** Such as `3.1%`, `63%`, `over 99.9%` or `0.02%`. */
export function percent(probability: number): string {
  const value = 100 * probability;
  if (value > 99.9 && value < 100.001) return "over 99.9%";
  if (value >= 10) return `${value.toFixed(0)}%`;
  return value < 0.01 ? (value > 0 ? "under 0.01%" : "0%") : `${Number(value.toPrecision(2))}%`;
}

function expectedLabel(mines: number): string {
  return mines >= 1 ? mines.toFixed(1) : mines.toFixed(mines >= 0.1 ? 2 : 3);
}

function numberLabel(value: number): string {
  return value >= 1e-4 ? String(Number(value.toPrecision(1))) : value.toExponential(0);
}
