import { expect, test } from "vitest";
import { Exports } from "./exports";

test("scenarios are received in the order of the requests", async () => {
  const exports = new Exports();
  const both = [exports.next(() => true), exports.next(() => true)];
  exports.received("one");
  exports.received("two");
  expect(await Promise.all(both)).toEqual(["one", "two"]);
});

test("a request fails if it cannot be sent, or when the connection is lost", async () => {
  const exports = new Exports();
  await expect(exports.next(() => false)).rejects.toThrow("connection is lost");
  const waiting = exports.next(() => true);
  exports.fail();
  await expect(waiting).rejects.toThrow("connection is lost");
});

test("a scenario that was not requested is ignored", () => {
  expect(() => new Exports().received("one")).not.toThrow();
});
