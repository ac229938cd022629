import { beliefMap, unseen } from "./belief_map";
import { beliefs } from "./beliefs";
import { border, ground } from "./border";
import { contact } from "./contact";
import { dataLayers } from "./data";
import { external } from "./external";
import { footprints } from "./footprints";
import { grid } from "./grid";
import { headings } from "./headings";
import { items } from "./items";
import type { Layer } from "./layer";
import { links } from "./links";
import { maps } from "./maps";
import { observedCells } from "./observed_cells";
import { obstacles } from "./obstacles";
import { place } from "./place";
import { preview } from "./preview";
import { selection } from "./selection";
import { terrain } from "./terrain";
import { trails } from "./trails";

/** From bottom to top, within each place. What is not the world or its robots is data of the server. */
export const layers: Layer[] = [
  ground,
  terrain,
  dataLayers("ground"),
  grid,
  maps,
  dataLayers("below"),
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
  dataLayers("above"),
  headings,
  beliefs,
  external,
  place,
  selection,
  preview,
];
