/** Goals and controllers: whether a run has any, their words, and the colour of each owner. */
import type { ControllerView, GoalStatus, GoalView, Point, Setting } from "../api/protocol";
import { tableOf } from "./world";

/** The number of colours; controllers beyond it share them in turn. */
export const ownerColours = 6;

export function hasEconomy({ document }: Setting): boolean {
  return [document.goals, document.controllers].some((table) => Object.keys(tableOf(table)).length > 0);
}

/** The colour of a controller's goals, 1 to `ownerColours`; null if there is no such controller. */
export function colourOf(controllers: ControllerView[], owner: string | null): number | null {
  const place = controllers.findIndex(({ name }) => name === owner);
  return place < 0 ? null : 1 + (place % ownerColours);
}

export const statusLabels: Record<GoalStatus, string> = {
  pending: "not yet issued",
  open: "open",
  awarded: "awarded",
  served: "served",
  expired: "expired",
};

const reasons: Record<string, string> = {
  unreachable: "no path leads there",
  capability: "no robot has the capability",
  deadline: "every robot would be too late",
  battery: "no battery lasts",
  full: "every robot serves its maximum number of goals",
  lease: "the service takes longer than a lease",
  out_of_service: "the robots are out of service",
  no_robot: "no robot is in range",
  orphaned: "its owner has lost it: the heir did not renew the lease",
  no_controller: "no controller works",
  position: "no robot knows its position well enough",
};

/** Why no robot can serve a goal. */
export function reasonLabel(unserved: string): string {
  return reasons[unserved] ?? unserved;
}

/** The number of goals of each status that occurs, such as `21 open, 31 awarded`. */
export function countsOf(goals: GoalView[]): string {
  const counts = (Object.keys(statusLabels) as GoalStatus[]).map((status) => {
    const count = goals.filter((goal) => goal.status === status).length;
    return count > 0 ? `${count} ${statusLabels[status]}` : "";
  });
  return counts.filter(Boolean).join(", ") || "no goals";
}

/** The goals of a controller; all if it is null. */
export function goalsOf(goals: GoalView[], owner: string | null): GoalView[] {
  return owner === null ? goals : goals.filter((goal) => goal.owner === owner);
}

/** The controller nearest to a place within a distance; null if there is none. Those aboard are selected by their robot. */
export function controllerAt(controllers: ControllerView[], [x, y]: Point, within: number): string | null {
  const fixed = controllers.filter(({ aboard }) => aboard === null);
  const distances = fixed.map(({ name, at }) => ({ name, distance: Math.hypot(at[0] - x, at[1] - y) }));
  const near = distances.filter(({ distance }) => distance <= within);
  near.sort((a, b) => a.distance - b.distance);
  return near[0]?.name ?? null;
}
