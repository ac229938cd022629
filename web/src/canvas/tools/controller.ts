import type { Point } from "../../api/protocol";
import { worldOf } from "../../shared/world";
import type { Host } from "../host";
import { toolOf } from ".";
import type { EditContext, Tool } from "./tool";

/** The part of the stage that tools need. */
interface ToolStage {
  preview: Path2D | null;
  place(at: Point): { at: Point; tolerance: number };
  redraw(still?: boolean): void;
}

/** Passes pointer events to the chosen tool and sends its edits. */
export class ToolController {
  private current: { tool: Tool; context: EditContext; from: Point } | null = null;

  constructor(
    private readonly host: Host,
    private readonly stage: ToolStage,
  ) {}

  press(at: Point): boolean {
    const { setting } = this.host.session;
    const tool = toolOf(this.host.tool);
    if (!tool || !setting) return false;
    const { at: from, tolerance } = this.stage.place(at);
    const context = { setting, world: worldOf(setting), tolerance, itemKind: this.host.itemKind };
    this.current = tool.canStart(context, from) ? { tool, context, from } : null;
    if (this.current) this.drag(at);
    return this.current !== null;
  }

  drag(at: Point): void {
    if (!this.current) return;
    const { tool, context, from } = this.current;
    this.show(tool.preview(context, from, this.stage.place(at).at));
  }

  release(at: Point): void {
    if (!this.current) return;
    const { tool, context, from } = this.current;
    this.current = null;
    this.show(null);
    const edit = tool.edit(context, from, this.stage.place(at).at);
    if (edit) this.host.session.change(edit.path, edit.value);
  }

  /** Cancels the current edit; false if there is none. */
  cancel(): boolean {
    const isEditing = this.current !== null;
    this.current = null;
    this.show(null);
    return isEditing;
  }

  private show(preview: Path2D | null): void {
    this.stage.preview = preview;
    this.stage.redraw(false);
  }
}
