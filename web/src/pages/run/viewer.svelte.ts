import type { StudyConfiguration } from "../../api/protocol";
import { runsOf } from "../../api/studies";
import type { Link } from "../../shared/link";
import { Session } from "./session.svelte";
import type { Camera } from "../../canvas/camera";
import { layers } from "../../canvas/layers";
import type { Host } from "../../canvas/host";
import type { Stage } from "../../canvas/stage";
import type { ToolId } from "../../canvas/tools";

export const speeds = [0.1, 0.5, 1, 2, 10, 100, null] as const;

/** A run on the page, and how it is displayed. */
export class Viewer implements Host {
  readonly session: Session;
  layers = $state<Record<string, boolean>>(
    Object.fromEntries(layers.map((layer) => [layer.id, layer.switch?.on ?? true])),
  );
  tool = $state<ToolId>("select");
  /** The kind that the item tool places. */
  itemKind = $state("");
  /** The panel that is open. */
  panel = $state("");
  /** The controller whose goals stand out; null for those of all. */
  controller = $state<string | null>(null);
  /** The controller whose belief of the mined lane is shown; null for the first. */
  laneController = $state<string | null>(null);
  /** Whether each section of the robot panel is open. */
  sections = $state({
    command: true,
    serves: true,
    percept: true,
    goals: true,
    headings: false,
    items: true,
    map: false,
  });
  /** Playback speed; null for the maximum. */
  speed = $state<number | null>(1);
  /** Whether the view follows the selected robot. */
  follows = $state(false);
  camera = $state.raw<Camera | null>(null);
  stage: Stage | null = null;
  /** The label of the study's configuration, once it is loaded. */
  private label = $state("");

  constructor(
    readonly link: Link,
    text: string | null,
  ) {
    this.session = new Session({ ...link, text });
    if (link.study) void this.loadLabel(link.study);
  }

  /** Such as `Run 12 of classic, 3 wanderers`; null if the run does not belong to a study. */
  get studyTitle(): string | null {
    const { study, run } = this.link;
    if (!study) return null;
    // The study is named after its scenario; the folder of a second study of a scenario has another name.
    const name = this.session.opened?.scenario.name ?? study.id;
    return `Run ${run} of ${name}, ${this.label || `configuration ${study.configuration}`}`;
  }

  chooseController(name: string): void {
    this.controller = name;
  }

  toggle(): void {
    const { session } = this;
    if (session.isAdvancing) session.pause();
    else session.play(this.speed);
  }

  setSpeed(speed: number | null): void {
    this.speed = speed;
    if (this.session.state?.is_playing) this.session.play(speed);
  }

  private async loadLabel({ id, configuration }: StudyConfiguration): Promise<void> {
    // If this fails, the title shows the configuration's number; the connection reports a missing server.
    const runs = await runsOf(id, configuration, 0, 1).catch(() => null);
    if (runs) this.label = runs.label;
  }

  /** The seed; null until the server has sent that of a study or of the live run. */
  get seed(): string | null {
    return this.session.opened?.seed ?? this.link.seed;
  }

  /** Seed and run number; for a study, the run number is in the title. */
  get subtitle(): string {
    const { study, recording, live } = this.link;
    if (live) return this.session.opened ? `live, seed ${this.seed}` : "live";
    const { run } = this.session.opened ?? this.link;
    return `seed ${this.seed ?? "…"}${study ? "" : `, run ${run}`}${recording === null ? "" : ", recorded"}`;
  }

  /** The link of the current view. */
  get currentLink(): Link {
    const { setting, tick, selected } = this.session;
    const { camera, link } = this;
    const round = (value: number) => Number(value.toFixed(3));
    return {
      ...link,
      seed: this.seed,
      changes: setting ? setting.log : link.changes,
      tick,
      view: camera ? [round(camera.x), round(camera.y), round(camera.scale)] : link.view,
      robot: selected,
    };
  }
}
