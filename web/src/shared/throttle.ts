/**
 * Sends the latest value of each key, at most one value per `interval_ms`. Values that were skipped are
 * merged into the latest one.
 */
export class Throttle<Value> {
  private readonly waiting = new Map<string, Value>();
  private busy = false;

  constructor(
    private readonly interval_ms: number,
    private readonly send: (key: string, value: Value) => void,
    private readonly merge: (waiting: Value, latest: Value) => Value,
    private readonly after: (ms: number, action: () => void) => void = later,
  ) {}

  put(key: string, value: Value): void {
    const skipped = this.waiting.get(key);
    // A repeated key moves to the end, so that values are sent in the order of the last `put`.
    this.waiting.delete(key);
    this.waiting.set(key, skipped === undefined ? value : this.merge(skipped, value));
    if (!this.busy) this.next();
  }

  private next(): void {
    const first = this.waiting.entries().next();
    this.busy = !first.done;
    if (first.done) return;
    const [key, value] = first.value;
    this.waiting.delete(key);
    this.send(key, value);
    this.after(this.interval_ms, () => this.next());
  }
}

function later(ms: number, action: () => void): void {
  setTimeout(action, ms);
}
