import type { Standing } from "../../api/study";

/**
 * The configurations that an axis is scaled to; distant ones would squeeze them. With a requirement, those that
 * are certified or open, and the next cheaper one than `best`; by merit, those whose range reaches that of
 * `best`, at least two.
 */
export function contenders(standings: Standing[], best: number | null): Standing[] {
  const place = standings.findIndex(([configuration]) => configuration === best);
  if (standings.some(([, , , , , status]) => status !== null)) {
    const end = place === -1 ? standings.length : place;
    return standings.filter(
      ([, , , , , status], i) => status === "certified" || status === "open" || i === end - 1,
    );
  }
  const least = standings[place]?.[3] ?? null;
  if (least === null) return standings;
  return standings.filter(([, , , , high], i) => i < 2 || high === null || high >= least);
}
