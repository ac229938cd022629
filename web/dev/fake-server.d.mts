/** The part of the fake server that tests use. */
export function serve(port?: number): Promise<{
  url: string;
  /** Drops all connections. */
  drop(): void;
  stop(): void;
}>;
