/** A small study with random outcomes, in which configurations that are proven worse are eliminated. */
import { answerOf } from "./answer.mjs";
import { namesOf, pointsOf } from "./study_form.mjs";
import { randomNumbers } from "./random.mjs";

const round_ms = 100;
const time_limit_s = 120;
/** Maximum number of additional runs per configuration and round. */
const maxMore = 20_000;
/** Final state and message of studies with these seeds. */
const failures = {
  13: ["stopped", "The disk is full. Free some space, then resume the study."],
  14: ["damaged", "studies/search: ledger.sqlite is damaged: a block of runs is missing"],
};

export class FakeStudy {
  constructor(planned, ask) {
    Object.assign(this, { planned, ask, state: "stopped", message: null, answer: null });
    this.labels = namesOf(planned.factors);
    this.points = pointsOf(planned.factors);
    this.arms = this.labels.map((_, number) => ({ number, runs: 0, sum: 0, squares: 0, out: null }));
    Object.assign(this, {
      eliminated: [],
      round: 0,
      seconds: 0,
      followers: new Set(),
      changed_s: Date.now() / 1000,
    });
  }

  run(confidence) {
    if (this.state === "running") return;
    if (confidence !== null) this.planned.confidence = confidence;
    if (confidence !== null) this.reopen();
    Object.assign(this, { state: "running", answer: null, message: null });
    this.timer = setInterval(() => this.runRound(), round_ms);
  }

  /** A higher confidence invalidates all eliminations. */
  reopen() {
    this.eliminated = [];
    for (const arm of this.arms) arm.out = null;
  }

  stop() {
    if (this.state === "running") this.end("stopped");
  }

  end(state) {
    clearInterval(this.timer);
    this.changed_s = Date.now() / 1000;
    if (state === "answered") this.answer = answerOf(this);
    this.state = state;
    this.publish();
    for (const socket of this.followers) socket.close(1000);
  }

  get remaining() {
    return this.arms.filter((arm) => arm.out === null);
  }

  get runs() {
    return this.arms.reduce((sum, arm) => sum + arm.runs, 0);
  }

  runRound() {
    this.round += 1;
    this.seconds += round_ms / 1000;
    const maxRuns = Math.max(...this.arms.map((arm) => arm.runs));
    const target = Math.min(Math.ceil(maxRuns * 1.35) + 6, maxRuns + maxMore);
    for (const arm of this.remaining) this.extend(arm, Math.min(target, this.ask.runs ?? target));
    if (!this.ask.runs) this.eliminate();
    if (this.ask.seed in failures && this.round > 5) {
      const [state, message] = failures[this.ask.seed];
      this.message = message;
      return this.end(state);
    }
    if (this.isDecided()) this.end("answered");
    else if (this.round % 2 === 0) this.publish();
  }

  extend(arm, target) {
    while (arm.runs < target) {
      const { merit } = this.outcome(arm.number, arm.runs);
      arm.runs += 1;
      arm.sum += merit;
      arm.squares += merit * merit;
    }
  }

  eliminate() {
    const [best] = this.ranked();
    for (const arm of this.remaining) {
      if (arm === best || this.interval(arm)[2] >= this.interval(best)[1]) continue;
      arm.out = { by: best.number, runs: arm.runs };
      this.eliminated.push([arm.number, best.number, arm.runs]);
    }
  }

  isDecided() {
    const { runs, max_runs } = this.ask;
    if (runs) return this.remaining.every((arm) => arm.runs >= runs);
    const [best] = this.ranked();
    const [, low, high] = this.interval(best);
    return (
      this.remaining.length === 1 ||
      high - low < 4 * this.planned.delta ||
      (max_runs && this.runs >= max_runs)
    );
  }

  ranked() {
    return this.remaining.toSorted((a, b) => b.sum / b.runs - a.sum / a.runs);
  }

  /** Mean merit with an anytime-valid interval, simultaneous for all configurations. */
  interval({ runs, sum, squares }) {
    if (runs === 0) return [null, null, null];
    const mean = sum / runs;
    const variance = Math.max(0.05, squares / runs - mean * mean);
    const tries = 4 * this.arms.length * (Math.log2(runs) + 1) ** 2;
    const half = Math.sqrt((2 * variance * Math.log(tries / (1 - this.planned.confidence))) / runs);
    return [mean, mean - half, mean + half];
  }

  /** The outcome of a run, the same at each call. */
  outcome(configuration, run) {
    const random = randomNumbers(
      Number(BigInt(this.ask.seed) % 999983n) * 31 + configuration * 1000003 + run * 7919,
    );
    const [team] = this.points[configuration];
    const time_s = 6 + (70 / Math.max(1, team)) * -Math.log(1 - random()) * (0.6 + 0.8 * random());
    const failed = time_s > time_limit_s || team === 0;
    const taken_s = Math.min(time_limit_s, time_s);
    const merit = -0.03 * taken_s - 0.2 * team - (failed ? 2 : 0);
    const missed = failed ? 1 + Math.floor(2 * random()) : 0;
    return {
      merit,
      time_s: taken_s,
      failed,
      found: 4 - missed,
      missed,
      collisions: Math.floor(team * random()),
    };
  }

  listed() {
    const { planned, state, message, changed_s, runs } = this;
    const { id, name, words, configurations, confidence, delta } = planned;
    const sentence = this.answer?.sentence ?? null;
    return {
      id,
      name,
      engine: "metric",
      state,
      words,
      configurations,
      runs,
      confidence,
      delta,
      sentence,
      message,
      changed_s,
    };
  }

  whole() {
    const source = { scenario: this.ask.scenario };
    return { ...this.listed(), planned: { ...this.planned, state: this.state }, source, answer: this.answer };
  }

  /** Sends the progress to a page, now and in future. */
  follow(socket) {
    this.followers.add(socket);
    socket.on("close", () => this.followers.delete(socket));
    socket.send(JSON.stringify({ ...this.standing(), labels: this.labels }));
    if (this.state !== "running") socket.close(1000);
  }

  publish() {
    const text = JSON.stringify({ ...this.standing(), labels: null });
    for (const socket of this.followers) socket.send(text);
  }

  standing() {
    const { state, message, round, runs, seconds, eliminated } = this;
    const survivors = this.ranked().filter((arm) => arm.runs > 0);
    const left_s = Math.max(0, 3 - seconds);
    return {
      type: "study_progress",
      state,
      message,
      rounds: round,
      runs,
      computed: runs,
      seconds,
      runs_per_s: Math.round(runs / Math.max(0.1, seconds)),
      remaining: this.remaining.length,
      remaining_runs: null,
      remaining_s: state === "running" && left_s > 0 ? left_s : null,
      standings: survivors.slice(0, 50).map((arm) => [arm.number, arm.runs, ...this.interval(arm)]),
      eliminated,
    };
  }

  runsOf(configuration, query) {
    const { runs: total } = this.arms[configuration];
    const row = (run) => ({ run: String(run), ...this.outcome(configuration, run) });
    const head = { configuration, label: this.labels[configuration], total };
    const sample = Number(query.get("sample") ?? 0);
    if (sample > 0)
      return {
        ...head,
        runs: sampled(
          Array.from({ length: total }, (_, i) => row(i)),
          sample,
        ),
      };
    const first = Number(query.get("first") ?? 0);
    const count = Math.max(0, Math.min(Number(query.get("count") ?? 100), 1000, total - first));
    return { ...head, runs: Array.from({ length: count }, (_, i) => row(first + i)) };
  }
}

function sampled(rows, count) {
  const ranked = rows.toSorted((a, b) => a.merit - b.merit);
  const quantiles = Array.from({ length: Math.min(count, rows.length) }, (_, i) => i / (count - 1));
  return quantiles.map((quantile) => ({ ...ranked[Math.round(quantile * (rows.length - 1))], quantile }));
}
