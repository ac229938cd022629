/**
 * Implements the interface of the real server without a simulator, for development and browser tests. Run it
 * with a port. Scenario `crowd-N` has N robots; `broken` and `full` are refused. A study with seed 13 fails
 * with a full disk; one with seed 14 is damaged.
 */
import { readFile } from "node:fs/promises";
import { createServer } from "node:http";
import { extname, join, normalize } from "node:path";
import { fileURLToPath } from "node:url";
import { WebSocketServer } from "ws";
import { pictureOf } from "./fake/run.mjs";
import { documentOf, entries } from "./fake/scenarios.mjs";
import { FakeStudies } from "./fake/studies.mjs";
import { FakeRunConnection } from "./fake/run_connection.mjs";

const here = fileURLToPath(new URL("..", import.meta.url));
const kinds = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const policy = "default-src 'self'; img-src 'self' data:; style-src 'self'";

/** Starts the server. Returns its address and functions that drop its connections and stop it. */
export async function serve(port = 0) {
  const studies = new FakeStudies();
  const server = createServer((request, answer) =>
    handle(request, answer, { studies }).catch(() => send(answer, 404, "text/plain", "not found")),
  );
  const sockets = new WebSocketServer({ server, path: "/ws", perMessageDeflate: false });
  sockets.on("connection", (socket, request) => {
    const study = new URL(request.url, "http://localhost").searchParams.get("study");
    if (study === null) new FakeRunConnection(socket, { studies });
    else studies.follow(study, socket);
  });
  await new Promise((ready) => server.listen(port, "127.0.0.1", ready));
  const drop = () => {
    for (const socket of sockets.clients) socket.terminate();
  };
  const stop = () => {
    drop();
    studies.stop();
    server.close();
  };
  return { url: `http://127.0.0.1:${server.address().port}`, drop, stop };
}

async function handle(request, answer, { studies }) {
  const { pathname, searchParams } = new URL(request.url, "http://localhost");
  if (/^\/api\/(factors|plan|stud)/.test(pathname)) {
    const body = request.method === "POST" ? JSON.parse(await bodyOf(request)) : null;
    const [status, reply, name] = studies.answer(request.method, pathname, searchParams, body);
    if (name) answer.setHeader("Content-Disposition", `attachment; filename="${name}"`);
    return send(answer, status, "application/json", JSON.stringify(reply));
  }
  if (pathname === "/api/scenarios") return send(answer, 200, "application/json", JSON.stringify(entries));
  if (pathname === "/api/pictures")
    return send(answer, 200, "image/svg+xml", pictureOf(documentOf(searchParams.get("scenario"))));
  if (pathname === "/api/schema")
    return send(answer, 200, "application/json", await readFile(join(here, "../schemas/metric.schema.json")));
  if (pathname === "/api/check") return check(request, answer);
  const file = normalize(pathname === "/" ? "/index.html" : pathname);
  send(answer, 200, kinds[extname(file)] ?? "text/plain", await readFile(join(here, "dist", file)));
}

async function bodyOf(request) {
  const parts = [];
  for await (const part of request) parts.push(part);
  return Buffer.concat(parts).toString();
}

async function check(request, answer) {
  const lines = (await bodyOf(request)).split("\n");
  const errors = lines.flatMap((line, i) => (/raduis|-3/.test(line) ? [errorAt(i + 1, line)] : []));
  const good = { name: "my scenario", engine: "metric", summary: "A scenario." };
  send(
    answer,
    errors.length > 0 ? 422 : 200,
    "application/json",
    JSON.stringify(errors.length > 0 ? { errors } : good),
  );
}

function errorAt(line, text) {
  const [path, given] = text.split("=").map((part) => part.trim());
  const message = `robots.rover.${path} is not a known key: expected one of like, count, layer, radius_m; did you mean radius_m?`;
  return {
    file: null,
    line,
    path: `robots.rover.${path}`,
    given,
    allowed: "",
    suggestion: "radius_m",
    message,
  };
}

function send(answer, status, kind, body) {
  answer.writeHead(status, { "Content-Type": kind, "Content-Security-Policy": policy });
  answer.end(body);
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const { url } = await serve(Number(process.argv[2] ?? 8123));
  console.log(url);
}
