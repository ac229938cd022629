import type { Pose, Reach } from "../../api/protocol";
import { mixed, placeOf, worths } from "../headings";
import { toScreen } from "../camera";
import { type Layer, type Pen } from "./layer";

/** What the places that the selected robot can get to are worth to it, and which way it takes. */
export const reach: Layer = {
  id: "reach",
  label: "Worth of places",
  switchable: true,
  on: true,
  place: "over",
  only: "metric",
  active: ({ mind, selected }) => selected >= 0 && !!mind?.thoughts?.reach,
  draw(pen, { mind, setting, selected }) {
    const thoughts = mind?.robot === setting.robots[selected] ? mind?.thoughts : null;
    if (thoughts?.pose && thoughts.reach) courses(pen, thoughts.pose, thoughts.reach);
  },
};

/** Better places are stronger in colour and greater, so that neither has to be told from the other alone. */
function courses({ context, camera, colours }: Pen, pose: Pose, told: Reach): void {
  const shares = worths(told);
  const from = toScreen(camera, ...pose.at);
  told.courses.forEach((course, i) => {
    const share = shares[i] ?? 0;
    const to = toScreen(camera, ...placeOf(pose, course.at));
    const isTaken = i === told.taken;
    context.strokeStyle = context.fillStyle = mixed(colours["reach-low"], colours["reach-high"], share);
    context.lineWidth = isTaken ? 3 : 1;
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    context.stroke();
    context.beginPath();
    context.arc(...to, 1.5 + 2.5 * share, 0, 2 * Math.PI);
    context.fill();
    if (!isTaken) return;
    context.strokeStyle = colours.text;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(...to, 7, 0, 2 * Math.PI);
    context.stroke();
  });
}
