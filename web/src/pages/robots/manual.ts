import type { Tracks } from "./deadman";

export type SliderName = "left" | "right" | "both";

export const sliders: { name: SliderName; label: string }[] = [
  { name: "left", label: "Left track" },
  { name: "right", label: "Right track" },
  { name: "both", label: "Both tracks" },
];

/**
 * The directions of the program of 2002. Its reverse was three times as fast as its forward (75 is 75 below
 * neutral, 175 is 25 above), and its turns drove backwards; here all are 25 from neutral.
 */
export const directions: { name: string; key: string; label: string; tracks: Tracks }[] = [
  { name: "forward", key: "ArrowUp", label: "Forward", tracks: { left: 175, right: 175 } },
  { name: "left", key: "ArrowLeft", label: "Left", tracks: { left: 125, right: 175 } },
  { name: "right", key: "ArrowRight", label: "Right", tracks: { left: 175, right: 125 } },
  { name: "reverse", key: "ArrowDown", label: "Reverse", tracks: { left: 125, right: 125 } },
];

/** What the sliders show after one of them has been moved to a value. */
export function withSlider(shown: Tracks, name: SliderName, value: number): Tracks {
  return name === "both" ? { left: value, right: value } : { ...shown, [name]: value };
}
