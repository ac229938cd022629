import { FakeRun, mapsOf } from "./run.mjs";
import { documentOf, entryOf } from "./scenarios.mjs";

const mostUnseen = 3;

/** One page's run: what the real server's end of a socket does, without a simulator. */
export class Talk {
  constructor(socket, counter, studies) {
    this.socket = socket;
    this.studies = studies;
    this.counter = counter;
    this.unseen = 0;
    this.number = 0;
    this.toldAt = 0;
    socket.on("message", (data) => this.hear(JSON.parse(data.toString())));
    socket.on("close", () => clearInterval(this.timer));
  }

  say(message) {
    this.socket.send(JSON.stringify(message));
  }

  hear(message) {
    if (message.type === "open") return this.open(message);
    if (message.type === "got") return this.got();
    this[`hear_${message.type}`]?.(message);
    if (message.type !== "select") this.dirty = true;
    this.tell();
    this.show();
  }

  open({ scenario: asked, text, study, seed: given, run, changes, tick }) {
    const held = study ? this.studies.all.get(study.id) : null;
    const seed = given ?? held.ask.seed;
    const scenario = held ? held.ask.scenario : asked;
    if (scenario === "broken") {
      const message = "robots.rover.count is missing: must be a whole number from 0 to 1000000";
      return this.say({
        type: "refused",
        about: "open",
        faults: [
          {
            file: null,
            line: 7,
            path: "robots.rover.count",
            given: null,
            allowed: "",
            suggestion: null,
            message,
          },
        ],
      });
    }
    if (scenario === "full") {
      this.say({ type: "ended", why: "full", message: "As many runs are open as this server takes." });
      return this.socket.close();
    }
    this.base = documentOf(text === null ? scenario : "search");
    held?.points[study.configuration].forEach((value, i) =>
      put(this.base, held.planned.factors[i].path, value),
    );
    this.seed = Number(BigInt(seed) % 1000003n) + Number(run);
    Object.assign(this, { changes, generation: 0, edge: tick, playing: false, speed: 1, selected: null });
    const { name, engine, summary } = entryOf(text === null ? scenario : null);
    const { cap_s, step_s } = this.base.clock;
    this.say({ type: "opened", scenario: { id: scenario, name, engine, summary, cap_s, step_s }, seed, run });
    this.build(tick);
    this.tell();
    this.show();
    this.period = this.run.count > 20000 ? 1000 / 15 : 1000 / 30;
    this.timer = setInterval(() => this.beat(), this.period);
  }

  build(tick) {
    const document = structuredClone(this.base);
    for (const [at, path, value] of this.changes) if (at <= tick) put(document, path, value);
    this.generation += 1;
    this.run = new FakeRun(document, this.seed);
    this.run.to(tick);
    const { kinds, items } = this.run;
    const { generation, changes } = this;
    this.say({
      type: "setting",
      generation,
      document,
      robots: this.run.nameOf(),
      kinds,
      items,
      maps: mapsOf(document),
      changes,
    });
  }

  hear_play({ speed }) {
    Object.assign(this, { playing: !this.run.over(), speed, due: 0 });
  }
  hear_pause() {
    this.playing = false;
  }
  hear_step({ steps }) {
    this.playing = false;
    this.run.to(Math.max(0, this.run.tick + steps));
    this.edge = Math.max(this.edge, this.run.tick);
  }
  hear_go({ tick }) {
    this.playing = false;
    this.run.to(Math.min(tick, this.edge));
  }
  hear_select({ robot }) {
    this.selected = robot;
  }
  hear_change({ path, value }) {
    if (path.endsWith("behaviours") && value.some((one) => one.kind === "swarm")) return this.refuse(path);
    this.changes = [...this.changes.filter(([at]) => at <= this.run.tick), [this.run.tick, path, value]];
    this.edge = this.run.tick;
    this.build(this.run.tick);
  }
  hear_undo() {
    this.changes = this.changes.slice(0, -1);
    this.build(this.run.tick);
  }

  refuse(path) {
    const message = `${path}: swarm needs a sensor of kind robots, and rover has none`;
    this.say({
      type: "refused",
      about: "change",
      faults: [{ file: null, line: null, path, given: null, allowed: "", suggestion: null, message }],
    });
  }

  beat() {
    if (!this.playing) return;
    const steps = ((this.speed ?? 30) * this.period) / 1000 / this.run.step_s + (this.due ?? 0);
    this.due = steps % 1;
    for (let i = 0; i < Math.floor(steps) && !this.run.over(); i++) this.run.step();
    if (this.run.over()) this.playing = false;
    this.edge = Math.max(this.edge, this.run.tick);
    if (Date.now() - this.toldAt > 100 || !this.playing) this.tell();
    this.show();
  }

  tell() {
    if (!this.run) return;
    this.toldAt = Date.now();
    const { run, edge, playing, speed } = this;
    const hash = ((run.tick * 2654435761) >>> 0).toString(16).padStart(16, "0");
    const mind = this.selected === null ? null : run.mind(this.selected);
    const time_s = run.tick * run.step_s;
    this.say({
      type: "state",
      tick: run.tick,
      edge,
      time_s,
      hash,
      playing,
      speed,
      real: playing ? (speed ?? 30) : 0,
      over: run.over(),
      outcome: run.outcome(),
      mind,
    });
    const map = this.selected === null ? null : run.map(this.selected);
    if (map) this.say(map);
  }

  show() {
    if (!this.run || this.unseen >= mostUnseen) return;
    this.unseen += 1;
    this.number += 1;
    this.socket.send(this.run.frame(this.generation, this.number));
  }

  got() {
    this.unseen -= 1;
    this.counter.drawn += 1;
  }
}

function put(document, path, value) {
  const steps = path.split(".");
  const last = steps.pop();
  let table = document;
  for (const step of steps) table = table[step] ??= {};
  table[last] = value;
}
