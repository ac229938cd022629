import type { Parameter } from "./list";

/** Up to this end, values can still be set by hand. */
const maxUseful = 1000;

/**
 * The upper end of a parameter's slider: its bound if that is near, else a round number well above its value.
 * On a slider to 10,000 m, 3 m could not be set.
 */
export function sliderEnd({
  maximum,
  value,
  fallback,
}: Pick<Parameter, "maximum" | "value" | "fallback">): number {
  const now = Math.abs(Number(value ?? fallback ?? 1)) || 1;
  const near = now * 4;
  if (maximum <= Math.max(1, near) || maximum <= maxUseful / 10) return maximum;
  const power = 10 ** Math.floor(Math.log10(near));
  return Math.min(maximum, ([1, 2, 5, 10].find((factor) => factor * power >= near) ?? 10) * power);
}
