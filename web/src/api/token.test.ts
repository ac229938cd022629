import { expect, test } from "vitest";
import { keepToken, tokenFields } from "./token";

function memory(): () => Storage {
  const items = new Map<string, string>();
  const storage = {
    getItem: (key: string) => items.get(key) ?? null,
    setItem: (key: string, value: string) => void items.set(key, value),
  };
  return () => storage as Storage;
}

test.each([
  ["http://127.0.0.1:8765/?token=a-_b#/robots", "http://127.0.0.1:8765/#/robots"],
  ["http://127.0.0.1:8765/?other=1&token=ab", "http://127.0.0.1:8765/?other=1"],
  ["http://127.0.0.1:8765/#/run?seed=7&text=a%20b", "http://127.0.0.1:8765/#/run?seed=7&text=a%20b"],
])("an address loses the token of the server and nothing else", (address, rest) => {
  expect(keepToken(address, memory())).toBe(rest);
});

test("a page that is loaded again has the token, and a new one replaces it", () => {
  const storage = memory();
  keepToken("http://127.0.0.1:8765/?token=one#/robots", storage);
  expect(tokenFields()).toEqual({ "agent-economy-token": "one" });
  keepToken("http://127.0.0.1:8765/?token=two", storage);
  keepToken("http://127.0.0.1:8765/#/robots", storage);
  expect(tokenFields()).toEqual({ "agent-economy-token": "two" });
  keepToken("http://127.0.0.1:8765/#/robots", memory());
  expect(tokenFields()).toEqual({});
});

test("a browser without storage keeps the token until the page is loaded again", () => {
  const refused = () => {
    throw new Error("SecurityError");
  };
  keepToken("http://127.0.0.1:8765/?token=one", refused);
  expect(tokenFields()).toEqual({ "agent-economy-token": "one" });
});
