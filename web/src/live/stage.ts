import type { Frame } from "../net/frames";
import type { Point } from "../net/protocol";
import { rangesOf, robotAt } from "../run/robots";
import { type World, worldOf } from "../run/world";
import { type Camera, fitTo, pan, resize, toWorld, zoomAt } from "../view/camera";
import { type Colours, onThemeChange, readColours } from "../view/colours";
import { Gestures } from "../view/gestures";
import { type Painter, painterFor } from "../view/painter";
import { pixelRatio, Surface, sizeTo } from "../view/surface";
import type { Desk } from "./desk.svelte";
import { layers } from "./layers";
import type { Layer, Pen, Scene } from "./layers/layer";
import { Trails } from "./layers/trail_store";
import { Hand } from "./tools/hand";

export interface Canvases {
  still: HTMLCanvasElement;
  under: HTMLCanvasElement;
  robots: HTMLCanvasElement;
  over: HTMLCanvasElement;
}

const tapReach_px = 14;

/** The picture of the world: four canvases, of which those are drawn anew that have to be. */
export class Stage {
  private camera: Camera = { x: 0, y: 0, scale: 1, width: 1, height: 1 };
  private colours: Colours = readColours();
  private readonly surfaces: Record<Layer["place"], Surface>;
  private painter: Painter;
  private readonly trails = new Trails();
  private readonly hand: Hand;
  private world: World | null = null;
  private worldOf: unknown = null;
  private itemsKey = "";
  private wanted = false;
  private stillWanted = true;
  private fitted = false;
  private readonly undo: (() => void)[] = [];
  ghost: Path2D | null = null;

  constructor(
    private readonly element: HTMLElement,
    private readonly canvases: Canvases,
    private readonly desk: Desk,
  ) {
    const { still, under, over } = canvases;
    this.surfaces = { still: new Surface(still), under: new Surface(under), over: new Surface(over) };
    this.painter = painterFor(canvases.robots);
    this.hand = new Hand(desk, this);
    this.listen();
    this.recolour();
  }

  close(): void {
    for (const action of this.undo) action();
  }

  /** Draws soon; `still` too what only changes with view, setting or colours. */
  redraw(still = true): void {
    this.stillWanted ||= still;
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => this.draw());
  }

  look(camera: Camera): void {
    this.camera = camera;
    this.fitted = true;
    this.desk.camera = camera;
    this.redraw();
  }

  fit(): void {
    const { setting } = this.desk.session;
    if (setting) this.look(fitTo(worldOf(setting).size_m, this.camera.width, this.camera.height));
  }

  zoom(factor: number, at: Point = [this.camera.width / 2, this.camera.height / 2]): void {
    this.look(zoomAt(this.camera, ...at, factor));
  }

  pan(dx: number, dy: number): void {
    this.look(pan(this.camera, dx, dy));
  }

  /** All canvases in one, drawn just now: WebGL keeps no picture once it was shown. */
  flat(): HTMLCanvasElement | null {
    this.drawnFrame = null;
    this.stillWanted = true;
    this.draw();
    const { still } = this.canvases;
    const whole = new Surface(document.createElement("canvas"));
    [whole.canvas.width, whole.canvas.height] = [still.width, still.height];
    whole.context.fillStyle = this.colours.outside;
    whole.context.fillRect(0, 0, still.width, still.height);
    for (const canvas of Object.values(this.canvases)) {
      if (!canvas.hidden) whole.context.drawImage(canvas, 0, 0);
    }
    return whole.canvas;
  }

  /** Where in the world a pixel is, and how far a pointer reaches there. */
  place(at: Point): { at: Point; reach_m: number } {
    return { at: toWorld(this.camera, ...at), reach_m: tapReach_px / this.camera.scale };
  }

  /** Chooses the robot at a pixel, or none. */
  tap(at: Point): void {
    const { session } = this.desk;
    const { shown } = session.arrivals;
    if (!session.setting || !shown) return;
    const { at: place, reach_m } = this.place(at);
    const robot = robotAt(shown, session.setting, ...place, reach_m);
    session.select(session.setting.robots[robot] ?? null);
  }

  private listen(): void {
    const { element, hand, canvases } = this;
    const observer = new ResizeObserver(() => this.resized());
    observer.observe(element);
    const press = (at: Point) => hand.press(at);
    const drag = (at: Point) => hand.drag(at);
    const release = (at: Point) => hand.release(at);
    new Gestures(element, {
      press,
      drag,
      release,
      tap: (at) => this.tap(at),
      pan: (dx, dy) => this.pan(dx, dy),
      zoom: (at, factor) => this.zoom(factor, at),
    });
    canvases.robots.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvases.robots.addEventListener("webglcontextrestored", () => this.repaint());
    this.desk.session.onFrame = () => this.redraw(false);
    this.undo.push(
      () => observer.disconnect(),
      onThemeChange(() => this.recolour()),
    );
  }

  private repaint(): void {
    this.painter = painterFor(this.canvases.robots);
    this.recolour();
  }

  private recolour(): void {
    this.colours = readColours();
    this.painter.setColours(this.colours);
    this.drawnFrame = null;
    this.redraw();
  }

  private resized(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    for (const canvas of Object.values(this.canvases)) sizeTo(canvas, width, height);
    this.camera = resize(this.camera, width, height);
    this.drawnFrame = null;
    // Not `redraw`: a canvas is wiped by its new size, and must not be seen so.
    this.stillWanted = true;
    this.draw();
  }

  private drawnFrame: Frame | null = null;

  private draw(): void {
    this.wanted = false;
    const { setting, arrivals } = this.desk.session;
    if (!setting) return;
    const fresh = arrivals.take(setting.generation);
    const scene = this.scene();
    if (!scene) return;
    if (fresh) this.trails.put(fresh, scene.selected);
    this.frameView(scene);
    if (this.stillWanted || this.itemsChanged(scene)) this.drawPlace("still", scene);
    this.stillWanted = false;
    this.drawPlace("under", scene);
    this.drawRobots(scene);
    this.drawPlace("over", scene);
    if (!fresh) return;
    arrivals.drawn(fresh);
    this.desk.session.drew();
  }

  private drawRobots({ setting, frame }: Scene): void {
    if (!frame || frame.generation !== setting.generation) return this.painter.clear();
    this.painter.paint(frame, rangesOf(setting), this.camera, frame !== this.drawnFrame);
    this.drawnFrame = frame;
  }

  private drawPlace(place: Layer["place"], scene: Scene): void {
    const shown = layers.filter(
      (layer) => layer.place === place && this.desk.on[layer.id] && layer.active(scene),
    );
    const surface = this.surfaces[place];
    surface.show(shown.length > 0);
    if (shown.length === 0) return;
    surface.draw(pixelRatio(), (context) => {
      const pen: Pen = { context, camera: this.camera, colours: this.colours };
      for (const layer of shown) layer.draw(pen, scene);
    });
  }

  private scene(): Scene | null {
    const { setting, state, arrivals, selected } = this.desk.session;
    if (!setting) return null;
    if (this.worldOf !== setting) {
      this.world = worldOf(setting);
      this.worldOf = setting;
      this.stillWanted = true;
    }
    return {
      setting,
      world: this.world ?? worldOf(setting),
      frame: arrivals.shown?.generation === setting.generation ? arrivals.shown : null,
      mind: state?.mind ?? null,
      selected: selected === null ? -1 : setting.robots.indexOf(selected),
      trails: this.trails,
      ghost: this.ghost,
    };
  }

  /** The view that the address asks for, or all of the world. */
  private frameView({ world }: Scene): void {
    if (this.fitted || this.camera.width <= 1) return;
    this.fitted = true;
    const { width, height } = this.camera;
    const { view } = this.desk.link;
    this.camera = view
      ? { x: view[0], y: view[1], scale: view[2], width, height }
      : fitTo(world.size_m, width, height);
    this.desk.camera = this.camera;
  }

  private itemsChanged({ frame }: Scene): boolean {
    const key = frame ? frame.items.join("") : "";
    const changed = key !== this.itemsKey;
    this.itemsKey = key;
    return changed;
  }
}
