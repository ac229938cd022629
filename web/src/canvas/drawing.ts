import type { Frame } from "../api/frames";
import { rangesOf } from "../shared/robots";
import type { Box } from "./backdrop";
import { type Camera, toScreen } from "./camera";
import { type Colours, readColours } from "./colours";
import type { Painter } from "./painter";
import { painterFor } from "./painters";
import { pixelRatio, Surface, sizeTo } from "./surface";
import { layers } from "./layers";
import type { Layer, Pen, Scene } from "./layers/layer";

export interface Canvases {
  robots: HTMLCanvasElement;
  over: HTMLCanvasElement;
}

/** Whether each layer is shown, by id. */
export type Shown = Record<string, boolean>;

/** Draws a scene on two canvases and redraws only what has changed. */
export class Drawing {
  private readonly still = new Surface(document.createElement("canvas"), true);
  private readonly over: Surface;
  private painter: Painter;
  private colours: Colours = readColours();
  private drawn: Frame | null = null;
  private isStale = true;
  private items = "";

  constructor(private readonly canvases: Canvases) {
    const { robots, over } = canvases;
    this.painter = painterFor(robots);
    this.over = new Surface(over, this.painter.isSoftware);
    this.recolour();
    robots.addEventListener("webglcontextlost", (event) => event.preventDefault());
    robots.addEventListener("webglcontextrestored", () => {
      this.painter = painterFor(robots);
      this.recolour();
    });
  }

  /** Marks the still layers as out of date. */
  invalidate(): void {
    this.isStale = true;
  }

  recolour(): void {
    this.colours = readColours();
    this.painter.setColours(this.colours);
    this.reset();
  }

  resize(width: number, height: number): void {
    const { robots, over } = this.canvases;
    for (const canvas of [this.still.canvas, robots, over]) sizeTo(canvas, width, height);
    this.reset();
  }

  draw(scene: Scene, camera: Camera, shown: Shown): void {
    if (scene.frame !== this.drawn) this.checkItems(scene.frame);
    if (this.isStale) this.drawStill(scene, camera, shown);
    this.isStale = false;
    this.painter.paint(scene.frame, rangesOf(scene.setting), camera, scene.frame !== this.drawn);
    this.drawn = scene.frame;
    this.drawOver(scene, camera, shown);
  }

  /** Both canvases in one. Must follow a draw in the same task, as WebGL discards its buffer afterwards. */
  snapshot(): HTMLCanvasElement {
    const { robots, over } = this.canvases;
    const whole = new Surface(document.createElement("canvas"));
    [whole.canvas.width, whole.canvas.height] = [robots.width, robots.height];
    whole.context.drawImage(robots, 0, 0);
    if (!over.hidden) whole.context.drawImage(over, 0, 0);
    return whole.canvas;
  }

  private reset(): void {
    this.isStale = true;
    this.drawn = null;
  }

  private drawStill(scene: Scene, camera: Camera, shown: Shown): void {
    const { still, colours } = this;
    still.draw(pixelRatio(), (context) => {
      context.fillStyle = colours.outside;
      context.fillRect(0, 0, camera.width, camera.height);
      this.drawLayers("still", { context, camera, colours }, scene, shown);
    });
    this.painter.setStill(still.context, groundBox(camera, scene));
  }

  private drawOver(scene: Scene, camera: Camera, shown: Shown): void {
    const isActive = layers.some((layer) => isShown(layer, "over", scene, shown));
    this.over.show(isActive);
    if (!isActive) return;
    this.over.draw(pixelRatio(), (context) =>
      this.drawLayers("over", { context, camera, colours: this.colours }, scene, shown),
    );
  }

  private drawLayers(place: Layer["place"], pen: Pen, scene: Scene, shown: Shown): void {
    for (const layer of layers) {
      if (!isShown(layer, place, scene, shown)) continue;
      pen.context.save();
      layer.draw(pen, scene);
      pen.context.restore();
    }
  }

  /** Items belong to the still layers; their state changes only when they are found or destroyed. */
  private checkItems(frame: Frame | null): void {
    const items = frame?.items.join("") ?? "";
    if (items !== this.items) this.isStale = true;
    this.items = items;
  }
}

function isShown(layer: Layer, place: Layer["place"], scene: Scene, shown: Shown): boolean {
  return layer.place === place && shown[layer.id] === true && layer.active(scene);
}

/** The pixels that are entirely ground; partly covered ones are excluded. */
function groundBox(camera: Camera, { world }: Scene): Box {
  const ratio = pixelRatio();
  const clamp = (value: number, max: number) => Math.min(max, Math.max(0, value));
  const [left, top] = toScreen(camera, 0, world.size[1]).map((value) => Math.ceil(value * ratio));
  const [right, bottom] = toScreen(camera, world.size[0], 0).map((value) => Math.floor(value * ratio));
  const [width, height] = [camera.width * ratio, camera.height * ratio];
  const [x, y] = [clamp(left ?? 0, width), clamp(top ?? 0, height)];
  return [x, y, Math.max(0, clamp(right ?? 0, width) - x), Math.max(0, clamp(bottom ?? 0, height) - y)];
}
