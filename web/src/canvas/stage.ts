import type { Point } from "../api/protocol";
import { robotAt } from "../shared/robots";
import { type World, worldOf } from "../shared/world";
import { type Camera, fitTo, pan, resize, toWorld, zoomAt } from "./camera";
import { onThemeChange } from "./colours";
import { Gestures } from "./gestures";
import type { Host } from "./host";
import { type Canvases, Drawing } from "./drawing";
import { poseOf, type Scene } from "./layers/layer";
import { Trails } from "./layers/trail_store";
import { Motion, reachOf } from "./interpolation";
import { ToolController } from "./tools/controller";

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
  private readonly controller: ToolController;
  private world: World | null = null;
  private worldIsOf: unknown = null;
  private isAwaited = false;
  private isFramed = false;
  private readonly endings: (() => void)[] = [];
  /** What is in controller. */
  ghost: Path2D | null = null;

  constructor(
    private readonly element: HTMLElement,
    canvases: Canvases,
    private readonly host: Host,
  ) {
    this.drawing = new Drawing(canvases);
    this.controller = new ToolController(host, this);
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
    this.host.camera = camera;
    this.redraw();
  }

  fit(): void {
    const { setting } = this.host.session;
    this.host.follows = false;
    if (setting) this.look(fitTo(setting.world.size, this.camera.width, this.camera.height));
  }

  zoom(factor: number, at: Point = [this.camera.width / 2, this.camera.height / 2]): void {
    this.look(zoomAt(this.camera, ...at, factor));
  }

  pan(dx: number, dy: number): void {
    this.host.follows = false;
    this.look(pan(this.camera, dx, dy));
  }

  /** Lets go of what is in controller; true if there was something. */
  drop(): boolean {
    return this.controller.drop();
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
    const { session } = this.host;
    const { shown } = session.frames;
    if (!session.setting || !shown) return;
    const { at: place, reach } = this.place(at);
    const robot = robotAt(shown, session.setting, ...place, reach);
    session.select(session.setting.robots[robot] ?? null);
  }

  private listen(): void {
    const { element, controller, host } = this;
    const observer = new ResizeObserver(() => this.resized());
    observer.observe(element);
    new Gestures(element, {
      press: (at) => controller.press(at),
      drag: (at) => controller.drag(at),
      release: (at) => controller.release(at),
      tap: (at) => this.tap(at),
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (at, factor) => this.zoom(factor, at),
    });
    host.session.onFrame = () => this.redraw(false);
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
    const { setting, frames } = this.host.session;
    if (!setting || this.camera.width <= 1) return;
    const fresh = frames.take(setting.generation);
    if (fresh) this.motion.put(fresh, performance.now(), reachOf(setting));
    const scene = this.scene();
    if (!scene) return;
    if (scene.frame) this.trails.put(scene.frame, scene.selected);
    this.frameView(scene.world);
    if (this.host.follows) this.follow(scene);
    this.drawing.draw(scene, this.camera, this.host.layers);
    if (this.motion.isUnderWay) this.goOn(setting.robots.length);
    if (!fresh) return;
    frames.drawn(fresh);
    this.host.session.drew();
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
    this.host.camera = this.camera;
    this.drawing.stale();
  }

  private scene(): Scene | null {
    const { setting, state, map, selected } = this.host.session;
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
    const { view } = this.host.link;
    this.camera = view
      ? { x: view[0], y: view[1], scale: view[2], width, height }
      : fitTo(size, width, height);
    this.host.camera = this.camera;
  }
}
