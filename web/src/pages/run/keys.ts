import type { Viewer } from "./viewer.svelte";

interface Key {
  keys: string[];
  does: string;
  act(viewer: Viewer): void;
}

const pan_px = 60;
const zoomStep = 1.25;

/** What keys do wherever one is, unless one is writing. */
export const keys: Key[] = [
  { keys: [" "], does: "play or pause", act: (viewer) => viewer.toggle() },
  { keys: ["."], does: "a step on", act: ({ session }) => session.step(1) },
  { keys: [","], does: "a step back", act: ({ session }) => session.step(-1) },
  ...[0.1, 0.5, 1, 2, 10].map((speed, i) => ({
    keys: [String(i + 1)],
    does: `${speed} times real time`,
    act: (viewer: Viewer) => viewer.setSpeed(speed),
  })),
  {
    keys: ["f"],
    does: "follow the selected robot, or not",
    act: (viewer) => (viewer.follows = !viewer.follows && viewer.session.selected !== null),
  },
  { keys: ["0"], does: "the whole world", act: ({ stage }) => stage?.fit() },
  { keys: ["+", "="], does: "nearer", act: ({ stage }) => stage?.zoom(zoomStep) },
  { keys: ["-"], does: "farther", act: ({ stage }) => stage?.zoom(1 / zoomStep) },
];

/** What keys do when the picture has the focus. */
const arrows: Record<string, [number, number]> = {
  ArrowLeft: [pan_px, 0],
  ArrowRight: [-pan_px, 0],
  ArrowUp: [0, pan_px],
  ArrowDown: [0, -pan_px],
};

export function handleKey(event: KeyboardEvent, viewer: Viewer): void {
  if (isWriting(event.target)) return;
  const isHeld = event.ctrlKey || event.metaKey;
  const isUndo = isHeld && event.key === "z";
  const found = isHeld || event.altKey ? null : keys.find((key) => key.keys.includes(event.key));
  if (isUndo) done(event, () => viewer.session.undo());
  else if (found && !(event.key === " " && isPressed(event.target))) done(event, () => found.act(viewer));
}

/** Moves the picture; true if the key is one of those that do. */
export function handleArrow(event: KeyboardEvent, viewer: Viewer): void {
  const by = arrows[event.key];
  if (by) done(event, () => viewer.stage?.pan(...by));
}

function done(event: KeyboardEvent, act: () => void): void {
  event.preventDefault();
  act();
}

function isWriting(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return target.type !== "checkbox" && target.type !== "range";
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/** Whether Space would press what has the focus. */
function isPressed(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest("button, a, summary, input, [role=tab]") !== null;
}
