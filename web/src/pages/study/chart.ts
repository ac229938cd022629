import embed, { type Result, type VisualizationSpec } from "vega-embed";
import { expressionInterpreter } from "vega-interpreter";
import "./chart.css";
import type { Spec } from "../../api/study";

/** A chart of the report, redrawn when its width changes. */
export class Chart {
  private drawn: Result | null = null;
  private width_px = 0;
  private isAll = false;
  /** Serialises drawing: each starts after the previous one. */
  private last: Promise<void> = Promise.resolve();
  private readonly observer: ResizeObserver;

  /** `open` is called with the configuration of a mark that is clicked. */
  constructor(
    private readonly element: HTMLElement,
    private readonly spec: Spec,
    private readonly open: (configuration: number) => void,
  ) {
    this.observer = new ResizeObserver(() => {
      if (this.element.clientWidth !== this.width_px) this.draw();
    });
    this.observer.observe(element);
  }

  /** Draws the chart with the current theme's colours. */
  draw(): void {
    this.width_px = this.element.clientWidth;
    this.last = this.last.then(() => this.redraw());
  }

  /** Scales the chart to all configurations, or to the contenders; only if it can be switched. */
  scaleTo(isAll: boolean): void {
    this.isAll = isAll;
    this.last = this.last.then(() => this.rescale());
  }

  close(): void {
    this.observer.disconnect();
    void this.last.then(() => this.drawn?.finalize());
  }

  private async redraw(): Promise<void> {
    this.drawn?.finalize();
    this.drawn = await embed(this.element, this.spec as VisualizationSpec, this.options());
    this.drawn.view.addEventListener("click", (_, item) => {
      const { configuration } = (item?.datum ?? {}) as { configuration?: unknown };
      if (typeof configuration === "number") this.open(configuration);
    });
    if (this.isAll) await this.rescale();
  }

  private async rescale(): Promise<void> {
    await this.drawn?.view.signal("all_teams", this.isAll).runAsync();
  }

  private options() {
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    return {
      actions: false,
      renderer: "svg" as const,
      // The content security policy forbids generated code and inline styles, so expressions are interpreted.
      ast: true,
      expr: expressionInterpreter,
      defaultStyle: false,
      tooltip: { theme: isDark ? "dark" : "light", disableDefaultStyle: true },
      config: {
        axisY: { labelLimit: Math.max(90, 0.36 * this.width_px) },
        legend: this.width_px < 480 ? { columns: 1 } : {},
      },
    };
  }
}
