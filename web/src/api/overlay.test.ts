import { expect, test } from "vitest";
import { FrameError } from "./frame_error";
import { readOverlay } from "./overlay";

/** A message of 32-bit integers and floats. */
function overlay(whole: number[], ...footprints: [number[], number[]][]): ArrayBuffer {
  const numbers = footprints.flatMap(([head, floats]) => [
    ...head.map((value) => ({ value, isFloat: false })),
    ...floats.map((value) => ({ value, isFloat: true })),
  ]);
  const all = [...whole.map((value) => ({ value, isFloat: false })), ...numbers];
  const view = new DataView(new ArrayBuffer(4 * all.length));
  all.forEach(({ value, isFloat }, i) => {
    if (isFloat) view.setFloat32(4 * i, value, true);
    else view.setUint32(4 * i, value, true);
  });
  return view.buffer;
}

const full = () =>
  overlay(
    [2, 17, 2, 0, 1, 1, 3, 0, 0],
    [
      [5, 1, 2],
      [4, -0.5, 4, 0.5, 4],
    ],
    [
      [6, 0, 3],
      [8, 0, 8, 2.5, 1.5, 6.25, 8],
    ],
  );

test("an overlay survives a round trip", () => {
  const { frame, links, footprints } = readOverlay(full());
  expect(frame).toBe(17);
  expect([...links]).toEqual([0, 1, 1, 3, 0, 0]);
  expect(footprints).toMatchObject([
    { robot: 5, findsItems: true, range_m: 4 },
    { robot: 6, findsItems: false, range_m: 8 },
  ]);
  expect(footprints.map(({ corners }) => [...corners])).toEqual([
    [-0.5, 4, 0.5, 4],
    [0, 8, 2.5, 1.5, 6.25, 8],
  ]);
});

test("an overlay may be empty", () => {
  expect(readOverlay(overlay([2, 1, 0]))).toMatchObject({ frame: 1, footprints: [] });
});

test("truncated overlays and other messages are refused", () => {
  const whole = full();
  const ends = [36, 68];
  for (let bytes = 0; bytes < whole.byteLength; bytes += 4) {
    const part = () => readOverlay(whole.slice(0, bytes));
    if (ends.includes(bytes)) expect(part).not.toThrow();
    else expect(part, `${bytes}`).toThrow(FrameError);
  }
  expect(() => readOverlay(overlay([1, 1, 0]))).toThrow(FrameError);
});
