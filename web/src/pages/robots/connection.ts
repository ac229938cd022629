import type { WardenState } from "../../api/warden";

/** A state of the warden, and a time that is not after the one it describes. */
export interface Received {
  state: WardenState;
  at_ms: number;
}

/** What the page knows of the warden. Only `connected` permits controls that move robots. */
export type Connection =
  | { phase: "connecting" }
  | { phase: "connected"; last: Received }
  /** The newest state is older than `staleAfter_ms`. */
  | { phase: "stale"; last: Received }
  /** The warden cannot be reached. */
  | { phase: "lost"; last: Received | null }
  /** The warden does not accept the token. */
  | { phase: "refused" };

export type ConnectionEvent =
  | { type: "answered"; state: WardenState; sent_ms: number }
  /** `isTimeout`: there was no answer in time, which by itself does not show that the warden is gone. */
  | { type: "failed"; isTimeout: boolean }
  | { type: "refused" }
  | { type: "tick"; at_ms: number };

export const staleAfter_ms = 500;
export const lostAfter_ms = 3000;

export function next(connection: Connection, event: ConnectionEvent): Connection {
  switch (event.type) {
    case "answered": {
      const last = received(connection, event.state, event.sent_ms);
      return aged({ phase: "connected", last }, event.sent_ms);
    }
    case "refused":
      return { phase: "refused" };
    case "failed":
      return event.isTimeout || connection.phase === "refused"
        ? connection
        : { phase: "lost", last: lastOf(connection) };
    case "tick":
      return aged(connection, event.at_ms);
  }
}

export function lastOf(connection: Connection): Received | null {
  return "last" in connection ? connection.last : null;
}

/** A state that equals the last one in time is not newer: the warden answers, but does not run. */
function received(connection: Connection, state: WardenState, sent_ms: number): Received {
  const last = lastOf(connection);
  const isNewer = last?.state.time_s !== state.time_s;
  return { state, at_ms: isNewer || !last ? sent_ms : last.at_ms };
}

function aged(connection: Connection, at_ms: number): Connection {
  if (connection.phase !== "connected" && connection.phase !== "stale") return connection;
  const { last } = connection;
  const age_ms = at_ms - last.at_ms;
  if (age_ms > lostAfter_ms) return { phase: "lost", last };
  const phase = age_ms > staleAfter_ms ? "stale" : "connected";
  return phase === connection.phase ? connection : { phase, last };
}
