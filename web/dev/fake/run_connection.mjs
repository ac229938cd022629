import { overlayOf } from "./overlay.mjs";
import { FakeRun, mapsOf } from "./run.mjs";
import { documentOf, entryOf } from "./scenarios.mjs";

const maxUnseen = 3;

/** The run of one page: the server side of its WebSocket, without a simulator. */
export class FakeRunConnection {
  constructor(socket, { studies }) {
    this.socket = socket;
    this.studies = studies;
    this.unseen = 0;
    this.number = 0;
    this.layers = { links: false, footprints: false };
    this.sentAt = 0;
    socket.on("message", (data) => this.hear(JSON.parse(data.toString())));
    socket.on("close", () => this.close());
  }

  close() {
    clearInterval(this.timer);
  }

  say(message) {
    this.socket.send(JSON.stringify(message));
  }

  hear(message) {
    if (message.type === "open") return this.open(message);
    if (message.type === "acknowledge") return this.got(message.frame);
    this[`hear_${message.type}`]?.(message);
    if (message.type !== "select") this.dirty = true;
    this.tell();
    this.show();
  }

  open(message) {
    const { text, study, run } = message;
    const held = study ? this.studies.all.get(study.id) : null;
    const { seed = held?.ask.seed, scenario: requested } = message;
    const scenario = held ? held.ask.scenario : requested;
    const { tick } = message;
    const changes = message.changes;
    if (scenario === "broken") {
      const message = "robots.rover.count is missing: expected a whole number from 0 to 1000000";
      return this.say({
        type: "refused",
        about: "open",
        path: null,
        errors: [
          {
            file: null,
            line: 7,
            path: "robots.rover.count",
            value: null,
            allowed: "",
            suggestion: null,
            message,
          },
        ],
      });
    }
    if (scenario === "full") {
      this.say({ type: "ended", reason: "full", message: "As many runs are open as this server takes." });
      return this.socket.close();
    }
    this.base = documentOf(text === null ? scenario : "search");
    held?.points[study.configuration].forEach((value, i) =>
      put(this.base, held.planned.factors[i].path, value),
    );
    this.seed = Number(BigInt(seed) % 1000003n) + Number(run);
    this.source = { scenario, text, seed, run };
    const edge = tick;
    Object.assign(this, { changes, generation: 0, edge, playing: false, speed: 1, selected: null });
    const { name, engine, summary } = entryOf(text === null ? scenario : null);
    const { time_limit_s } = this.base.clock;
    const opened = { id: scenario, name, engine, summary, time_limit_s };
    this.say({ type: "opened", scenario: opened, seed, run, recording: null });
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
    const { generation } = this;
    const changes = this.changes.filter(([at]) => at <= tick);
    this.say({
      type: "setting",
      generation,
      step_s: this.run.step_s,
      world: { size: this.run.size, periodic: false, unit: "m", cell: null },
      document,
      robots: this.run.nameOf(),
      kinds,
      items,
      item_kinds: Object.keys(document.items ?? {}).sort(),
      maps: mapsOf(document),
      changes,
      log: this.changes,
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
    this.go(Math.max(0, this.run.tick + steps));
    this.edge = Math.max(this.edge, this.run.tick);
  }
  hear_seek({ tick }) {
    this.playing = false;
    this.go(Math.min(tick, this.edge));
  }
  go(tick) {
    const made = (at) => this.changes.filter((change) => change[0] <= at).length;
    if (made(tick) === made(this.run.tick)) this.run.to(tick);
    else this.build(tick);
  }
  hear_select({ robot }) {
    this.selected = robot;
  }
  hear_layers({ links, footprints }) {
    this.layers = { links, footprints };
  }
  hear_change({ path, value, replaces_last }) {
    if (path.endsWith("behaviours") && value.some((one) => one.kind === "flock"))
      return this.refuse("change", `${path}: flock needs a sensor of kind robots, and rover has none`, path);
    const made = this.changes.filter(([at]) => at <= this.run.tick);
    const last = made.at(-1);
    if (replaces_last && last?.[0] === this.run.tick && last[1] === path) made.pop();
    this.changes = [...made, [this.run.tick, path, value]];
    this.edge = this.run.tick;
    this.build(this.run.tick);
  }
  hear_undo() {
    this.changes = this.changes.slice(0, -1);
    this.build(this.run.tick);
  }

  hear_export() {
    this.say({ type: "exported", text: `# From ${this.run.tick}\nengine = "metric"\n` });
  }

  refuse(about, message, path = null) {
    this.say({
      type: "refused",
      about,
      path,
      errors: [
        { file: null, line: null, path: path ?? "", value: null, allowed: "", suggestion: null, message },
      ],
    });
  }

  beat() {
    if (!this.playing) return;
    const steps = ((this.speed ?? 30) * this.period) / 1000 / this.run.step_s + (this.due ?? 0);
    this.due = steps % 1;
    for (let i = 0; i < Math.floor(steps) && !this.run.over(); i++) this.run.step();
    if (this.run.over()) this.playing = false;
    this.edge = Math.max(this.edge, this.run.tick);
    if (Date.now() - this.sentAt > 100 || !this.playing) this.tell();
    this.show();
  }

  tell() {
    if (!this.run) return;
    this.sentAt = Date.now();
    const { run, edge, playing, speed } = this;
    const hash = ((run.tick * 2654435761) >>> 0).toString(16).padStart(16, "0");
    const inspection = this.selected === null ? null : run.inspection(this.selected);
    const time_s = run.tick * run.step_s;
    this.say({
      type: "state",
      tick: run.tick,
      latest_tick: edge,
      time_s,
      hash,
      is_playing: playing,
      speed,
      measured_speed: playing ? (speed ?? 30) : 0,
      is_over: run.over(),
      target_tick: null,
      mismatch_tick: null,
      outcome: run.outcome(),
      inspection,
      robot: null,
    });
    const map = this.selected === null ? null : run.map(this.selected);
    if (map) this.say(map);
  }

  /** As in the real server: a map part is sent once. */
  show() {
    const { layers, selected } = this;
    const moment = this.run && JSON.stringify([this.generation, this.run.tick, layers, selected]);
    if (!moment || moment === this.shown || this.unseen >= maxUnseen) return;
    this.shown = moment;
    this.unseen += 1;
    this.number += 1;
    const overlay = overlayOf(this.run, this.number, layers, this.run.nameOf().indexOf(selected));
    if (overlay) this.socket.send(overlay);
    this.socket.send(this.run.frame(this.generation, this.number));
  }

  /** An acknowledgement covers all frames before it. */
  got(frame) {
    this.unseen = this.number - frame;
  }
}

function put(document, path, value) {
  const steps = path.split(".");
  const last = steps.pop();
  let table = document;
  for (const step of steps) table = table[step] ??= {};
  table[last] = value;
}
