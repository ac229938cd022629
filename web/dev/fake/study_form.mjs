/** The fake server's part of the study form: factors, plans and input errors. */
import { documentOf, entryOf } from "./scenarios.mjs";

const maxConfigurations = 10_000;
const others = [
  { path: "clock.time_limit_s", value: 120, low: 0.1, high: 100_000, whole: false },
  { path: "items.mine.count", value: 4, low: 0, high: 10_000, whole: true },
  { path: "robots.rover.drive.max_speed_m_s", value: 1, low: 0.01, high: 50, whole: false },
  { path: "robots.rover.sensors.camera.range_m", value: 3, low: 0.1, high: 1000, whole: false },
  { path: "robots.rover.brain.arbitration.kind", value: "goals", values: ["goals", "schemas"] },
];

export function factorsOf({ scenario }) {
  const { name, engine, summary } = entryOf(scenario);
  const teams = Object.entries(documentOf(scenario ?? "search").robots).map(([kind, { count }]) => ({
    path: `robots.${kind}.count`,
    value: count,
    low: 0,
    high: 100_000,
    whole: true,
    varied: kind === "rover" ? "1..9" : null,
  }));
  const factors = [...teams, ...others].map((one) => ({
    low: null,
    high: null,
    whole: false,
    values: null,
    varied: null,
    ...one,
  }));
  const merits = ["equation-5.2", "appendix"];
  const design = "factorial";
  return {
    name,
    engine,
    summary,
    factors,
    design,
    merits,
    merit: merits[0],
    delta: 0.01,
    confidence: 0.95,
  };
}

/** The plan of a study request, or its input errors. */
export function planOf(ask) {
  const known = factorsOf(ask);
  const varied = Object.keys(ask.vary).length > 0 ? ask.vary : variedIn(known);
  const errors = [...numberErrors(ask)];
  const factors = Object.entries(varied).map(([path, text]) => ({
    path,
    values: valuesOf(known, path, text, errors),
    range: null,
  }));
  const configurations = factors.reduce((product, { values }) => product * values.length, 1);
  if (configurations > maxConfigurations)
    errors.push(
      inputError(
        "study.vary",
        configurations,
        `gives ${configurations} configurations; the maximum is 10000`,
      ),
    );
  if (errors.length > 0) return { errors };
  return { planned: planned(ask, known, factors, configurations) };
}

function planned(ask, known, factors, configurations) {
  const { delta, confidence } = { delta: ask.delta ?? known.delta, confidence: ask.confidence ?? 0.95 };
  const guarantee = ask.guarantee ?? "indifference";
  const name = known.name.replace(/\W+/g, "-");
  const digest = isPlain(ask) ? "" : `-${hash(JSON.stringify(ask))}`;
  return {
    id: `studies/${name}${digest}`,
    name: known.name,
    configurations,
    labels: namesOf(factors).slice(0, 50),
    words: `${ask.design ?? "factorial"}: ${configurations} configurations; delta ${delta}, confidence ${confidence}, ${guarantee}`,
    delta,
    confidence,
    guarantee,
    merit: ask.merit ?? known.merit,
    factors,
    state: null,
  };
}

/** Whether the request is the scenario's own study. */
function isPlain({ scenario: _, text: __, vary, seed, ...rest }) {
  return (
    Object.keys(vary).length === 0 && seed === "0" && Object.values(rest).every((value) => value === null)
  );
}

/** Labels of all combinations, such as "3 rovers, range_m 2". */
export function namesOf(factors) {
  return pointsOf(factors).map((values) =>
    values
      .map((value, i) => {
        const [, kind] = /^robots\.(\w+)\.count$/.exec(factors[i].path) ?? [];
        if (!kind) return `${factors[i].path.split(".").pop()} ${value}`;
        return `${value} ${kind}${value === 1 ? "" : "s"}`;
      })
      .join(", "),
  );
}

export function pointsOf(factors) {
  return factors.reduce(
    (points, { values }) => points.flatMap((point) => values.map((value) => [...point, value])),
    [[]],
  );
}

function variedIn({ factors }) {
  return Object.fromEntries(factors.flatMap(({ path, varied }) => (varied ? [[path, varied]] : [])));
}

function valuesOf({ factors }, path, text, errors) {
  const factor = factors.find((one) => one.path === path);
  const at = `study.vary."${path}"`;
  if (!factor) errors.push(inputError(at, text, "is not a known key"));
  const [, first, last] = /^(\d+)\.\.(\d+)$/.exec(text) ?? [];
  if (last !== undefined && Number(first) <= Number(last) && Number(last) < 100_000)
    return Array.from({ length: Number(last) - Number(first) + 1 }, (_, i) => Number(first) + i);
  const list = text.split(",").map((one) => (factor?.values ? one.trim() : Number(one || "?")));
  const isGood = list.every((one) => (factor?.values ? factor.values.includes(one) : Number.isFinite(one)));
  if (!isGood)
    errors.push(inputError(at, `"${text}"`, 'must be a string of values, such as "1..40" or "1,2,4"'));
  return list;
}

function* numberErrors({ delta, confidence, runs, max_runs, seed }) {
  if (delta !== null && !(delta > 0)) yield inputError("delta", delta, "must be a number greater than 0");
  if (confidence !== null && !(confidence > 0 && confidence < 1))
    yield inputError("confidence", confidence, "must be a number between 0 and 1");
  if (runs !== null && max_runs !== null)
    yield inputError("max_runs", max_runs, "must be left out where runs is given");
  if (!/^\d{1,20}$/.test(seed))
    yield inputError("seed", `"${seed}"`, "must be a whole number from 0 to 2^64 - 1");
}

export function inputError(path, given, allowed) {
  const shown = given === null ? null : String(given);
  const message = shown === null ? `${path} ${allowed}` : `${path} = ${shown}: ${allowed}`;
  return { file: null, line: null, path, value: shown, allowed, suggestion: null, message };
}

function hash(text) {
  const sum = [...text].reduce((code, sign) => (Math.imul(code, 31) + sign.charCodeAt(0)) | 0, 7);
  return (sum >>> 0).toString(16).padStart(8, "0");
}
