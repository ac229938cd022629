import { expect, test } from "vitest";
import type { State } from "../../api/protocol";
import { lostPhase, type Phase } from "./phase";

const playing = { is_playing: true, speed: 2 } as State;
const ended: Phase = { name: "ended", ended: { type: "ended", reason: "idle", message: "Idle." } };

test("a run that was playing resumes at its speed, however often the connection is lost", () => {
  const lost = lostPhase({ name: "open" }, playing, 500);
  expect(lost).toEqual({ name: "lost", retry_ms: 500, resumeSpeed: 2 });
  expect(lostPhase(lost as Phase, { ...playing, is_playing: false }, 1000)).toEqual({
    name: "lost",
    retry_ms: 1000,
    resumeSpeed: 2,
  });
});

test("a run that was paused or not yet open does not resume", () => {
  for (const [phase, state] of [
    [{ name: "open" }, { ...playing, is_playing: false }],
    [{ name: "opening" }, playing],
    [{ name: "opening" }, null],
  ] as [Phase, State | null][])
    expect(lostPhase(phase, state, 500)).toMatchObject({ name: "lost", resumeSpeed: undefined });
});

test("a run that was refused or has ended is not opened again", () => {
  expect(lostPhase({ name: "refused", errors: [], total: 0 }, null, 500)).toBeNull();
  expect(lostPhase(ended, playing, 500)).toBeNull();
});
