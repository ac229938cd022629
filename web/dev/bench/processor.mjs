/** Processor time of processes, from Linux's /proc. */
import { readdirSync, readFileSync } from "node:fs";

const tick_ms = 10; // of /proc/PID/stat

function stat(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
    return { parent: Number(fields[1]), used_ms: tick_ms * (Number(fields[11]) + Number(fields[12])) };
  } catch {
    return null; // the process has ended
  }
}

/** Processor time of a process with all its threads, in milliseconds. */
export function usedBy_ms(pid) {
  return stat(pid)?.used_ms ?? 0;
}

/** Processor time of all descendants of this process, except one and its descendants, in milliseconds. */
export function usedBelow_ms(without) {
  return [...below(without).values()].reduce((sum, found) => sum + found.used_ms, 0);
}

/** All descendants of this process, except one and its descendants, by number. */
export function below(without) {
  const all = new Map(
    readdirSync("/proc")
      .filter((name) => /^\d+$/.test(name))
      .map((pid) => [Number(pid), stat(pid)]),
  );
  const isBelow = (pid) => {
    if (pid === without) return false;
    const parent = all.get(pid)?.parent ?? 0;
    return parent === process.pid || (parent > 1 && isBelow(parent));
  };
  return new Map([...all].filter(([pid, found]) => found && isBelow(pid)));
}
