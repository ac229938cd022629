import { beliefMap, unseen } from "./belief_map";
import { border, ground } from "./border";
import { contact } from "./contact";
import { footprints } from "./footprints";
import { ghost } from "./preview";
import { grid } from "./grid";
import { items } from "./items";
import type { Layer } from "./layer";
import { links } from "./links";
import { looks } from "./observed_cells";
import { maps } from "./maps";
import { mind } from "./beliefs";
import { obstacles } from "./obstacles";
import { reach } from "./headings";
import { selection } from "./selection";
import { terrain } from "./terrain";
import { trails } from "./trails";

/** From the lowest to the highest, within their places. */
export const layers: Layer[] = [
  ground,
  terrain,
  grid,
  maps,
  obstacles,
  border,
  contact,
  items,
  beliefMap,
  unseen,
  footprints,
  looks,
  links,
  trails,
  reach,
  mind,
  selection,
  ghost,
];
