import { expect, test } from "vitest";
import { importErrors, importsOf } from "./imports.mjs";

const errorsIn = (sources) => importErrors(importsOf(sources));
const component = (script) => `<script lang="ts">\n${script}\n</script>\n<p>import "./nowhere"</p>`;

test("imports down the layers are allowed, from components and modules", () => {
  const sources = {
    "api/types.ts": "",
    "shared/link.ts": 'import type { Link } from "../api/types";',
    "canvas/index.ts": 'import { link } from "../shared/link"; import "./style.css";',
    "pages/run/Run.svelte": component('import { draw } from "../../canvas"; import { mount } from "svelte";'),
  };
  expect(errorsIn(sources)).toEqual([]);
});

test("a circle is an error, also one of types only, and one through a component", () => {
  const sources = {
    "api/a.ts": 'import type { B } from "./b";',
    "api/b.ts": 'export { c } from "./c";',
    "api/c.ts": 'const a = () => import("./a");',
    "shared/One.svelte": component('import Two from "./Two.svelte";'),
    "shared/Two.svelte": component('import type { One } from "./One.svelte";'),
  };
  expect(errorsIn(sources)).toEqual([
    "import circle: api/a.ts -> api/b.ts -> api/c.ts -> api/a.ts",
    "import circle: shared/One.svelte -> shared/Two.svelte -> shared/One.svelte",
  ]);
});

test("an import up the layers, or from one page to another, is an error", () => {
  const sources = {
    "api/a.ts": 'import "../shared/s";',
    "shared/s.ts": "",
    "shared/t.ts": 'import type { Run } from "../pages/run/run";',
    "pages/run/run.ts": "",
    "pages/study/study.ts": 'import "../run/run";',
  };
  expect(errorsIn(sources)).toEqual([
    "api/a.ts must not import shared/s.ts",
    "shared/t.ts must not import pages/run/run.ts",
    "pages/study/study.ts must not import pages/run/run.ts",
  ]);
});

test("an import that leads nowhere is an error", () => {
  expect(() => importsOf({ "api/a.ts": 'import "./b";' })).toThrow('api/a.ts: cannot resolve "./b"');
});
