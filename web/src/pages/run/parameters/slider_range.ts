import type { Parameter } from "./list";

/** A slider up to here is one in which a hand can find a value. */
const mostUseful = 1000;

/**
 * Where a parameter's slider ends: at its bound if that is near; else at some round number well above what
 * it is, as on one to 10,000 m nobody could set 3 m.
 */
export function sliderEnd({
  maximum,
  value,
  fallback,
}: Pick<Parameter, "maximum" | "value" | "fallback">): number {
  const now = Math.abs(Number(value ?? fallback ?? 1)) || 1;
  const near = now * 4;
  if (maximum <= Math.max(1, near) || maximum <= mostUseful / 10) return maximum;
  const power = 10 ** Math.floor(Math.log10(near));
  return Math.min(maximum, ([1, 2, 5, 10].find((factor) => factor * power >= near) ?? 10) * power);
}
