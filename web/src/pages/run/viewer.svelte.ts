import type { Choose, LayerOffer, Point, ShowRequest, StudyConfiguration } from "../../api/protocol";
import { runsOf } from "../../api/studies";
import type { Link } from "../../shared/link";
import { Charts } from "./charts/charts.svelte";
import { Session } from "./session.svelte";
import { Timeline } from "./timeline/timeline.svelte";
import type { Camera } from "../../canvas/camera";
import { layers } from "../../canvas/layers";
import type { Host } from "../../canvas/host";
import type { Stage } from "../../canvas/stage";
import type { ToolId } from "../../canvas/tools";

export const speeds = [0.1, 0.5, 1, 2, 10, 100, null] as const;

/** A run on the page, and how it is displayed. */
export class Viewer implements Host {
  readonly session: Session;
  readonly timeline: Timeline;
  readonly charts: Charts;
  layers = $state<Record<string, boolean>>(
    Object.fromEntries(layers.map((layer) => [layer.id, layer.switch?.on ?? true])),
  );
  tool = $state<ToolId>("select");
  /** The kind that the item tool places. */
  itemKind = $state("");
  /** The label of the panel that is open. */
  panel = $state("Results");
  /** What has been chosen in panels and with markers, by key. */
  choices = $state<Record<string, string>>({});
  /** Whether each section of the robot panel is open. */
  sections = $state({
    command: true,
    percept: true,
    goals: true,
    headings: false,
    items: true,
    map: false,
  });
  /** The same for the sections that the server offers, by id; left out: open. */
  offeredSections = $state<Record<string, boolean>>({});
  /** Playback speed; null for the maximum. */
  speed = $state<number | null>(1);
  /** Whether the view follows the selected robot. */
  follows = $state(false);
  /** The place that is marked in the view. */
  marked = $state.raw<Point | null>(null);
  camera = $state.raw<Camera | null>(null);
  stage: Stage | null = null;
  /** The label of the study's configuration, once it is loaded. */
  private label = $state("");

  constructor(
    readonly link: Link,
    text: string | null,
  ) {
    this.session = new Session({ ...link, text });
    this.timeline = new Timeline(this.session);
    this.charts = new Charts(this.session);
    this.charts.choose(link.charts);
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

  choose({ key, value, panel }: Choose): void {
    if (this.choices[key] === value) delete this.choices[key];
    else this.choices[key] = value;
    this.panel = this.session.setting?.offer.panels.find(({ id }) => id === panel)?.label ?? this.panel;
  }

  /** Centres the view on a place and marks it, or takes the mark away. */
  mark(at: Point): void {
    this.marked = this.isMarked(at) ? null : at;
    if (this.marked) this.stage?.centre(at);
  }

  isMarked([x, y]: Point): boolean {
    return this.marked?.[0] === x && this.marked[1] === y;
  }

  /** Whether a layer that the server offers is on. */
  isOn({ id, is_on }: LayerOffer): boolean {
    return this.layers[id] ?? is_on;
  }

  /** What is drawn and displayed, of what the server sends on request. */
  get request(): ShowRequest {
    const { layers = [], panels = [] } = this.session.setting?.offer ?? {};
    const overlays = ["links", "footprints"].filter((id) => this.layers[id]);
    const isOpen = (label: string, isOfRobot: boolean) => this.panel === (isOfRobot ? "Robot" : label);
    return {
      layers: [...overlays, ...layers.filter((layer) => this.isOn(layer)).map(({ id }) => id)],
      panels: panels.filter(({ label, is_of_robot }) => isOpen(label, is_of_robot)).map(({ id }) => id),
      choices: this.choices,
    };
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
      charts: this.charts.chosen,
    };
  }
}
