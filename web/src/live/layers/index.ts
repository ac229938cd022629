import { beliefMap, unseen } from "./belief_map";
import { border, ground } from "./border";
import { footprints } from "./footprints";
import { ghost } from "./ghost";
import { grid } from "./grid";
import { items } from "./items";
import type { Layer } from "./layer";
import { links } from "./links";
import { maps } from "./maps";
import { mind } from "./mind";
import { obstacles } from "./obstacles";
import { reach } from "./reach";
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
  items,
  beliefMap,
  unseen,
  footprints,
  links,
  trails,
  reach,
  mind,
  selection,
  ghost,
];
