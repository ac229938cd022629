/** The recordings of the fake server, including those that pages save. */
export class FakeRecordings {
  constructor() {
    this.runs = new Map();
    this.damaged = {
      id: "old/damaged.mcap",
      bytes: 19,
      saved_at_s: 1.6e9,
      run: null,
      error: "is not an MCAP file, or is damaged: not a valid MCAP file",
    };
    const made = { scenario: "search", text: null, seed: "3", run: "0" };
    this.put("field.mcap", { ...made, changes: [[20, "robots.rover.count", 6]], edge: 200 });
  }

  put(id, run) {
    this.runs.set(id, run);
    return this.entry(id, run);
  }

  find(id) {
    return this.runs.get(id);
  }

  entry(id, { scenario, seed, run, edge }) {
    const of = { scenario: `${scenario ?? "scenario"}.toml`, seed, run, program: "0.1.0" };
    const bytes = 4000 + 500 * edge;
    return {
      id,
      bytes,
      saved_at_s: 1.7e9 + this.runs.size,
      run: { ...of, steps: edge, length_s: edge / 10 },
      error: null,
    };
  }

  listed() {
    const rows = [...this.runs].map(([id, run]) => this.entry(id, run));
    return [...rows.reverse(), this.damaged];
  }
}
