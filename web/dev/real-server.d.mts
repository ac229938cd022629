export const program: string;
export const hang_ms: number;

/** The part of the real server that tests use. */
export class RealServer {
  url: string;
  folder: string;
  process: { pid: number } | null;
  start(): Promise<void>;
  kill(): Promise<void>;
  end(): Promise<void>;
}
