import type {
  Area,
  Fill,
  Glyph,
  Layer as LayerData,
  LayerPlace,
  Line,
  Marker,
  Point,
  Raster,
  Stroke,
} from "../../api/protocol";
import { toScreen } from "../camera";
import { rgb } from "../colours";
import { linesOf, radiusOf } from "../glyphs";
import { bytesOf, drawPicture, Pictures, squares } from "./cells";
import {
  imagesOf,
  inWorld,
  type Layer,
  outline,
  type Pen,
  poseOf,
  ring,
  type Scene,
  shortestWay,
  withinWorld,
} from "./layer";

const font = "12px system-ui, sans-serif";
const labelGap_px = 4;
const dash_px = [6, 4];
const bandOpacity = 0.3;

/** All layers of a place that the server has sent, whatever they show, in the order in which it offers them. */
export function dataLayers(place: LayerPlace): Layer {
  const shownIn = ({ setting, shown }: Scene): LayerData[] => {
    const offered = setting.offer.layers.filter((layer) => layer.place === place);
    return offered.flatMap(({ id }) => shown?.layers[id] ?? []);
  };
  return {
    id: `data-${place}`,
    place: place === "above" ? "over" : "still",
    active: (scene) => shownIn(scene).length > 0,
    draw(pen, scene) {
      for (const layer of shownIn(scene)) drawLayer(pen, scene, layer);
    },
  };
}

function drawLayer(pen: Pen, scene: Scene, layer: LayerData): void {
  const { context } = pen;
  clipped(pen, layer, () => {
    if (layer.raster) drawRaster(pen, layer.raster);
  });
  for (const area of layer.areas) alone(context, () => drawArea(pen, scene, area));
  clipped(pen, layer, () => {
    for (const line of layer.lines) alone(context, () => drawLine(pen, scene, line));
  });
  for (const marker of layer.markers) {
    const symbol = layer.symbols[marker.symbol] ?? [];
    alone(context, () => drawMarker(pen, scene, marker, symbol));
  }
}

/** Draws without an effect on what is drawn next. */
function alone(context: CanvasRenderingContext2D, draw: () => void): void {
  context.save();
  draw();
  context.restore();
}

function clipped(pen: Pen, { clip }: LayerData, draw: () => void): void {
  const { context, camera } = pen;
  alone(context, () => {
    const [low, high] = clip ?? [];
    if (low && high) {
      const [left, bottom] = toScreen(camera, ...low);
      const [right, top] = toScreen(camera, ...high);
      context.beginPath();
      context.rect(left, top, right - left, bottom - top);
      context.clip();
    }
    draw();
  });
}

const pictures = new Pictures<Raster>(
  ({ columns, rows, cells }) => ({ columns, rows, bytes: bytesOf(cells) }),
  (colours, { scale: { first, last, colours: names } }) => {
    const stops = names.map((name) => rgb(colours[name]));
    return (byte) => colourAt(stops, (byte - first) / (last - first));
  },
);

function drawRaster(pen: Pen, raster: Raster): void {
  drawPicture(pen, pictures.of(raster, pen.colours), squares(raster.corner, raster.cell));
}

/** The colour at a place between the first stop, 0, and the last, 1: four channels, 0 to 255. */
export function colourAt(stops: number[][], place: number): number[] {
  const along = Math.min(1, Math.max(0, place)) * (stops.length - 1);
  const first = Math.min(Math.floor(along), Math.max(0, stops.length - 2));
  const [low = [], high = low] = [stops[first], stops[first + 1]];
  const mixed = low.map((from, channel) => 255 * (from + (along - first) * ((high[channel] ?? from) - from)));
  return [...mixed, 255];
}

function drawArea(pen: Pen, scene: Scene, { polygon, circle, fill, outline: edge, opacity }: Area): void {
  const { context, camera } = pen;
  const path = new Path2D();
  if (circle) ring(path, carried(scene, circle), circle.radius);
  else outline(path, polygon);
  context.globalAlpha = opacity;
  inWorld(pen, () => {
    if (fill) fillPath(pen, fill, path);
    if (!edge) return;
    setStroke(pen, edge, 1 / camera.scale);
    context.stroke(path);
  });
}

/** The place of something that a robot may carry, which moves between two messages. */
function carried(scene: Scene, { at, robot }: { at: Point; robot: string | null }): Point {
  return (robot === null ? null : poseOf(scene, scene.setting.robots.indexOf(robot)))?.at ?? at;
}

function drawLine(pen: Pen, scene: Scene, line: Line): void {
  const { context, camera, colours } = pen;
  const { points, robot, stroke, band, opacity } = line;
  const path = robot === null ? pathOf(points) : pathFrom(scene, robot, points);
  if (!path) return;
  const isOfSelected = robot !== null && scene.setting.robots[scene.selected] === robot;
  const draw = robot === null ? inWorld : (pen: Pen, draw: () => void) => withinWorld(pen, scene, draw);
  draw(pen, () => {
    if (band !== null) {
      context.lineJoin = context.lineCap = "round";
      context.strokeStyle = colours[stroke.colour];
      context.lineWidth = band;
      context.globalAlpha = bandOpacity * opacity;
      context.stroke(path);
      context.lineCap = "butt";
    }
    context.globalAlpha = opacity;
    setStroke(pen, stroke, (isOfSelected ? 2 : 1) / camera.scale);
    context.stroke(path);
  });
}

function pathOf(points: Point[]): Path2D {
  const path = new Path2D();
  follow(path, points);
  return path;
}

function follow(path: Path2D, points: Point[]): void {
  points.forEach((at, i) => {
    if (i === 0) path.moveTo(...at);
    else path.lineTo(...at);
  });
}

/** The shortest way from a robot to a place, and its images in a periodic world; null without the robot. */
function pathFrom(scene: Scene, robot: string, [to]: Point[]): Path2D | null {
  const pose = poseOf(scene, scene.setting.robots.indexOf(robot));
  if (!pose || !to) return null;
  const [x, y] = shortestWay(scene, pose.at, to);
  const path = new Path2D();
  for (const [startX, startY] of imagesOf(scene, pose.at, Math.max(Math.abs(x), Math.abs(y)))) {
    path.moveTo(startX, startY);
    path.lineTo(startX + x, startY + y);
  }
  return path;
}

function drawMarker(pen: Pen, scene: Scene, marker: Marker, symbol: Glyph[]): void {
  const { context, camera } = pen;
  const at = toScreen(camera, ...carried(scene, marker));
  context.globalAlpha = marker.opacity;
  context.lineJoin = context.lineCap = "round";
  for (const glyph of symbol) drawGlyph(pen, at, glyph);
  if (marker.label === null) return;
  const radius = Math.max(0, ...symbol.map((glyph) => radiusOf(glyph, camera.scale)));
  drawLabel(pen, at, marker.label, radius + labelGap_px);
}

function drawGlyph(pen: Pen, at: Point, glyph: Glyph): void {
  const { context, camera, colours } = pen;
  const { closed, lines } = linesOf(glyph.shape, at, radiusOf(glyph, camera.scale));
  const path = new Path2D();
  for (const points of lines) {
    follow(path, points);
    if (closed) path.closePath();
  }
  if (glyph.outline && glyph.has_rim) {
    context.strokeStyle = colours.ground;
    context.lineWidth = glyph.outline.width_px + 3;
    context.stroke(path);
  }
  if (glyph.fill) fillPath(pen, glyph.fill, path);
  if (glyph.outline) {
    setStroke(pen, glyph.outline, 1);
    context.stroke(path);
  }
}

function fillPath({ context, colours }: Pen, { colour, opacity }: Fill, path: Path2D): void {
  alone(context, () => {
    context.fillStyle = colours[colour];
    context.globalAlpha *= opacity;
    context.fill(path);
  });
}

/** Sets how lines are drawn; `pixel` is the length of a pixel. */
function setStroke({ context, colours }: Pen, { colour, width_px, is_dashed }: Stroke, pixel: number): void {
  context.strokeStyle = colours[colour];
  context.lineWidth = width_px * pixel;
  context.setLineDash(is_dashed ? dash_px.map((length) => length * pixel) : []);
}

function drawLabel({ context, colours }: Pen, [x, y]: Point, text: string, right_px: number): void {
  context.globalAlpha = 1;
  context.font = font;
  context.textBaseline = "middle";
  context.lineWidth = 4;
  context.setLineDash([]);
  context.strokeStyle = colours.ground;
  context.strokeText(text, x + right_px, y);
  context.fillStyle = colours.text;
  context.fillText(text, x + right_px, y);
}
