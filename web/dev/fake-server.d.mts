/** What checks in a browser use of the fake server. */
export function serve(port?: number): Promise<{
  url: string;
  /** Cuts all lines. */
  drop(): void;
  stop(): void;
}>;
