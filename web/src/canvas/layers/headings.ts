import type { HeadingOptions, Pose } from "../../api/protocol";
import { mixColours, relativeUtilities, toWorldFrame } from "../headings";
import { toScreen } from "../camera";
import { type Layer, type Pen } from "./layer";

/** The heading options of the selected robot, coloured by utility, with the chosen one marked. */
export const headings: Layer = {
  id: "headings",
  switch: { label: "Heading options", on: true },
  place: "over",
  only: "metric",
  active: ({ inspection, selected }) => selected >= 0 && !!inspection?.belief_state?.heading_options,
  draw(pen, { inspection, setting, selected }) {
    const beliefState = inspection?.robot === setting.robots[selected] ? inspection?.belief_state : null;
    const options = beliefState?.heading_options;
    if (beliefState?.pose && options) drawOptions(pen, beliefState.pose, options);
  },
};

/** Higher utility has both a stronger colour and a larger dot, so that neither is needed alone. */
function drawOptions({ context, camera, colours }: Pen, pose: Pose, options: HeadingOptions): void {
  const shares = relativeUtilities(options);
  const from = toScreen(camera, ...pose.at);
  options.headings.forEach((option, i) => {
    const share = shares[i] ?? 0;
    const to = toScreen(camera, ...toWorldFrame(pose, option.at));
    const isChosen = i === options.chosen;
    context.strokeStyle = context.fillStyle = mixColours(colours["reach-low"], colours["reach-high"], share);
    context.lineWidth = isChosen ? 3 : 1;
    context.beginPath();
    context.moveTo(...from);
    context.lineTo(...to);
    context.stroke();
    context.beginPath();
    context.arc(...to, 1.5 + 2.5 * share, 0, 2 * Math.PI);
    context.fill();
    if (!isChosen) return;
    context.strokeStyle = colours.text;
    context.lineWidth = 1.5;
    context.beginPath();
    context.arc(...to, 7, 0, 2 * Math.PI);
    context.stroke();
  });
}
