/** The fake server's studies, and what it answers of them. */
import { factorsOf, fault, planOf } from "./asking.mjs";
import { FakeStudy } from "./study.mjs";

const mostRunning = 2;

export class FakeStudies {
  constructor() {
    this.all = new Map();
  }

  /** Status and body of an answer, and its name as a file if it is one. */
  answer(method, path, query, body) {
    return this[`${method} ${path}`](method === "POST" ? body : query);
  }

  "POST /api/factors"(asked) {
    if (asked.scenario === "broken")
      return refused(fault("robots.rover.count", null, "is missing: expected a whole number"));
    return [200, factorsOf(asked)];
  }

  "POST /api/plan"(ask) {
    const { faults, planned } = planOf(ask);
    if (faults) return [422, { faults }];
    return [200, { ...planned, state: this.all.get(planned.id)?.state ?? null }];
  }

  "GET /api/studies"() {
    const listed = [...this.all.values()].map((study) => study.listed());
    return [200, { studies: listed.toSorted((a, b) => b.changed_s - a.changed_s) }];
  }

  "POST /api/studies"(ask) {
    const { faults, planned } = planOf(ask);
    if (faults) return [422, { faults }];
    const running = [...this.all].filter(([id, one]) => one.state === "running" && id !== planned.id);
    if (running.length >= mostRunning)
      return refused(
        fault("studies", null, `that run already are two: ${running.map(([id]) => id).join(", ")}`),
      );
    if (!this.all.has(planned.id)) this.all.set(planned.id, new FakeStudy(planned, ask));
    const study = this.all.get(planned.id);
    if (study.state !== "answered") study.run(null);
    return [201, study.listed()];
  }

  "POST /api/studies/stop"({ id }) {
    return this.with(id, (study) => {
      study.stop();
      return study.listed();
    });
  }

  "POST /api/studies/resume"({ id, confidence }) {
    const known = this.all.get(id)?.planned.confidence ?? 0;
    if (confidence !== null && !(confidence > known && confidence < 1))
      return refused(fault("confidence", confidence, `must be greater than ${known}, and less than 1`));
    return this.with(id, (study) => {
      study.run(confidence);
      return study.listed();
    });
  }

  "GET /api/study"(query) {
    const damaged = this.all.get(query.get("id"));
    if (damaged?.state === "damaged") return refused(fault("study", null, damaged.message));
    return this.with(query.get("id"), (study) => study.whole());
  }

  "GET /api/study/runs"(query) {
    return this.with(query.get("id"), (study) => study.runsOf(Number(query.get("configuration")), query));
  }

  "GET /api/study/answer"(query) {
    return [...this.with(query.get("id"), (study) => study.answer), "search-answer.json"];
  }

  "GET /api/study/report"(query) {
    return [...this.with(query.get("id"), (study) => study.answer.sentence), "search-report.html"];
  }

  follow(id, socket) {
    const study = this.all.get(id);
    if (study) return study.follow(socket);
    socket.send(
      JSON.stringify({ type: "studying", state: "damaged", standings: [], eliminated: [], labels: [] }),
    );
    socket.close(1000);
  }

  stop() {
    for (const study of this.all.values()) study.stop();
  }

  with(id, give) {
    const study = this.all.get(id);
    if (study) return [200, give(study)];
    return refused(fault("study", `"${id}"`, "must be the id of a study in the list"));
  }
}

function refused(...faults) {
  return [422, { faults }];
}
