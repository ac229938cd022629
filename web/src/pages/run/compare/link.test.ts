import { expect, test } from "vitest";
import { emptyLink } from "../../../shared/link";
import { compareLink, linkIn, readCompareLink } from "./link";

const one = { ...emptyLink, scenario: "search", seed: "3", tick: 40 };
const other = { ...one, changes: [[0, "robots.rover.count", 6] as [number, string, number]] };

test("an address of two runs is read as it was written", () => {
  const query = new URLSearchParams(compareLink(one, other).split("?").slice(1).join("?"));
  expect(readCompareLink(query)).toEqual({ left: one, right: other });
});

test("damaged and live sides are named", () => {
  const damages = (text: string) => {
    const read = readCompareLink(new URLSearchParams(text));
    return "damages" in read ? read.damages : [];
  };
  expect(damages("left=scenario%3Da%26tick%3Dx&right=scenario%3Da")).toEqual(["left: tick=x"]);
  expect(damages("left=live%3D1&right=scenario%3Da")[0]).toContain("live");
  expect(damages("").length).toBe(2);
});

test("the run of a copied address is read, and other strings are not", () => {
  expect(linkIn("http://127.0.0.1:8765/#/run?scenario=search&seed=3&run=0&tick=40")).toEqual(one);
  expect(linkIn("http://127.0.0.1:8765/#/studies")).toBeNull();
  expect(linkIn("#/run?tick=x")).toBeNull();
});
