import { expect, test } from "vitest";
import type { ColumnOffer, Outcome } from "../api/protocol";
import { comparedFigures, figuresOf, grouped, inWords, withoutFindTimes } from "./outcome";

const running = { isOver: false, time_s: 4 };
const over = { isOver: true, time_s: 12.5 };

function column(id: string, rest: Partial<ColumnOffer> = {}): ColumnOffer {
  return {
    id,
    label: id,
    unit: "",
    group: "All",
    help: `What ${id} is.`,
    is_first: false,
    known: "always",
    after: [],
    time_of: null,
    out_of: [],
    all: null,
    ...rest,
  };
}

function shown(outcome: Outcome, columns: ColumnOffer[], moment = running): string[] {
  return figuresOf(outcome, columns, moment).map(inWords);
}

test("the time of a running run is that so far, and at the end that of the outcome", () => {
  const columns = [column("time_s", { unit: "s", known: "clock" })];
  expect(shown({ time_s: 600 }, columns)).toEqual(["time_s 4.0 s so far"]);
  expect(shown({ time_s: 12.3456 }, columns, over)).toEqual(["time_s 12.35 s"]);
});

test("what the end decides is left out until then, or not yet if it comes first", () => {
  const merit = { merit: -1.234 };
  expect(shown(merit, [column("merit", { known: "at_end" })])).toEqual([]);
  expect(shown(merit, [column("merit", { known: "at_end", is_first: true })])).toEqual(["merit not yet"]);
  expect(shown(merit, [column("merit", { known: "at_end" })], over)).toEqual(["merit -1.23"]);
});

test("a condition that does not hold is not yet met while the run is not over", () => {
  expect(shown({ complete: false }, [column("complete")])).toEqual(["complete not yet"]);
  expect(shown({ complete: false }, [column("complete")], over)).toEqual(["complete no"]);
  expect(shown({ complete: true }, [column("complete")], over)).toEqual(["complete yes"]);
});

test("an event and its time are one figure, with the time once it has happened", () => {
  const columns = [
    column("declared", { is_first: true, group: "Lane" }),
    column("declared_s", { label: "declared", unit: "s", time_of: "declared" }),
  ];
  expect(shown({ declared: false, declared_s: 600 }, columns)).toEqual(["declared not yet"]);
  expect(shown({ declared: false, declared_s: 600 }, columns, over)).toEqual(["declared no"]);
  const [figure] = figuresOf({ declared: true, declared_s: 352 }, columns, over);
  expect(figure).toMatchObject({
    column: "declared_s",
    value: "352",
    unit: "s",
    isFirst: true,
    group: "Lane",
  });
});

test("what is known after an event only is left out before it", () => {
  const columns = [column("risk", { unit: "%", after: ["declared", "given_up"] })];
  expect(shown({ risk: 1, declared: false, given_up: false }, columns)).toEqual([]);
  expect(shown({ risk: 0.046, declared: false, given_up: true }, columns)).toEqual(["risk 4.6 %"]);
  const mean = [column("waiting_s", { unit: "s", after: ["served"] })];
  expect(shown({ waiting_s: 0, served: 0 }, mean)).toEqual([]);
  expect(shown({ waiting_s: 7.5, served: 2 }, mean)).toEqual(["waiting_s 7.5 s"]);
});

test("a run that ends without an event has none of what it states, if that comes first", () => {
  const columns = [column("risk", { is_first: true, after: ["declared"] })];
  expect(shown({ risk: 1, declared: false }, columns, over)).toEqual(["risk none"]);
});

test("counts are given out of all: of the parts, or else of the number that all runs have", () => {
  const outcome = { found: 1, missed: 3 };
  const parts = { out_of: ["found", "missed"], all: 9 };
  expect(shown(outcome, [column("found", parts)])).toEqual(["found 1 / 4"]);
  expect(shown({ found: 1 }, [column("found", parts)])).toEqual(["found 1 / 9"]);
});

test("only the reason for which a run is over is a figure", () => {
  const columns = [column("hopeless", { known: "reason" }), column("time_limit", { known: "reason" })];
  const outcome = { hopeless: true, time_limit: false };
  expect(shown(outcome, columns)).toEqual([]);
  expect(shown(outcome, columns, over)).toEqual(["hopeless yes"]);
});

test("numbers have at most two decimals, large energies are in kilojoules, and there is no -0", () => {
  const columns = [column("energy_j", { unit: "J" }), column("left"), column("distance_m", { unit: "m" })];
  const outcome = { energy_j: 48_512, left: -0, distance_m: 468.2256 };
  expect(shown(outcome, columns)).toEqual(["energy_j 48.51 kJ", "left 0", "distance_m 468 m"]);
});

test("columns that the server does not offer, and values that are missing, are left out", () => {
  expect(shown({ run: 7, paints: null, found: 2 }, [column("paints"), column("found")])).toEqual(["found 2"]);
});

test("figures are grouped in their order", () => {
  const columns = [
    column("a", { group: "Team" }),
    column("b", { group: "Costs" }),
    column("c", { group: "Team" }),
  ];
  const groups = grouped(figuresOf({ a: 1, b: 2, c: 3 }, columns, running));
  expect(groups.map(([group, figures]) => [group, ...figures.map(({ label }) => label)])).toEqual([
    ["Team", "a", "c"],
    ["Costs", "b"],
  ]);
});

test("the times of finds are left out, and counts of kinds with similar names are not", () => {
  const columns = ["found_cow_1_s", "missed_cow_1_s", "found_cow_1_s_1_s", "time_s"];
  expect(withoutFindTimes(columns)).toEqual(["found_cow_1_s", "missed_cow_1_s", "time_s"]);
});

test("figures of two runs stand side by side as far as they are known, with the difference of the second one", () => {
  const columns = [
    column("time_s", { unit: "s", known: "clock" }),
    column("complete"),
    column("energy_j", { unit: "J" }),
    column("merit", { known: "at_end" }),
  ];
  const outcome = { time_s: 600, complete: false, energy_j: 9_000, merit: -1 };
  const left = { outcome, columns, moment: running };
  const right = {
    outcome: { time_s: 12.5, complete: true, energy_j: 29_000, merit: -2 },
    columns: [...columns, column("price")],
    moment: over,
  };
  const rows = comparedFigures(left, right).map((row) => [row.column, row.left, row.right, row.difference]);
  expect(rows).toEqual([
    ["time_s", "4.0 s so far", "12.5 s", "8.5 s"],
    ["complete", "not yet", "yes", ""],
    ["energy_j", "9,000 J", "29 kJ", "20 kJ"],
    ["merit", "–", "-2", ""],
  ]);
});
