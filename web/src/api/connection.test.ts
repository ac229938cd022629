import { beforeEach, expect, test } from "vitest";
import { Connection, type Socket } from "./connection";
import type { ServerMessage } from "./protocol";

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
let events: string[];
let connection: Connection;

const last = () => sockets[sockets.length - 1] as FakeSocket;
const drop = () => last().onclose?.();
const waited = () => waits[waits.length - 1]?.action();

beforeEach(() => {
  sockets = [];
  waits = [];
  events = [];
  connection = new Connection(
    {
      ready: () => events.push("ready"),
      lost: () => events.push("lost"),
      message: (message: ServerMessage) => events.push(message.type),
      frame: (frame) => events.push(`frame ${frame.number}`),
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

test("an open connection is reported and sends commands", () => {
  expect(connection.send({ type: "pause" })).toBe(false);
  last().onopen?.();
  expect(connection.send({ type: "pause" })).toBe(true);
  expect(events).toEqual(["ready"]);
  expect(last().sent).toEqual(['{"type":"pause"}']);
});

test("a lost connection is reported at once and restored", () => {
  last().onopen?.();
  drop();
  expect(events).toEqual(["ready", "lost"]);
  expect(connection.send({ type: "pause" })).toBe(false);
  waited();
  last().onopen?.();
  expect(events).toEqual(["ready", "lost", "ready"]);
});

test("waiting times double up to ten seconds", () => {
  for (let i = 0; i < 7; i++) {
    drop();
    waited();
  }
  expect(waits.map((wait) => wait.ms)).toEqual([500, 1000, 2000, 4000, 8000, 10000, 10000]);
});

test("waiting times start again after a run was opened", () => {
  drop();
  waited();
  drop();
  waited();
  last().onopen?.();
  last().onmessage?.({ data: '{"type":"opened"}' });
  drop();
  expect(waits.map((wait) => wait.ms)).toEqual([500, 1000, 500]);
});

test("a closed connection stays closed", () => {
  const socket = last();
  connection.close();
  expect(socket.closed).toBe(true);
  expect(socket.onclose).toBeNull();
  expect(waits).toEqual([]);
});

test("starting cancels a pending attempt", () => {
  drop();
  connection.start();
  expect(waits[0]?.cancelled).toBe(true);
  expect(sockets.length).toBe(2);
});

test("an invalid message is ignored", () => {
  for (const data of ["", "{", "null", "[1]", '{"type":"other"}', "17"]) last().onmessage?.({ data });
  expect(events).toEqual([]);
});

test("an unreadable frame closes the connection, which is then restored", () => {
  last().onopen?.();
  last().onmessage?.({ data: new ArrayBuffer(5) });
  expect(last().closed).toBe(true);
  expect(events).toEqual(["ready", "lost"]);
  expect(waits.length).toBe(1);
});
