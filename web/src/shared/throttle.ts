/** Hands on the latest value of each key, joined with those that it passed by, at most one in `interval_ms`. */
export class Throttle<Value> {
  private readonly waiting = new Map<string, Value>();
  private busy = false;

  constructor(
    private readonly interval_ms: number,
    private readonly send: (key: string, value: Value) => void,
    private readonly joined: (waiting: Value, latest: Value) => Value,
    private readonly after: (ms: number, action: () => void) => void = later,
  ) {}

  put(key: string, value: Value): void {
    const passed = this.waiting.get(key);
    // A key that comes again goes to the end, so that what is sent is in the order in which it was put.
    this.waiting.delete(key);
    this.waiting.set(key, passed === undefined ? value : this.joined(passed, value));
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
