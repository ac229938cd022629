import type { Point } from "../net/protocol";
import { robotAt } from "../run/robots";
import { type World, worldOf } from "../run/world";
import { type Camera, fitTo, pan, resize, toWorld, zoomAt } from "../view/camera";
import { onThemeChange } from "../view/colours";
import { Gestures } from "../view/gestures";
import type { Desk } from "./desk.svelte";
import { type Canvases, Drawing } from "./drawing";
import { poseOf, type Scene } from "./layers/layer";
import { Trails } from "./layers/trail_store";
import { Motion, reachOf } from "./motion";
import { Hand } from "./tools/hand";

const tapReach_px = 14;
/** More robots than this are drawn on their way only after a pause: some thirty times a second. */
const crowd = 1000;
const crowdPause_ms = 28;
const isStill = matchMedia("(prefers-reduced-motion: reduce)");

/** The picture of the world: what is seen of it, when it is drawn, and what hands do on it. */
export class Stage {
  private camera: Camera = { x: 0, y: 0, scale: 1, width: 1, height: 1 };
  private readonly drawing: Drawing;
  private readonly trails = new Trails();
  private readonly motion = new Motion();
  private pause: ReturnType<typeof setTimeout> | undefined;
  private readonly hand: Hand;
  private world: World | null = null;
  private worldIsOf: unknown = null;
  private isAwaited = false;
  private isFramed = false;
  private readonly endings: (() => void)[] = [];
  /** What is in hand. */
  ghost: Path2D | null = null;

  constructor(
    private readonly element: HTMLElement,
    canvases: Canvases,
    private readonly desk: Desk,
  ) {
    this.drawing = new Drawing(canvases);
    this.hand = new Hand(desk, this);
    this.listen();
  }

  close(): void {
    for (const end of this.endings) end();
  }

  /** Draws soon; `still` too what only changes with view, setting or colours. */
  redraw(still = true): void {
    if (still) this.drawing.stale();
    if (this.isAwaited) return;
    this.isAwaited = true;
    requestAnimationFrame(() => this.draw());
  }

  look(camera: Camera): void {
    this.camera = camera;
    this.isFramed = true;
    this.desk.camera = camera;
    this.redraw();
  }

  fit(): void {
    const { setting } = this.desk.session;
    this.desk.follows = false;
    if (setting) this.look(fitTo(setting.world.size, this.camera.width, this.camera.height));
  }

  zoom(factor: number, at: Point = [this.camera.width / 2, this.camera.height / 2]): void {
    this.look(zoomAt(this.camera, ...at, factor));
  }

  pan(dx: number, dy: number): void {
    this.desk.follows = false;
    this.look(pan(this.camera, dx, dy));
  }

  /** Lets go of what is in hand; true if there was something. */
  drop(): boolean {
    return this.hand.drop();
  }

  /** What is seen, drawn just now. */
  flat(): HTMLCanvasElement {
    this.draw();
    return this.drawing.flat();
  }

  /** Where in the world a pixel is, and how far a pointer reaches there. */
  place(at: Point): { at: Point; reach: number } {
    return { at: toWorld(this.camera, ...at), reach: tapReach_px / this.camera.scale };
  }

  /** Chooses the robot at a pixel, or none. */
  private tap(at: Point): void {
    const { session } = this.desk;
    const { shown } = session.arrivals;
    if (!session.setting || !shown) return;
    const { at: place, reach } = this.place(at);
    const robot = robotAt(shown, session.setting, ...place, reach);
    session.select(session.setting.robots[robot] ?? null);
  }

  private listen(): void {
    const { element, hand, desk } = this;
    const observer = new ResizeObserver(() => this.resized());
    observer.observe(element);
    new Gestures(element, {
      press: (at) => hand.press(at),
      drag: (at) => hand.drag(at),
      release: (at) => hand.release(at),
      tap: (at) => this.tap(at),
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (at, factor) => this.zoom(factor, at),
    });
    desk.session.onFrame = () => this.redraw(false);
    const stop = onThemeChange(() => {
      this.drawing.recolour();
      this.redraw();
    });
    this.endings.push(() => observer.disconnect(), stop);
  }

  private resized(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.drawing.resize(width, height);
    this.camera = resize(this.camera, width, height);
    // Not `redraw`: a canvas is wiped by its new size, and must not be seen so.
    this.draw();
  }

  private draw(): void {
    this.isAwaited = false;
    const { setting, arrivals } = this.desk.session;
    if (!setting || this.camera.width <= 1) return;
    const fresh = arrivals.take(setting.generation);
    if (fresh) this.motion.put(fresh, performance.now(), reachOf(setting));
    const scene = this.scene();
    if (!scene) return;
    if (scene.frame) this.trails.put(scene.frame, scene.selected);
    this.frameView(scene.world);
    if (this.desk.follows) this.follow(scene);
    this.drawing.draw(scene, this.camera, this.desk.on);
    if (this.motion.isUnderWay) this.goOn(setting.robots.length);
    if (!fresh) return;
    arrivals.drawn(fresh);
    this.desk.session.drew();
  }

  /** Draws robots on their way. */
  private goOn(robots: number): void {
    clearTimeout(this.pause);
    if (robots <= crowd) this.redraw(false);
    else this.pause = setTimeout(() => this.redraw(false), crowdPause_ms);
  }

  /** Moves the view with the selected robot. */
  private follow(scene: Scene): void {
    const [x, y] = poseOf(scene, scene.selected)?.at ?? [];
    if (x === undefined || y === undefined || (x === this.camera.x && y === this.camera.y)) return;
    this.camera = { ...this.camera, x, y };
    this.desk.camera = this.camera;
    this.drawing.stale();
  }

  private scene(): Scene | null {
    const { setting, state, map, selected } = this.desk.session;
    if (!setting) return null;
    const frame = this.motion.at(performance.now(), state?.playing === true && !isStill.matches);
    if (this.worldIsOf !== setting) {
      this.world = worldOf(setting);
      this.worldIsOf = setting;
      this.drawing.stale();
    }
    return {
      setting,
      world: this.world ?? worldOf(setting),
      frame: frame?.generation === setting.generation ? frame : null,
      mind: state?.mind ?? null,
      map,
      told: state?.robot ?? null,
      selected: selected === null ? -1 : setting.robots.indexOf(selected),
      trails: this.trails,
      ghost: this.ghost,
    };
  }

  /** The view that the address asks for, or all of the world. */
  private frameView({ size }: World): void {
    if (this.isFramed) return;
    this.isFramed = true;
    const { width, height } = this.camera;
    const { view } = this.desk.link;
    this.camera = view
      ? { x: view[0], y: view[1], scale: view[2], width, height }
      : fitTo(size, width, height);
    this.desk.camera = this.camera;
  }
}
