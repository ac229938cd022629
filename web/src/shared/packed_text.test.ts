import { expect, test } from "vitest";
import { pack, unpack } from "./packed_text";

test("text survives a round trip and needs no escapes", async () => {
  const text = '# Räume\n[world]\nsize_m = [20, 12] # "a" \u{1F916}\n'.repeat(40);
  const packed = await pack(text);
  expect(packed).toMatch(/^z[\w-]+$/);
  expect(packed.length).toBeLessThan(text.length / 4);
  expect(await unpack(packed)).toBe(text);
});

test("unpacking an invalid string gives null", async () => {
  expect(await unpack("z!!")).toBeNull();
  expect(await unpack("zAAAA")).toBeNull();
});
