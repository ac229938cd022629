/** The answer of a fake study, with charts as in the real report. */
import { readFileSync } from "node:fs";

const templates = JSON.parse(readFileSync(new URL("charts.json", import.meta.url), "utf8"));
const colours = { selected: "#2f7fd1", undecided: "#d9730d", worse: "#87909b", out: "#87909b" };
const shapes = { selected: "circle", undecided: "diamond", worse: "triangle-down", out: "square" };
const number = (value, digits = 2) => value.toFixed(digits).replace("-", "−");

export function answerOf(study) {
  const results = study.arms.map((arm) => resultOf(study, arm));
  const best = study.ranked()[0].number;
  for (const result of results) {
    const behind = result.configuration === best ? "best" : result.eliminated ? "worse" : "undecided";
    result.verdict = behind;
  }
  const { label, merit, failed } = results[best];
  const share = `${number(100 * failed[0], 2)}% of runs fail`;
  const { delta, confidence } = study.planned;
  return {
    sentence: `Send ${label}. A run takes ${number(results[best].time_s[0], 1)} s on average, ${share}, and the figure of merit is ${number(merit[0])} (${number(merit[1])} to ${number(merit[2])}).`,
    guarantee: `If one configuration is better than every other by ${delta} or more, it is the selected one with ${100 * confidence}% confidence. Smaller differences are not guaranteed to be found.`,
    facts: [
      [`${100 * confidence}%`, "confidence"],
      [String(delta), "indifference zone (delta)"],
      [study.runs.toLocaleString("en"), "runs"],
      [String(results.length), "configurations"],
    ],
    quarantined: "",
    sections: sectionsOf(results),
    charts: chartsOf(results, study),
    results,
  };
}

function resultOf(study, arm) {
  const runs = Array.from({ length: Math.min(arm.runs, 2000) }, (_, run) => study.outcome(arm.number, run));
  const mean = (pick) => runs.reduce((sum, run) => sum + Number(pick(run)), 0) / Math.max(1, runs.length);
  const [time_s, failed] = [mean((run) => run.time_s), mean((run) => run.failed)];
  return {
    configuration: arm.number,
    label: study.labels[arm.number],
    values: Object.fromEntries(
      study.planned.factors.map(({ path }, i) => [path, study.points[arm.number][i]]),
    ),
    runs: arm.runs,
    merit: study.interval(arm),
    time_s: [time_s, time_s * 0.9, time_s * 1.1],
    failed: [failed, failed * 0.5, Math.min(1, failed * 2 + 0.01)],
    eliminated: arm.out !== null,
  };
}

function sectionsOf(results) {
  const ranged = ([value, low, high], digits) =>
    `${number(value, digits)} (${number(low, digits)} to ${number(high, digits)})`;
  const table = (caption, head, rowOf) => ({
    caption,
    head: ["configuration", ...head],
    rows: results.map((result) => [result.label, ...rowOf(result)]),
    configurations: results.map((result) => result.configuration),
  });
  const section = (id, title, words, caption, found, folded) => ({
    id,
    title,
    words: [words],
    charts: [id],
    captions: { [id]: caption },
    tables: [found],
    folded,
  });
  return [
    section(
      "merit",
      "Figure of merit",
      "Merit of a run = −0.03 × time_s + −0.2 × robots + −2 × failed (equation-5.2). Higher is better.",
      "Figure of merit with its interval",
      table(
        "Figure of merit of each configuration",
        ["standing", "figure of merit", "runs"],
        ({ merit, runs, ...one }) => [standing(one), ranged(merit, 2), runs.toLocaleString("en")],
      ),
      false,
    ),
    section(
      "front",
      "Price, time and failures",
      "The size of a mark shows the share of failed runs.",
      "Price and mean time with its interval; larger marks fail more often",
      table(
        "Price, time and failures of each configuration",
        ["mean time, s", "failed"],
        ({ time_s, failed }) => [ranged(time_s, 1), `${number(100 * failed[0], 1)}%`],
      ),
      true,
    ),
    section(
      "runs",
      "Where the runs went",
      "A configuration gets runs only as long as it may be the best.",
      "Runs per configuration",
      table("Runs per configuration, and its status", ["runs", "status"], ({ runs, eliminated, ...one }) => [
        runs.toLocaleString("en"),
        eliminated ? "out" : standing(one),
      ]),
      true,
    ),
  ];
}

function chartsOf(results, { points, planned }) {
  const axis = planned.factors[0].path.replace(/^robots\.(.*)\.count$/, "$1s");
  const merit = results.map((one) => ({
    ...rowOf(one, one.merit),
    at: Number(points[one.configuration][0]) || 0,
    verdict: standing(one),
  }));
  const front = results.map((one) => ({
    ...rowOf(one, one.time_s),
    price: Number(points[one.configuration][0]) || 0,
    failed: one.failed[0],
    place: standing(one),
  }));
  const runs = results.map(({ configuration, label, runs, eliminated }) => ({
    configuration,
    label,
    runs,
    state: eliminated ? "out" : "selected",
  }));
  return {
    merit: named(filled("merit", merit, "verdict"), axis),
    front: filled("front", front, "place"),
    runs: filled(
      "runs",
      runs.toSorted((a, b) => b.runs - a.runs),
      "state",
    ),
  };
}

/** The verdict on a configuration, as in charts and tables. */
function standing({ verdict }) {
  return verdict === "best" ? "selected" : verdict;
}

function rowOf({ configuration, label }, [value, low, high]) {
  return { configuration, label, value, low, high };
}

/** A chart of the report with these rows in it. */
function filled(name, rows, meaning) {
  const spec = structuredClone(templates[name]);
  spec.data.values = rows;
  const there = [...new Set(rows.map((row) => row[meaning]))];
  for (const { encoding } of spec.layer) {
    if (encoding.color?.scale) encoding.color.scale = scale(there, colours);
    if (encoding.shape?.scale) encoding.shape.scale = scale(there, shapes);
    if (encoding.y?.sort) encoding.y.sort = rows.map((row) => row.label);
  }
  return spec;
}

/** The chart with the factor's name on its x axis. */
function named(spec, title) {
  for (const { encoding } of spec.layer) encoding.x.title = title;
  return spec;
}

function scale(domain, range) {
  return { domain, range: domain.map((meaning) => range[meaning]) };
}
