import type { Choose, Point, Shown } from "../api/protocol";
import { robotAt } from "../shared/robots";
import { type World, worldOf } from "../shared/world";
import { type Camera, fitTo, pan, resize, resizeIn, toWorld, zoomAt } from "./camera";
import { onThemeChange } from "./colours";
import { Gestures } from "./gestures";
import type { Host } from "./host";
import { type Canvases, Drawing } from "./drawing";
import { poseOf, type Scene } from "./layers/layer";
import { Trails } from "./layers/trail_store";
import { Interpolation, motionLimitOf } from "./interpolation";
import { ToolController } from "./tools/controller";

const tapTolerance_px = 14;
/** With more robots than this, interpolated frames are limited to about 30 per second. */
const manyRobots = 1000;
const manyRobotsPause_ms = 28;
const prefersReducedMotion = matchMedia("(prefers-reduced-motion: reduce)");

/** The view of the world: camera, drawing schedule, and pointer input. */
export class Stage {
  private camera: Camera = { x: 0, y: 0, scale: 1, width: 1, height: 1 };
  private readonly drawing: Drawing;
  private readonly trails = new Trails();
  private readonly interpolation = new Interpolation();
  private pause: ReturnType<typeof setTimeout> | undefined;
  private readonly controller: ToolController;
  private world: World | null = null;
  private worldSetting: unknown = null;
  private isScheduled = false;
  private hasView = false;
  private readonly cleanups: (() => void)[] = [];
  /** The shape that the current tool would place. */
  preview: Path2D | null = null;

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
    for (const end of this.cleanups) end();
  }

  /** Schedules a redraw; with `still`, also of the layers that change only with view, setting or colours. */
  redraw(still = true): void {
    if (still) this.drawing.invalidate();
    if (this.isScheduled) return;
    this.isScheduled = true;
    requestAnimationFrame(() => this.draw());
  }

  look(camera: Camera): void {
    this.camera = camera;
    this.hasView = true;
    this.host.camera = camera;
    this.redraw();
  }

  fit(): void {
    const { setting } = this.host.session;
    this.host.follows = false;
    if (setting) this.look(fitTo(setting.world.size, this.camera.width, this.camera.height));
  }

  /** Centres the view on a place. */
  centre([x, y]: Point): void {
    this.host.follows = false;
    this.look({ ...this.camera, x, y });
  }

  zoom(factor: number, at: Point = [this.camera.width / 2, this.camera.height / 2]): void {
    this.look(zoomAt(this.camera, ...at, factor));
  }

  pan(dx: number, dy: number): void {
    this.host.follows = false;
    this.look(pan(this.camera, dx, dy));
  }

  /** Cancels the current edit; false if there is none. */
  cancelEdit(): boolean {
    return this.controller.cancel();
  }

  /** Draws the view and returns it as one canvas. */
  snapshot(): HTMLCanvasElement {
    this.draw();
    return this.drawing.snapshot();
  }

  /** The point of the world at a pixel, and the pointer's tolerance there. */
  place(at: Point): { at: Point; tolerance: number } {
    return { at: toWorld(this.camera, ...at), tolerance: tapTolerance_px / this.camera.scale };
  }

  /** Selects the robot at a pixel, or chooses what a marker there chooses, or selects none. */
  private tap(at: Point): void {
    const { session } = this.host;
    const frame = session.frames.shown;
    if (!session.setting || !frame) return;
    const { at: place, tolerance } = this.place(at);
    const robot = session.setting.robots[robotAt(frame, session.setting, ...place, tolerance)] ?? null;
    const choice = choiceAt(session.shown, place, tolerance);
    if (robot === null && choice !== null) this.host.choose(choice);
    else session.select(robot);
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
    this.cleanups.push(() => observer.disconnect(), stop);
  }

  private resized(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.drawing.resize(width, height);
    const size = this.host.session.setting?.world.size;
    this.camera = size ? resizeIn(size, this.camera, width, height) : resize(this.camera, width, height);
    // Drawn at once, as resizing clears the canvas.
    this.draw();
  }

  private draw(): void {
    this.isScheduled = false;
    const { setting, frames } = this.host.session;
    if (!setting || this.camera.width <= 1) return;
    const fresh = frames.take(setting.generation);
    if (fresh) this.interpolation.put(fresh, performance.now(), motionLimitOf(setting));
    const scene = this.scene();
    if (!scene) return;
    if (scene.frame) this.trails.put(scene.frame, scene.selected);
    this.initView(scene.world);
    if (this.host.follows) this.follow(scene);
    this.drawing.draw(scene, this.camera, this.host.layers);
    if (this.interpolation.isMoving) this.scheduleNext(setting.robots.length);
    if (!fresh) return;
    frames.drawn(fresh);
    this.host.session.drew();
  }

  /** Schedules the next interpolated frame. */
  private scheduleNext(robots: number): void {
    clearTimeout(this.pause);
    if (robots <= manyRobots) this.redraw(false);
    else this.pause = setTimeout(() => this.redraw(false), manyRobotsPause_ms);
  }

  /** Centres the view on the selected robot. */
  private follow(scene: Scene): void {
    const [x, y] = poseOf(scene, scene.selected)?.at ?? [];
    if (x === undefined || y === undefined || (x === this.camera.x && y === this.camera.y)) return;
    this.camera = { ...this.camera, x, y };
    this.host.camera = this.camera;
    this.drawing.invalidate();
  }

  private scene(): Scene | null {
    const { setting, state, map, shown, selected } = this.host.session;
    if (!setting) return null;
    const frame = this.interpolation.at(
      performance.now(),
      state?.is_playing === true && !prefersReducedMotion.matches,
    );
    if (this.worldSetting !== setting) {
      this.world = worldOf(setting);
      this.worldSetting = setting;
      this.drawing.invalidate();
    }
    return {
      setting,
      world: this.world ?? worldOf(setting),
      frame: frame?.generation === setting.generation ? frame : null,
      inspection: state?.inspection ?? null,
      map,
      shown,
      robot: state?.robot ?? null,
      selected: selected === null ? -1 : setting.robots.indexOf(selected),
      trails: this.trails,
      marked: this.host.marked,
      preview: this.preview,
    };
  }

  /** Sets the initial view: that of the address, or the whole world. */
  private initView({ size }: World): void {
    if (this.hasView) return;
    this.hasView = true;
    const { width, height } = this.camera;
    const { view } = this.host.link;
    this.camera = view
      ? { x: view[0], y: view[1], scale: view[2], width, height }
      : fitTo(size, width, height);
    this.host.camera = this.camera;
  }
}

/** What the nearest marker within a distance chooses; null if there is none. */
function choiceAt(shown: Shown | null, [x, y]: Point, within: number): Choose | null {
  const markers = Object.values(shown?.layers ?? {}).flatMap((layer) => layer.markers);
  const distances = markers.map(({ at, chooses }) => ({
    chooses,
    distance: Math.hypot(at[0] - x, at[1] - y),
  }));
  const near = distances.filter(({ chooses, distance }) => chooses !== null && distance <= within);
  near.sort((a, b) => a.distance - b.distance);
  return near[0]?.chooses ?? null;
}
