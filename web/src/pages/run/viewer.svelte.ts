import type { OfStudy } from "../../api/protocol";
import { runsOf } from "../../api/studies";
import type { Link } from "../../shared/link";
import { Session } from "./session.svelte";
import type { Camera } from "../../canvas/camera";
import { layers } from "../../canvas/layers";
import type { Host } from "../../canvas/host";
import type { Stage } from "../../canvas/stage";
import type { ToolId } from "../../canvas/tools";

export const speeds = [0.1, 0.5, 1, 2, 10, 100, null] as const;

/** What lies on the viewer of one who watches a run: the run itself, and how it is looked at. */
export class Viewer implements Host {
  readonly session: Session;
  layers = $state<Record<string, boolean>>(Object.fromEntries(layers.map((layer) => [layer.id, layer.on])));
  tool = $state<ToolId>("select");
  /** The kind that the item tool places. */
  itemKind = $state("");
  /** Which sections of the robot's panel are open. */
  sections = $state({ command: true, percept: true, goals: true, reach: false, items: true, map: false });
  /** Speed of the next play. */
  speed = $state<number | null>(1);
  /** Whether the selected robot stays in the middle of the picture. */
  follows = $state(false);
  camera = $state.raw<Camera | null>(null);
  stage: Stage | null = null;
  /** What the configuration of a study is called, once the server has said so. */
  private label = $state("");

  constructor(
    readonly link: Link,
    text: string | null,
  ) {
    this.session = new Session({ ...link, text });
    if (link.study) void this.ask(link.study);
  }

  /** Such as `Run 12 of classic, 3 wanderers`; null if the run is of no study. */
  get studied(): string | null {
    const { study, run } = this.link;
    if (!study) return null;
    const name = study.id.split("/").at(-1) ?? study.id;
    return `Run ${run} of ${name}, ${this.label || `configuration ${study.configuration}`}`;
  }

  toggle(): void {
    const { session } = this;
    if (session.isGoing) session.pause();
    else session.play(this.speed);
  }

  setSpeed(speed: number | null): void {
    this.speed = speed;
    if (this.session.state?.playing) this.session.play(speed);
  }

  private async ask({ id, configuration }: OfStudy): Promise<void> {
    // Without an answer the number of the configuration stands; that the server is gone is said by the line.
    const said = await runsOf(id, configuration, 0, 1).catch(() => null);
    if (said) this.label = said.label;
  }

  /** Of all chance in the run; null until the server has told that of the study. */
  get seed(): string | null {
    return this.session.opened?.seed ?? this.link.seed;
  }

  /** Which run it is, for people; that of a study is in the title. */
  get which(): string {
    const { study, recording } = this.link;
    const { run } = this.session.opened ?? this.link;
    return `seed ${this.seed ?? "…"}${study ? "" : `, run ${run}`}${recording === null ? "" : ", recorded"}`;
  }

  /** The address of what is seen now. */
  get now(): Link {
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
