import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Points } from "./csv";
import { labelsOf, type Line } from "./lines";

/** A line and its points. */
export interface Drawn {
  line: Line;
  points: Points;
}

/** What a chart displays. */
export interface Content {
  lines: Drawn[];
  step_s: number;
  /** The time of the run, drawn as a vertical line. */
  now_s: number;
}

/** Lines over time, with one axis on each side. */
export class Chart {
  private plot: uPlot;
  private shape = "";
  private content: Content = { lines: [], step_s: 1, now_s: 0 };
  private readonly observer: ResizeObserver;

  constructor(
    private readonly element: HTMLElement,
    private readonly height_px: number,
    private readonly go: (time_s: number) => void,
  ) {
    this.plot = this.build();
    this.observer = new ResizeObserver(() => this.plot.setSize(this.size()));
    this.observer.observe(element);
  }

  /** Draws other content. */
  show(content: Content): void {
    this.content = content;
    const shape = JSON.stringify(content.lines.map(({ line }) => line));
    if (shape === this.shape) this.plot.setData(this.data());
    else {
      this.shape = shape;
      this.rebuild();
    }
  }

  /** Redraws with the current theme's colours. */
  rebuild(): void {
    this.plot.destroy();
    this.plot = this.build();
  }

  close(): void {
    this.observer.disconnect();
    this.plot.destroy();
  }

  private build(): uPlot {
    const style = getComputedStyle(document.documentElement);
    const colour = (name: string) => style.getPropertyValue(`--${name}`).trim();
    const { lines } = this.content;
    const axis = {
      stroke: colour("muted"),
      grid: { stroke: colour("line"), width: 1 },
      ticks: { stroke: colour("line") },
    };
    const side = (name: "left" | "right"): uPlot.Axis => ({
      ...axis,
      scale: name,
      side: name === "left" ? 3 : 1,
      values: (_, marks, __, ___, distance) => labelsOf(marks, distance),
      size: (_, labels) => Math.max(52, 16 + 7 * Math.max(0, ...(labels ?? []).map(({ length }) => length))),
      show: lines.some(({ line }) => line.axis === name) || (name === "left" && lines.length === 0),
      ...(name === "right" ? { grid: { show: false } } : {}),
    });
    return new uPlot(
      {
        ...this.size(),
        legend: { show: false },
        cursor: { y: false, drag: { x: false, y: false } },
        scales: { x: { time: false }, left: { range: padded }, right: { range: padded } },
        axes: [
          { ...axis, values: (_, marks) => marks.map((mark) => `${mark} s`) },
          side("left"),
          side("right"),
        ],
        series: [
          {},
          ...lines.map(({ line }) => ({
            label: line.label,
            scale: line.axis,
            stroke: colour(line.colour),
            width: 2,
            points: { show: false },
            spanGaps: false,
            ...(uPlot.paths.stepped ? { paths: uPlot.paths.stepped({ align: 1 }) } : {}),
            ...(line.isDashed ? { dash: [6, 3] } : {}),
          })),
        ],
        hooks: {
          draw: [(plot) => this.drawNow(plot, colour("text"))],
          ready: [(plot) => this.seekOnClick(plot)],
        },
      },
      this.data(),
      this.element,
    );
  }

  private drawNow(plot: uPlot, stroke: string): void {
    const { context, left, top, height, width } = { context: plot.ctx, ...plot.bbox };
    const x = plot.valToPos(this.content.now_s, "x", true);
    if (!(x >= left && x <= left + width)) return;
    context.save();
    context.strokeStyle = stroke;
    context.lineWidth = devicePixelRatio;
    context.setLineDash([]);
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, top + height);
    context.stroke();
    context.restore();
  }

  private seekOnClick(plot: uPlot): void {
    plot.over.addEventListener("click", () => {
      const { left } = plot.cursor;
      if (left !== undefined && left >= 0) this.go(plot.posToVal(left, "x"));
    });
  }

  private size() {
    return { width: Math.max(160, this.element.clientWidth), height: this.height_px };
  }

  private data(): uPlot.AlignedData {
    const { lines, step_s } = this.content;
    if (lines.length === 0) return [[]];
    const tables = lines.map(({ points }): uPlot.AlignedData => [
      points.ticks.map((tick) => tick * step_s),
      points.values,
    ]);
    // Between the points of a line, other lines may have some: it continues there.
    return tables.length === 1 && tables[0] ? tables[0] : uPlot.join(tables);
  }
}

/** A range with some space around it; also for a constant. */
function padded(_: uPlot, low: number | null, high: number | null): uPlot.Range.MinMax {
  if (low === null || high === null) return [0, 1];
  const space = high > low ? 0.06 * (high - low) : Math.max(0.5, 0.1 * Math.abs(high));
  return [low >= 0 && low - space < 0 ? 0 : low - space, high + space];
}
