import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";
import type { Series } from "../series";

const height_px = 220;

/** Items found and collisions over time. */
export class Chart {
  private plot: uPlot;
  private shown = -1;
  private readonly observer: ResizeObserver;

  constructor(
    private readonly element: HTMLElement,
    private readonly series: () => Series,
  ) {
    this.plot = this.build();
    this.observer = new ResizeObserver(() => this.plot.setSize(this.size()));
    this.observer.observe(element);
  }

  /** Redraws if the series has grown since the last call. */
  update(grown: number): void {
    if (grown === this.shown) return;
    this.shown = grown;
    this.plot.setData(this.data());
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
    const axis = {
      stroke: colour("muted"),
      grid: { stroke: colour("line"), width: 1 },
      ticks: { stroke: colour("line") },
    };
    const line = (label: string, name: string, dash?: number[]): uPlot.Series => ({
      label,
      stroke: colour(name),
      width: 2,
      paths: uPlot.paths.stepped?.({ align: 1 }),
      points: { show: false },
      ...(dash ? { dash } : {}),
    });
    return new uPlot(
      {
        ...this.size(),
        legend: { live: false },
        cursor: { y: false },
        scales: { x: { time: false }, y: { range: (_, __, most) => [0, Math.max(1, most * 1.1)] } },
        axes: [
          { ...axis, values: (_, marks) => marks.map((mark) => `${mark} s`) },
          { ...axis, size: 36, incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 1e4, 1e5] },
        ],
        series: [{}, line("found", "item-found"), line("collisions", "robot-collided", [6, 3])],
      },
      this.data(),
      this.element,
    );
  }

  private size() {
    return { width: Math.max(160, this.element.clientWidth), height: height_px };
  }

  private data(): uPlot.AlignedData {
    const { rows } = this.series();
    const column = (name: string) => rows.map((row) => row.values[name] ?? null);
    return [rows.map((row) => row.time_s), column("found"), column("collisions")];
  }
}
