import type { Point } from "../../api/protocol";
import { worldOf } from "../../shared/world";
import type { Host } from "../host";
import { toolOf } from ".";
import type { Bench, Tool } from "./tool";

/** The picture, as far as tools need it. */
interface Picture {
  ghost: Path2D | null;
  place(at: Point): { at: Point; reach: number };
  redraw(still?: boolean): void;
}

/** Carries out with the chosen tool what the pointer does. */
export class ToolController {
  private grip: { tool: Tool; bench: Bench; from: Point } | null = null;

  constructor(
    private readonly host: Host,
    private readonly picture: Picture,
  ) {}

  press(at: Point): boolean {
    const { setting } = this.host.session;
    const tool = toolOf(this.host.tool);
    if (!tool || !setting) return false;
    const { at: from, reach } = this.picture.place(at);
    const bench = { setting, world: worldOf(setting), reach, itemKind: this.host.itemKind };
    this.grip = tool.grips(bench, from) ? { tool, bench, from } : null;
    if (this.grip) this.drag(at);
    return this.grip !== null;
  }

  drag(at: Point): void {
    if (!this.grip) return;
    const { tool, bench, from } = this.grip;
    this.show(tool.ghost(bench, from, this.picture.place(at).at));
  }

  release(at: Point): void {
    if (!this.grip) return;
    const { tool, bench, from } = this.grip;
    this.grip = null;
    this.show(null);
    const edit = tool.edit(bench, from, this.picture.place(at).at);
    if (edit) this.host.session.change(edit.path, edit.value);
  }

  /** Lets go without doing anything; true if there was something in hand. */
  drop(): boolean {
    const held = this.grip !== null;
    this.grip = null;
    this.show(null);
    return held;
  }

  private show(ghost: Path2D | null): void {
    this.picture.ghost = ghost;
    this.picture.redraw(false);
  }
}
