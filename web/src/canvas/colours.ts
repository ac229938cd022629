/** Colours of the canvases, read from the style sheet (`shared/styles/theme.css`). */
const names = [
  "ground",
  "outside",
  "border",
  "grid",
  "obstacle",
  "obstacle-edge",
  "unknown",
  "terrain",
  "terrain-text",
  "robot-clear",
  "robot-warning",
  "robot-collided",
  "robot-empty",
  "robot-broken",
  "robot-mark",
  "item-hidden",
  "item-found",
  "item-missed",
  "item-clutter",
  "text",
  "accent",
  "trail",
  "link",
  "sense-items",
  "sense-other",
  "belief",
  "reach-low",
  "reach-high",
  "owner-1",
  "owner-2",
  "owner-3",
  "owner-4",
  "owner-5",
  "owner-6",
  "risk-1",
  "risk-2",
  "risk-3",
  "risk-4",
  "risk-5",
  "cleared",
  "muted",
] as const;

export type ColourName = (typeof names)[number];
export type Colours = Record<ColourName, string>;

export const robotColours: ColourName[] = [
  "robot-clear",
  "robot-warning",
  "robot-collided",
  "robot-empty",
  "robot-broken",
];

export function readColours(): Colours {
  const style = getComputedStyle(document.documentElement);
  const named = names.map((name) => [name, expandHex(style.getPropertyValue(`--${name}`).trim())]);
  return Object.fromEntries(named) as Colours;
}

/** The build shortens colours, `#ffffff` to `#fff`. */
export function expandHex(colour: string): string {
  const short = /^#([0-9a-f])([0-9a-f])([0-9a-f])$/i.exec(colour);
  return short
    ? `#${short
        .slice(1)
        .map((digit) => digit + digit)
        .join("")}`
    : colour;
}

/** Red, green and blue, 0 to 1, of a colour such as `#1c63d5`. */
export function rgb(colour: string): [number, number, number] {
  const value = Number.parseInt(colour.slice(1), 16) || 0;
  return [(value >> 16) / 255, ((value >> 8) & 255) / 255, (value & 255) / 255];
}

/** Calls `action` when the theme changes; returns a function that stops this. */
export function onThemeChange(action: () => void): () => void {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", action);
  return () => dark.removeEventListener("change", action);
}
