/** The passage of a mined lane by vehicles, and the share of its mines that are cleared, in words. */
import type { ClearedView, PassageView, Setting, VehicleView } from "../api/protocol";
import { plural } from "./format";
import { percent } from "./lane";

/** Whether vehicles of a run are to pass its lane. */
export function hasPassage({ document }: Setting): boolean {
  return "passage" in document;
}

/** Such as `98.7% (95% interval 91.2% to 100%)`. */
export function clearedLabel({ share, low, high }: ClearedView): string {
  const [of, from, to] = [share, low, high].map((value) => `${Number((100 * value).toFixed(1))}%`);
  return `${of} (95% interval ${from} to ${to})`;
}

/** The risk of the first and of the last vehicle, such as `First vehicle 0.31%, last of 3 0.05%.` */
export function passageLabel({ risks }: PassageView): string {
  const [first = 0] = risks;
  const last = risks.at(-1) ?? 0;
  const of = risks.length > 1 ? `, last of ${risks.length} ${percent(last)}` : "";
  return `Risk of the first vehicle ${percent(first)}${of}.`;
}

/** Such as `Path of 200 m, 3 m wide: 0.0042 mines expected in it.` */
export function pathLabel({ length_m, width_m, mines }: PassageView): string {
  const number = (value: number) => String(Number(value.toPrecision(3)));
  return `Path of ${number(length_m)} m, ${number(width_m)} m wide: ${number(mines)} mines expected in it.`;
}

/** What has become of the vehicles, such as `2 vehicles passed, 1 lost (the first).` */
export function vehiclesLabel(vehicles: VehicleView[]): string {
  const count = (status: VehicleView["status"]) => vehicles.filter((each) => each.status === status).length;
  const [driving, passed, lost] = [count("driving"), count("passed"), count("lost")];
  const isFirst = vehicles[0]?.status === "lost" ? " (with the first)" : "";
  const rest = driving > 0 ? `, ${driving} driving` : "";
  return `${plural(passed, "vehicle")} passed, ${lost} lost${lost > 0 ? isFirst : ""}${rest}.`;
}
