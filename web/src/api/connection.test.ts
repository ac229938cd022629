import { beforeEach, expect, test } from "vitest";
import { Connection, type Socket } from "./connection";
import type { Message } from "./messages";

class FakeSocket implements Socket {
  binaryType = "";
  onopen: Socket["onopen"] = null;
  onclose: Socket["onclose"] = null;
  onmessage: Socket["onmessage"] = null;
  sent: string[] = [];
  closed = false;
  send(data: string) {
    this.sent.push(data);
  }
  close() {
    this.closed = true;
  }
}

let sockets: FakeSocket[];
let waits: { ms: number; action: () => void; cancelled: boolean }[];
let heard: string[];
let connection: Connection;

const last = () => sockets[sockets.length - 1] as FakeSocket;
const drop = () => last().onclose?.();
const waited = () => waits[waits.length - 1]?.action();

beforeEach(() => {
  sockets = [];
  waits = [];
  heard = [];
  connection = new Connection(
    {
      ready: () => heard.push("ready"),
      lost: () => heard.push("lost"),
      message: (message: Message) => heard.push(message.type),
      frame: (frame) => heard.push(`frame ${frame.number}`),
    },
    {
      connect: () => {
        sockets.push(new FakeSocket());
        return last();
      },
      after: (ms, action) => {
        const wait = { ms, action, cancelled: false };
        waits.push(wait);
        return () => {
          wait.cancelled = true;
        };
      },
    },
  );
  connection.start();
});

test("a line that opens says so, and carries commands", () => {
  expect(connection.send({ type: "pause" })).toBe(false);
  last().onopen?.();
  expect(connection.send({ type: "pause" })).toBe(true);
  expect(heard).toEqual(["ready"]);
  expect(last().sent).toEqual(['{"type":"pause"}']);
});

test("a line that is lost is said at once and comes back", () => {
  last().onopen?.();
  drop();
  expect(heard).toEqual(["ready", "lost"]);
  expect(connection.send({ type: "pause" })).toBe(false);
  waited();
  last().onopen?.();
  expect(heard).toEqual(["ready", "lost", "ready"]);
});

test("waits double up to ten seconds", () => {
  for (let i = 0; i < 7; i++) {
    drop();
    waited();
  }
  expect(waits.map((wait) => wait.ms)).toEqual([500, 1000, 2000, 4000, 8000, 10000, 10000]);
});

test("waits begin anew once a run was opened", () => {
  drop();
  waited();
  drop();
  waited();
  last().onopen?.();
  last().onmessage?.({ data: '{"type":"opened"}' });
  drop();
  expect(waits.map((wait) => wait.ms)).toEqual([500, 1000, 500]);
});

test("a line that was closed on purpose stays closed", () => {
  const socket = last();
  connection.close();
  expect(socket.closed).toBe(true);
  expect(socket.onclose).toBeNull();
  expect(waits).toEqual([]);
});

test("starting while a wait is under way cancels that", () => {
  drop();
  connection.start();
  expect(waits[0]?.cancelled).toBe(true);
  expect(sockets.length).toBe(2);
});

test("text that is no message is passed over", () => {
  for (const data of ["", "{", "null", "[1]", '{"type":"other"}', "17"]) last().onmessage?.({ data });
  expect(heard).toEqual([]);
});

test("a frame that cannot be read ends the line, and a new one is tried", () => {
  last().onopen?.();
  last().onmessage?.({ data: new ArrayBuffer(5) });
  expect(last().closed).toBe(true);
  expect(heard).toEqual(["ready", "lost"]);
  expect(waits.length).toBe(1);
});
