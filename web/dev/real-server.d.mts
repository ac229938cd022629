/** What checks in a browser use of the real server. */
export class RealServer {
  url: string;
  folder: string;
  process: { pid: number } | null;
  start(): Promise<void>;
  kill(): Promise<void>;
  end(): Promise<void>;
}
