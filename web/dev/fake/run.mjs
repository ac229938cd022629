/** A fake run: robots wander, find items that they pass, and collide now and then. */
import { randomNumbers } from "./random.mjs";

const tau = 2 * Math.PI;

export class FakeRun {
  constructor(document, seed) {
    this.document = document;
    this.seed = seed;
    this.kinds = kindsOf(document);
    this.size = document.world.size_m;
    this.step_s = document.clock.step_s ?? 0.1;
    this.items = itemsOf(document, seed);
    this.restart();
  }

  restart() {
    this.random = randomNumbers(this.seed * 7919 + 1);
    this.tick = 0;
    this.collisions = 0;
    this.count = this.kinds.reduce((sum, kind) => sum + kind.count, 0);
    this.robots = new Float32Array(4 * this.count);
    this.found = new Uint8Array(this.items.length);
    for (let i = 0; i < this.count; i++) {
      this.robots[4 * i] = (0.05 + 0.9 * this.random()) * this.size[0];
      this.robots[4 * i + 1] = (0.05 + 0.9 * this.random()) * this.size[1];
      this.robots[4 * i + 2] = this.random() * tau;
      this.robots[4 * i + 3] = i % 97 === 50 ? 3 : i % 211 === 100 ? 4 : 0;
    }
  }

  to(tick) {
    if (tick < this.tick) this.restart();
    while (this.tick < tick) this.step();
  }

  step() {
    this.tick += 1;
    for (let i = 0; i < this.count; i++) this.move(i);
  }

  move(i) {
    const { robots, random } = this;
    const state = robots[4 * i + 3];
    if (state > 2) return;
    const speed = this.size[0] > 100 ? 5 : 1;
    robots[4 * i + 2] += (random() - 0.5) * 0.2;
    const x = robots[4 * i] + Math.cos(robots[4 * i + 2]) * speed * this.step_s;
    const y = robots[4 * i + 1] + Math.sin(robots[4 * i + 2]) * speed * this.step_s;
    const inside = x > 0.3 && y > 0.3 && x < this.size[0] - 0.3 && y < this.size[1] - 0.3;
    if (inside) [robots[4 * i], robots[4 * i + 1]] = [x, y];
    else robots[4 * i + 2] += 2;
    if (state === 0 && random() < 0.004) robots[4 * i + 3] = 1;
    else if (state === 1 && random() < 0.05) robots[4 * i + 3] = random() < 0.2 ? 2 : 0;
    else if (state === 2 && random() < 0.05) robots[4 * i + 3] = 0;
    if (state === 1 && robots[4 * i + 3] === 2) this.collisions += 1;
    if (this.count < 1000) this.look(x, y);
  }

  look(x, y) {
    this.items.forEach((item, k) => {
      if (item.target && Math.hypot(item.at[0] - x, item.at[1] - y) < 1) this.found[k] = 1;
    });
  }

  outcome() {
    const target = this.items.filter((item) => item.target).length;
    const found = this.found.reduce((sum, state) => sum + (state === 1 ? 1 : 0), 0);
    return {
      found,
      missed: target - found,
      collisions: this.collisions,
      energy_j: 40 * this.tick * this.count * this.step_s,
      time_s: this.tick * this.step_s,
      merit: -0.03 * this.tick * this.step_s - 0.2 * this.count,
      distance_m: this.tick * this.count * this.step_s,
      false_alarms: 0,
      stopped: 0,
    };
  }

  over() {
    const { missed } = this.outcome();
    return missed === 0 || this.tick * this.step_s >= this.document.clock.time_limit_s;
  }

  frame(generation, number) {
    const buffer = Buffer.alloc(32 + 16 * this.count + this.items.length);
    for (const [i, value] of [1, generation, this.tick, this.count].entries())
      buffer.writeUInt32LE(value, 4 * i);
    buffer.writeDoubleLE(this.tick * this.step_s, 16);
    buffer.writeUInt32LE(this.items.length, 24);
    buffer.writeUInt32LE(number, 28);
    Buffer.from(this.robots.buffer).copy(buffer, 32);
    const missed = this.tick * this.step_s >= this.document.clock.time_limit_s;
    this.items.forEach((item, i) => {
      buffer[32 + 16 * this.count + i] = missed && item.target && !this.found[i] ? 2 : this.found[i];
    });
    return buffer;
  }

  inspection(robot) {
    const i = this.nameOf().indexOf(robot);
    if (i < 0) return null;
    const [x, y, heading_rad] = this.robots.subarray(4 * i, 4 * i + 3);
    const beliefState = {
      pose: { at: [x + 0.2, y - 0.1], heading_rad, deviation_m: 0.3, deviation_rad: 0.05, age_s: 0.1 },
      items: this.items.slice(0, 2).map((item, k) => ({
        kind: 0,
        at: [item.at[0] + 0.4, item.at[1] - 0.3],
        deviation_m: 0.5 + k / 3,
        confidence: 0.9 - 0.4 * k,
      })),
      robots: [],
      goals: [
        goal(0, [20, 12], 0.83, "approaching"),
        { ...goal(1, [3, 3], 0.12, "receding"), is_pursued: false, stuck_s: 6.2 },
      ],
      heading_options: headingOptionsTo([6, 2]),
    };
    const has = this.document.robots[robot.split("/")[0]].brain !== undefined;
    return {
      robot,
      tick: this.tick,
      percept: perceptOf([x, y, heading_rad], this.tick * this.step_s),
      command: {
        motion: { speed_m_s: 0.8, turn_rate_rad_s: 0.3 },
        requests: [],
        outbox: [{ about: { sender: {} }, confidence: 1 }],
      },
      leading: 0,
      holds_s: [0, 0, 1.5],
      belief_state: has ? beliefState : null,
    };
  }

  /** A map with a known strip, as wide as the robot's distance travelled, and walls at its edges. */
  map(robot) {
    const i = this.nameOf().indexOf(robot);
    if (i < 0 || !this.inspection(robot).belief_state) return null;
    const [columns, rows] = this.size.map((size) => Math.ceil(size));
    const [x, y] = this.robots.subarray(4 * i, 4 * i + 2);
    const occupancy = Buffer.alloc(columns * rows, 255);
    const unseen = Buffer.alloc(columns * rows, 100);
    for (let cell = 0; cell < columns * rows; cell++) {
      const [column, row] = [cell % columns, Math.floor(cell / columns)];
      const away = Math.hypot(column + 0.5 - x, row + 0.5 - y);
      if (away > 7) continue;
      occupancy[cell] = away > 6 ? 95 : 5;
      unseen[cell] = away < 4 ? 10 : 100;
    }
    const whole = { corner: [0, 0], cell_m: 1, columns, rows, from: [0, 0], size: [columns, rows] };
    const cells = { occupancy: occupancy.toString("base64"), unseen: unseen.toString("base64") };
    return { type: "map", robot, ...whole, ...cells };
  }

  kindOf(robot) {
    let last = 0;
    return this.kinds.find((kind) => robot < (last += kind.count));
  }

  nameOf() {
    return this.kinds.flatMap((kind) => Array.from({ length: kind.count }, (_, i) => `${kind.name}/${i}`));
  }
}

function goal(behaviour, to, precedence, verdict) {
  const numbers = { value: 1, likely: 1, time_s: 2, within_m: 0.3, left_m: 4.2, best_m: 4.2 };
  return { behaviour, to, precedence, verdict, ...numbers, stuck_s: 0, rests_s: 0, is_pursued: true };
}

/** Heading options all around; the one nearest to a point ahead is chosen. */
function headingOptionsTo(to) {
  const headings = Array.from({ length: 40 }, (_, i) => {
    const bearing_rad = (tau * (i > 20 ? i - 40 : i)) / 40;
    const free_m = 2 + 1.5 * Math.sin(3 * bearing_rad);
    const at = [free_m * Math.cos(bearing_rad), free_m * Math.sin(bearing_rad)];
    return { bearing_rad, free_m, at, utility: -Math.hypot(to[0] - at[0], to[1] - at[1]) };
  });
  const max = Math.max(...headings.map(({ utility }) => utility));
  return { to, chosen: headings.findIndex(({ utility }) => utility === max), headings };
}

const rays = Array.from({ length: 36 }, (_, i) => tau * (i / 36) - Math.PI);

function perceptOf([x, y, heading_rad], time_s) {
  const reading = (value) => ({ value, age_s: 0.1 });
  return {
    time_s,
    position: reading([x, y]),
    heading_rad: reading(heading_rad),
    motion: reading({ speed_m_s: 0.8, turn_rate_rad_s: 0.3 }),
    battery: reading(0.83),
    touch: null,
    scans: [{ age_s: 0.05, ranges_m: rays.map((ray) => (Math.abs(ray) < 1 ? null : 3 + Math.sin(5 * ray))) }],
    observations: [{ sensor: 0, age_s: 0 }],
    contacts: [{ kind: 0, range_m: 2, bearing_rad: 0.4, age_s: 0 }],
    neighbours: [{ range_m: 3, bearing_rad: -2, course_rad: null, age_s: 0.1, id: { kind: 0, index: 2 } }],
    inbox: [{ age_s: 0.2, message: { about: { goal: {} }, confidence: 1 } }],
  };
}

function kindsOf(document) {
  return Object.entries(document.robots).map(([name, robot]) => ({
    name,
    count: robot.count,
    radius: robot.radius_m ?? 0.27,
    is_flying: robot.model === "quadrotor",
    radio_range_m: 12,
    rings: robot.radius_m ? [] : [{ bearings_rad: rays, range_m: 6 }],
    sensors: robot.radius_m
      ? []
      : [
          {
            name: "camera",
            kind: "items",
            range_m: robot.sensors?.camera?.range_m ?? 3,
            width_rad: 1.2,
            facing_rad: 0,
          },
          { name: "laser", kind: "range", range_m: 6, width_rad: tau, facing_rad: 0 },
        ],
  }));
}

function itemsOf(document, seed) {
  const random = randomNumbers(seed + 5);
  const [width, height] = document.world.size_m;
  return Object.entries(document.items ?? {}).flatMap(([kind, { count, target = true, placement }]) =>
    Array.from({ length: count }, (_, i) => ({
      kind,
      at: placement?.at_m?.[i] ?? [(0.1 + 0.8 * random()) * width, (0.1 + 0.8 * random()) * height],
      target,
      contact: [],
    })),
  );
}

/** A picture of a scenario for the gallery. */
export function pictureOf(document) {
  const run = new FakeRun(document, 0);
  const [w, h] = run.size;
  const shapes = (document.world.obstacles ?? []).map((one) =>
    one.polygon_m
      ? `<polygon points="${one.polygon_m.map(([x, y]) => `${x},${h - y}`).join(" ")}" fill="#9aa3ae"/>`
      : one.circle
        ? `<circle cx="${one.circle.at_m[0]}" cy="${h - one.circle.at_m[1]}" r="${one.circle.radius_m}" fill="#9aa3ae"/>`
        : "",
  );
  const robots = Array.from(
    { length: Math.min(run.count, 500) },
    (_, i) =>
      `<circle cx="${run.robots[4 * i]}" cy="${h - run.robots[4 * i + 1]}" r="${w / 80}" fill="#1a5fd0"/>`,
  );
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${w} ${h}"><rect width="${w}" height="${h}" fill="#fff" stroke="#868f9b" stroke-width="${w / 200}"/>${shapes.join("")}${robots.join("")}</svg>`;
}

/** A map with a room in it. */
export function mapsOf(document) {
  if (!(document.world.obstacles ?? []).some((one) => one.map)) return [];
  const [columns, rows] = [40, 30];
  const cells = Buffer.alloc(columns * rows);
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      const wall = row === 0 || row === rows - 1 || column === 0 || (column === columns - 1 && row > 8);
      cells[row * columns + column] = wall ? 2 : row < 6 && column < 8 ? 1 : 0;
    }
  }
  const corners = [
    [38, 22],
    [54, 22],
    [54, 34],
    [38, 34],
  ];
  return [{ corners, columns, rows, cells: cells.toString("base64") }];
}
