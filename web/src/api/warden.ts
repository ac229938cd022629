import type { Drive, Level, Warden } from "./generated/warden";
import { tokenFields } from "./token";

export type * from "./generated/warden";

export const levels: readonly Level[] = ["info", "warning", "error"];

/** A degree and minute of a latitude or longitude, as the warden takes it. */
export interface Angle {
  degrees: number;
  minutes: number;
  hemisphere: string;
}

export type Answer<Body> =
  | { kind: "answered"; body: Body }
  /** The request is not possible now. */
  | { kind: "conflict"; message: string }
  /** The token is wrong, or this page's origin is not the warden's. */
  | { kind: "refused" }
  | { kind: "failed" };

/** The drive of this page's server; null if it has none. Throws if the server does not respond. */
export async function findDrive(): Promise<Drive | null> {
  const response = await fetch("drive", { cache: "no-store", headers: tokenFields() });
  if (response.status === 404) return null;
  if (!response.ok) throw new Error(`The server responded ${response.status} ${response.statusText}.`);
  return (await response.json()) as Drive | null;
}

/**
 * Sends a request to the warden, the process that owns the robots of a drive. It does not pass through the server of
 * the page. Its body is of content type text/plain (no preflight); every answer is JSON. `keepalive` lets it outlive
 * the page.
 */
export function post(
  { port, token }: Warden,
  path: string,
  body: object,
  options: { signal?: AbortSignal; keepalive?: boolean } = {},
): Promise<Response> {
  return fetch(`http://127.0.0.1:${port}${path}`, {
    method: "POST",
    headers: { "Content-Type": "text/plain" },
    body: JSON.stringify({ token, ...body }),
    credentials: "omit",
    ...options,
  });
}

/** As `post`, with the answer sorted by its kind. Never throws. */
export async function ask<Body>(
  warden: Warden,
  path: string,
  body: object,
  signal: AbortSignal,
): Promise<Answer<Body>> {
  try {
    const response = await post(warden, path, body, { signal });
    if (response.status === 401 || response.status === 403) return { kind: "refused" };
    const content: unknown = await response.json();
    if (response.ok) return { kind: "answered", body: content as Body };
    const { message } = (content ?? {}) as { message?: unknown };
    return {
      kind: "conflict",
      message: typeof message === "string" ? message : "The warden gave no reason.",
    };
  } catch {
    return { kind: "failed" };
  }
}
