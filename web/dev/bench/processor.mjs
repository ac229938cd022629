/** What processes have used of the processor, as Linux tells it. */
import { readdirSync, readFileSync } from "node:fs";

const tick_ms = 10; // of /proc/PID/stat

function stat(pid) {
  try {
    const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
    return { parent: Number(fields[1]), used_ms: tick_ms * (Number(fields[11]) + Number(fields[12])) };
  } catch {
    return null; // it has ended meanwhile
  }
}

/** Milliseconds that a process has used: all its threads. */
export function usedBy_ms(pid) {
  return stat(pid)?.used_ms ?? 0;
}

/** Milliseconds that all processes below this one have used, but for one and what is below it. */
export function usedBelow_ms(without) {
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
  return [...all].reduce((sum, [pid, found]) => sum + (found && isBelow(pid) ? found.used_ms : 0), 0);
}
