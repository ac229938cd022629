import { afterEach, beforeEach, expect, test, vi } from "vitest";
import type { Socket } from "../../api/connection";
import type { Change, ServerMessage, State } from "../../api/protocol";
import { emptyLink, type Link } from "../../shared/link";
import { Session } from "./session.svelte";

let sockets: (Socket & { sent: Record<string, unknown>[] })[];
let retry: () => void;
let session: Session;

const last = () => sockets.at(-1) as (typeof sockets)[number];
const sent = (type: string) => last().sent.filter((each) => each.type === type);
const receive = (message: object) => last().onmessage?.({ data: JSON.stringify(message) });

function connect(): void {
  last().onopen?.();
  receive({ type: "opened", scenario: {}, seed: "0", run: "0" } as unknown as ServerMessage);
}

function showState(rest: Partial<State>): void {
  receive({
    type: "state",
    tick: 9,
    latest_tick: 9,
    is_over: false,
    is_playing: false,
    outcome: {},
    ...rest,
  });
}

function showSetting(log: Change[]): void {
  receive({ type: "setting", generation: 1, step_s: 0.1, document: {}, robots: [], changes: log, log });
}

beforeEach(() => {
  vi.useFakeTimers();
  start({ ...emptyLink, scenario: "search" });
});
afterEach(() => void vi.useRealTimers());

function start(link: Link): void {
  sockets = [];
  session = new Session(
    { ...link, text: null },
    {
      connect: () => {
        const sent: Record<string, unknown>[] = [];
        const send = (data: string) => void sent.push(JSON.parse(data));
        const close = () => {};
        sockets.push({ binaryType: "", onopen: null, onclose: null, onmessage: null, sent, send, close });
        return last();
      },
      after: (_, action) => {
        retry = action;
        return () => {};
      },
    },
  );
  session.start();
}

test("a run is open once the server confirms it, and lost until it does again", () => {
  expect(session.phase).toEqual({ name: "opening" });
  connect();
  expect(session.phase).toEqual({ name: "open" });
  last().onclose?.();
  expect(session.phase).toEqual({ name: "lost", retry_ms: 500, resumeSpeed: undefined });
  retry();
  connect();
  expect(session.phase).toEqual({ name: "open" });
});

test("a refused run has its errors, and one that ended its reason; neither is opened again", () => {
  const errors = [{ message: "No." }];
  last().onopen?.();
  receive({ type: "refused", about: "open", path: null, errors });
  expect(session.phase).toEqual({ name: "refused", errors });
  session.reopen();
  connect();
  const ended = { type: "ended", reason: "idle", message: "Idle." };
  receive(ended);
  expect(session.phase).toEqual({ name: "ended", ended });
});

test("changes made while the server is away are sent once, when the run is open again", () => {
  connect();
  last().onclose?.();
  session.change("robots.rover.count", 6);
  session.change("clock.time_limit_s", 30);
  expect(Object.keys(session.unsent)).toEqual(["robots.rover.count"]);
  retry();
  connect();
  const change = { type: "change", path: "robots.rover.count", value: 6, replaces_last: false };
  expect(sent("change")).toEqual([change]);
  expect(session.unsent).toEqual({});
});

test("a change that was sent and not confirmed is lost with the connection, unless it is made again", () => {
  connect();
  showSetting([]);
  session.change("robots.rover.count", 6);
  showSetting([[9, "robots.rover.count", 6]]);
  last().onclose?.();
  expect(session.lostChanges).toEqual([]);
  retry();
  connect();
  vi.advanceTimersByTime(1000);
  session.change("robots.rover.count", 7);
  last().onclose?.();
  expect(session.lostChanges).toEqual(["robots.rover.count"]);
  retry();
  connect();
  expect(sent("change")).toEqual([]);
  expect(session.lostChanges).toEqual(["robots.rover.count"]);
  vi.advanceTimersByTime(1000);
  session.change("robots.rover.count", 7);
  expect(session.lostChanges).toEqual([]);
});

test("a change that was refused or undone is not lost", () => {
  connect();
  session.change("robots.rover.count", -1);
  receive({ type: "refused", about: "change", path: "robots.rover.count", errors: [{ message: "No." }] });
  last().onclose?.();
  expect(session.lostChanges).toEqual([]);
  retry();
  connect();
  session.change("robots.rover.count", 5);
  session.undo();
  last().onclose?.();
  expect(session.lostChanges).toEqual([]);
});

test("a live run is joined, also again, and nothing that moves or changes it is sent", () => {
  start({ ...emptyLink, live: true, seed: null, robot: "bender/0" });
  connect();
  showSetting([]);
  showState({ is_playing: true, speed: 1 });
  session.play(1);
  session.pause();
  session.step(1);
  session.go(3);
  session.undo();
  session.change("robots.bender.count", 6);
  expect(last().sent.map(({ type }) => type)).toEqual(["open", "select", "request_series"]);
  expect(sent("open")).toEqual([{ type: "open", live: true }]);
  last().onclose?.();
  retry();
  connect();
  expect(last().sent.map(({ type }) => type)).toEqual(["open", "select"]);
  expect(sent("open")).toEqual([{ type: "open", live: true }]);
});

test("an export is refused while the server is away, and when the connection is lost", async () => {
  connect();
  const exported = session.exported();
  last().onclose?.();
  expect(await exported).toBeNull();
  expect(session.refusals.export).toContain("connection is lost");
  expect(await session.exported()).toBeNull();
});

test("a change of a run that is over waits for the user, and is made one step before the end", () => {
  connect();
  showState({ is_over: true });
  session.change("robots.rover.count", 6);
  expect(sent("change")).toEqual([]);
  expect(session.afterEnd).toEqual({ path: "robots.rover.count", value: 6 });
  session.changeBeforeEnd();
  expect(sent("seek")).toEqual([{ type: "seek", tick: 8 }]);
  expect(sent("change")).toHaveLength(1);
  expect(session.afterEnd).toBeNull();
});

test("one request for the series is under way at a time", () => {
  connect();
  showState({});
  showState({ tick: 10, latest_tick: 10 });
  expect(sent("request_series")).toEqual([{ type: "request_series", since: 0 }]);
  receive({ type: "series", since: 0, columns: ["found"], rows: [{ tick: 4, values: [1] }] });
  showState({ tick: 11, latest_tick: 11 });
  expect(sent("request_series").at(-1)).toEqual({ type: "request_series", since: 4 });
  expect(session.series.rows.map(({ tick }) => tick)).toEqual([4, 11]);
});

test("layers and panels are kept only while they are requested", () => {
  connect();
  const shown = { type: "shown", tick: 9, layers: { economy: {}, "lane-risk": {} }, panels: { lane: {} } };
  const names = () => [
    ...Object.keys(session.shown?.layers ?? {}),
    ...Object.keys(session.shown?.panels ?? {}),
  ];
  session.show({ layers: ["economy", "lane-risk"], panels: ["lane"], choices: {} });
  receive(shown);
  expect(names()).toEqual(["economy", "lane-risk", "lane"]);
  session.show({ layers: ["economy"], panels: [], choices: {} });
  expect(names()).toEqual(["economy"]);
  // Sent before the server had received the request.
  receive(shown);
  expect(names()).toEqual(["economy"]);
});
