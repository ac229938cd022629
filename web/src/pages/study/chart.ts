import embed, { type Result, type VisualizationSpec } from "vega-embed";
import { expressionInterpreter } from "vega-interpreter";
import "./chart.css";
import type { Spec } from "../../api/study";

/** A chart of the report, drawn again whenever it gets another width. */
export class Chart {
  private drawn: Result | null = null;
  private width_px = 0;
  /** Drawings follow each other: one begins when the last is done. */
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

  /** Draws it in the colours that hold now. */
  draw(): void {
    this.width_px = this.element.clientWidth;
    this.last = this.last.then(() => this.again());
  }

  close(): void {
    this.observer.disconnect();
    void this.last.then(() => this.drawn?.finalize());
  }

  private async again(): Promise<void> {
    this.drawn?.finalize();
    this.drawn = await embed(this.element, this.spec as VisualizationSpec, this.options());
    this.drawn.view.addEventListener("click", (_, item) => {
      const { configuration } = (item?.datum ?? {}) as { configuration?: unknown };
      if (typeof configuration === "number") this.open(configuration);
    });
  }

  private options() {
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    return {
      actions: false,
      renderer: "svg" as const,
      // Expressions are interpreted: the page's policy allows no code made at run time, and no styles.
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
