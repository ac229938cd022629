import { expect, test } from "vitest";
import { FrameError } from "./frame_error";
import { readFrame } from "./frames";

function frame(robots: number[][], items: number[]): ArrayBuffer {
  const buffer = new ArrayBuffer(32 + 16 * robots.length + items.length);
  const view = new DataView(buffer);
  [1, 3, 120, robots.length].forEach((value, i) => view.setUint32(4 * i, value, true));
  view.setFloat64(16, 12.5, true);
  view.setUint32(24, items.length, true);
  view.setUint32(28, 17, true);
  robots.flat().forEach((value, i) => view.setFloat32(32 + 4 * i, value, true));
  new Uint8Array(buffer).set(items, 32 + 16 * robots.length);
  return buffer;
}

test("a frame survives a round trip", () => {
  const read = readFrame(
    frame(
      [
        [1, 2, 0.5, 1],
        [3, 4, -0.5, 0],
      ],
      [0, 1, 2],
    ),
  );
  expect(read).toMatchObject({ generation: 3, tick: 120, time_s: 12.5, number: 17, count: 2 });
  expect([...read.robots]).toEqual([1, 2, 0.5, 1, 3, 4, -0.5, 0]);
  expect([...read.items]).toEqual([0, 1, 2]);
});

test("a frame is not copied", () => {
  const buffer = frame([[1, 2, 3, 0]], [1]);
  expect(readFrame(buffer).robots.buffer).toBe(buffer);
});

test("a frame may have no robots and no items", () => {
  expect(readFrame(frame([], [])).count).toBe(0);
});

test("a truncated frame is refused", () => {
  const whole = frame(
    [
      [1, 2, 3, 0],
      [4, 5, 6, 1],
    ],
    [1, 0],
  );
  for (let end = 0; end < whole.byteLength; end++) {
    expect(() => readFrame(whole.slice(0, end)), `${end} bytes`).toThrow(FrameError);
  }
});

test("a frame with bytes after its end is refused", () => {
  const longer = new Uint8Array(frame([[1, 2, 3, 0]], []).byteLength + 1);
  longer.set(new Uint8Array(frame([[1, 2, 3, 0]], [])));
  expect(() => readFrame(longer.buffer)).toThrow(FrameError);
});

test("noise and other versions are refused", () => {
  const noise = Uint8Array.from({ length: 64 }, (_, i) => (i * 73 + 41) % 256);
  expect(() => readFrame(noise.buffer)).toThrow(FrameError);
  const other = frame([], []);
  new DataView(other).setUint32(0, 2, true);
  expect(() => readFrame(other)).toThrow(FrameError);
});

test("robot counts that no buffer can hold are refused", () => {
  const huge = frame([], []);
  new DataView(huge).setUint32(12, 0xffffffff, true);
  expect(() => readFrame(huge)).toThrow(FrameError);
});
