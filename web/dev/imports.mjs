// Checks which modules of src import which: no circles, and each layer uses only the layers below it.
// dependency-cruiser and madge see Svelte components only as compiled, without their type imports; so the
// imports are read by TypeScript from the source.
import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import ts from "typescript";

/** The layers that each may use besides itself; a page uses no other page. */
const uses = {
  api: [],
  shared: ["api"],
  canvas: ["api", "shared"],
  pages: ["api", "shared", "canvas"],
};

/** The modules that each module imports, as `{ [path]: path[] }`. Throws for an import that leads nowhere. */
export function importsOf(/** @type {Record<string, string>} */ sources) {
  const resolve = (from, name) => {
    const base = normalize(join(dirname(from), name));
    const found = [base, `${base}.ts`, `${base}/index.ts`].find((path) => path in sources);
    if (!found && !/\.(css|json)$/.test(name)) throw new Error(`${from}: cannot resolve "${name}"`);
    return found;
  };
  const read = ([path, text]) => {
    const names = ts.preProcessFile(scriptsOf(path, text)).importedFiles.map(({ fileName }) => fileName);
    const local = names.filter((name) => name.startsWith(".")).map((name) => resolve(path, name));
    return [path, local.filter(Boolean)];
  };
  return Object.fromEntries(Object.entries(sources).map(read));
}

/** Each import that goes round in a circle or up a layer, in words. */
export function importErrors(/** @type {Record<string, string[]>} */ imports) {
  return [...circles(imports), ...layerErrors(imports)];
}

function scriptsOf(path, text) {
  if (!path.endsWith(".svelte")) return text;
  return [...text.matchAll(/<script[^>]*>([\s\S]*?)<\/script>/g)].map(([, script]) => script).join("\n");
}

/** Depth first: an import of a module that is still being visited closes a circle. */
function circles(imports) {
  const errors = [];
  const done = new Set();
  const visit = (module, trail) => {
    const start = trail.indexOf(module);
    if (start >= 0) errors.push(`import circle: ${[...trail.slice(start), module].join(" -> ")}`);
    if (start >= 0 || done.has(module)) return;
    for (const next of imports[module] ?? []) visit(next, [...trail, module]);
    done.add(module);
  };
  for (const module of Object.keys(imports)) visit(module, []);
  return errors;
}

function layerErrors(imports) {
  const pairs = Object.entries(imports).flatMap(([from, all]) => all.map((to) => [from, to]));
  return pairs.filter((pair) => !isAllowed(...pair)).map(([from, to]) => `${from} must not import ${to}`);
}

function isAllowed(from, to) {
  const [[layer, page], [other, otherPage]] = [from.split("/"), to.split("/")];
  if (!(layer in uses)) return true;
  return layer === other ? layer !== "pages" || page === otherPage : uses[layer].includes(other);
}

function sourcesIn(folder) {
  const files = readdirSync(folder, { recursive: true, encoding: "utf8" });
  const modules = files.filter((path) => /\.(ts|svelte)$/.test(path));
  return Object.fromEntries(modules.map((path) => [path, readFileSync(join(folder, path), "utf8")]));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const imports = importsOf(sourcesIn(fileURLToPath(new URL("../src", import.meta.url))));
  const errors = importErrors(imports);
  for (const error of errors) console.error(error);
  console.log(`imports: ${Object.keys(imports).length} modules, ${errors.length} errors`);
  process.exitCode = errors.length > 0 ? 1 : 0;
}
