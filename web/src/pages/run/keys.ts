import type { Viewer } from "./viewer.svelte";

interface Key {
  keys: string[];
  description: string;
  act(viewer: Viewer): void;
}

const pan_px = 60;
const zoomStep = 1.25;

/** Keyboard shortcuts of the whole page, except while typing. */
export const keys: Key[] = [
  { keys: [" "], description: "Play or pause", act: (viewer) => viewer.toggle() },
  { keys: ["."], description: "Step forward", act: ({ session }) => session.step(1) },
  { keys: [","], description: "Step back", act: ({ session }) => session.step(-1) },
  { keys: ["]"], description: "Next event", act: ({ timeline }) => timeline.step(1) },
  { keys: ["["], description: "Previous event", act: ({ timeline }) => timeline.step(-1) },
  ...[0.1, 0.5, 1, 2, 10].map((speed, i) => ({
    keys: [String(i + 1)],
    description: `Set speed to ${speed} × real time`,
    act: (viewer: Viewer) => viewer.setSpeed(speed),
  })),
  {
    keys: ["f"],
    description: "Follow the selected robot",
    act: (viewer) => (viewer.follows = !viewer.follows && viewer.session.selected !== null),
  },
  { keys: ["0"], description: "Fit", act: ({ stage }) => stage?.fit() },
  { keys: ["+", "="], description: "Zoom in", act: ({ stage }) => stage?.zoom(zoomStep) },
  { keys: ["-"], description: "Zoom out", act: ({ stage }) => stage?.zoom(1 / zoomStep) },
];

/** How far arrow keys pan when the canvas has the focus. */
const arrows: Record<string, [number, number]> = {
  ArrowLeft: [pan_px, 0],
  ArrowRight: [-pan_px, 0],
  ArrowUp: [0, pan_px],
  ArrowDown: [0, -pan_px],
};

export function handleKey(event: KeyboardEvent, viewer: Viewer): void {
  if (isTyping(event.target)) return;
  const isHeld = event.ctrlKey || event.metaKey;
  const isUndo = isHeld && event.key === "z";
  const isRedo = isHeld && (event.key === "y" || (event.shiftKey && event.key === "Z"));
  const found = isHeld || event.altKey ? null : keys.find((key) => key.keys.includes(event.key));
  if (isUndo) done(event, () => viewer.session.undo());
  else if (isRedo) done(event, () => viewer.session.redo());
  else if (found && !(event.key === " " && isPressed(event.target))) done(event, () => found.act(viewer));
}

/** Pans the view for arrow keys. */
export function handleArrow(event: KeyboardEvent, viewer: Viewer): void {
  const by = arrows[event.key];
  if (by) done(event, () => viewer.stage?.pan(...by));
}

function done(event: KeyboardEvent, act: () => void): void {
  event.preventDefault();
  act();
}

function isTyping(target: EventTarget | null): boolean {
  if (target instanceof HTMLInputElement) return target.type !== "checkbox" && target.type !== "range";
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}

/** Whether Space would press what has the focus. */
function isPressed(target: EventTarget | null): boolean {
  return target instanceof Element && target.closest("button, a, summary, input, [role=tab]") !== null;
}
