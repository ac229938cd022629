/** The studies of the fake server, and its HTTP interface to them. */
import { factorsOf, inputError, planOf } from "./study_form.mjs";
import { FakeStudy } from "./study.mjs";

const maxRunning = 2;

export class FakeStudies {
  constructor() {
    this.all = new Map();
  }

  /** The status and the body of a response, and the file name of a download. */
  answer(method, path, query, body) {
    return this[`${method} ${path}`](method === "POST" ? body : query);
  }

  "POST /api/factors"(source) {
    if (source.scenario === "broken")
      return refused(inputError("robots.rover.count", null, "is missing: expected a whole number"));
    return [200, factorsOf(source)];
  }

  "POST /api/plan"(ask) {
    const { errors, planned } = planOf(ask);
    if (errors) return [422, { errors }];
    return [200, { ...planned, state: this.all.get(planned.id)?.state ?? null }];
  }

  "GET /api/studies"() {
    const listed = [...this.all.values()].map((study) => study.listed());
    return [200, { studies: listed.toSorted((a, b) => b.changed_s - a.changed_s) }];
  }

  "POST /api/studies"(ask) {
    const { errors, planned } = planOf(ask);
    if (errors) return [422, { errors }];
    const running = [...this.all].filter(([id, one]) => one.state === "running" && id !== planned.id);
    if (running.length >= maxRunning)
      return refused(
        inputError("studies", null, `that run already are two: ${running.map(([id]) => id).join(", ")}`),
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
      return refused(inputError("confidence", confidence, `must be greater than ${known}, and less than 1`));
    return this.with(id, (study) => {
      study.run(confidence);
      return study.listed();
    });
  }

  "GET /api/study"(query) {
    const damaged = this.all.get(query.get("id"));
    if (damaged?.state === "damaged") return refused(inputError("study", null, damaged.message));
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
      JSON.stringify({ type: "study_progress", state: "damaged", standings: [], eliminated: [], labels: [] }),
    );
    socket.close(1000);
  }

  stop() {
    for (const study of this.all.values()) study.stop();
  }

  with(id, give) {
    const study = this.all.get(id);
    if (study) return [200, give(study)];
    return refused(inputError("study", `"${id}"`, "must be the id of a study in the list"));
  }
}

function refused(...errors) {
  return [422, { errors }];
}
