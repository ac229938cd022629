import type { Unseen } from "../api/warden";

/** A robot as the emergency stop sees it: `unseen` is null unless its standstill is confirmed. */
export interface Standing {
  name: string;
  unseen: Pick<Unseen, "speed_m_s"> | null;
}

/** A number with two decimals, rounded up: what is an upper limit remains one. */
export function roundedUp(value: number): string {
  const rounding_error = 1e-9;
  return (Math.ceil(100 * value - rounding_error) / 100).toFixed(2);
}

export function slowerThan(speed_m_s: number): string {
  return `slower than ${roundedUp(speed_m_s)} m/s`;
}

/**
 * What is known of the standstill of several robots. Robots that may move come first, and the others are one
 * group, so that a bar of two lines hides none of the former.
 */
export function standstills(robots: Standing[]): string {
  const [confirmed, others] = [robots.flatMap(({ unseen }) => unseen ?? []), robots.filter(isUnconfirmed)];
  const names = others.map(({ name }) => name).join(", ");
  const parts = others.length > 0 ? [`${names}: standstill not confirmed`] : [];
  if (confirmed.length > 0) {
    const fastest_m_s = Math.max(...confirmed.map(({ speed_m_s }) => speed_m_s));
    parts.push(`${groupOf(robots)}: standstill confirmed (${slowerThan(fastest_m_s)})`);
  }
  return parts.join(" · ");
}

const isUnconfirmed = ({ unseen }: Standing) => unseen === null;

/** The name of the robots whose standstill is confirmed. */
function groupOf(robots: Standing[]): string {
  const names = robots.filter((robot) => !isUnconfirmed(robot)).map(({ name }) => name);
  if (names.length === 1) return names[0] ?? "";
  return names.length === robots.length ? `all ${names.length} robots` : `${names.length} others`;
}
