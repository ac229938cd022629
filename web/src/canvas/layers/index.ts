import { beliefMap, unseen } from "./belief_map";
import { beliefs } from "./beliefs";
import { border, ground } from "./border";
import { contact } from "./contact";
import { economy } from "./economy";
import { external } from "./external";
import { footprints } from "./footprints";
import { grid } from "./grid";
import { headings } from "./headings";
import { items } from "./items";
import { laneMarks, lanePath, laneRisk } from "./lane";
import type { Layer } from "./layer";
import { links } from "./links";
import { maps } from "./maps";
import { observedCells } from "./observed_cells";
import { obstacles } from "./obstacles";
import { passagePath, passageVehicles } from "./passage";
import { preview } from "./preview";
import { selection } from "./selection";
import { terrain } from "./terrain";
import { trails } from "./trails";

/** From bottom to top, within each place. */
export const layers: Layer[] = [
  ground,
  terrain,
  laneRisk,
  grid,
  maps,
  lanePath,
  passagePath,
  obstacles,
  border,
  contact,
  items,
  beliefMap,
  unseen,
  footprints,
  observedCells,
  links,
  trails,
  laneMarks,
  passageVehicles,
  economy,
  headings,
  beliefs,
  external,
  selection,
  preview,
];
