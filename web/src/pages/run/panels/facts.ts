/** A value with its name. */
export interface Fact {
  name: string;
  value: string;
  /** The signals that it consists of, if it can be drawn over time. */
  signals?: string[];
}
