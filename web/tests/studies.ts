import type { Page } from "@playwright/test";
import type { Study, StudyRequest, StudySummary } from "../src/api/study";
import { hang_ms } from "../dev/real-server.mjs";
import { expect, type RealServer, test as base } from "./page";

const computing_ms = 5 * hang_ms;

const request: StudyRequest = {
  scenario: "search",
  text: null,
  question: "merit",
  require: null,
  probability: null,
  tolerance: null,
  minimize: null,
  where: null,
  vary: {},
  design: null,
  delta: null,
  confidence: null,
  guarantee: null,
  merit: null,
  runs: null,
  max_runs: null,
  seed: "2",
};
/** Is answered within seconds, or within minutes on a busy machine. */
const short: StudyRequest = { ...request, vary: { "robots.rover.count": "1..5" }, delta: 0.3 };
/** Runs until it is stopped. */
const long: StudyRequest = {
  ...request,
  vary: { "robots.rover.count": "1..9", "items.mine.count": "4,5" },
  delta: 0.0001,
};

/** `answered` is the id of a study with an answer, shared by the tests of a worker; `race` that of a running one. */
export const test = base.extend<{ race: string }, { answered: string }>({
  race: async ({ server }, use) => {
    const { id } = await post(server, "studies", long);
    await use(id);
    await post(server, "studies/stop", { id });
  },
  answered: [
    async ({ server }, use) => {
      const { id } = await post(server, "studies", short);
      const state = async () => (await summaryOf(server, id)).state;
      await expect.poll(state, { timeout: computing_ms }).toBe("answered");
      await use(id);
    },
    { scope: "worker", timeout: computing_ms },
  ],
});

export async function post({ url }: RealServer, path: string, body: object): Promise<StudySummary> {
  const headers = { "Content-Type": "application/json" };
  const response = await fetch(`${url}/api/${path}`, { method: "POST", headers, body: JSON.stringify(body) });
  return (await response.json()) as StudySummary;
}

export async function summaryOf({ url }: RealServer, id: string): Promise<StudySummary> {
  const { studies } = (await (await fetch(`${url}/api/studies`)).json()) as { studies: StudySummary[] };
  const found = studies.find((study) => study.id === id);
  if (!found) throw new Error(`there is no study ${id}`);
  return found;
}

/** Alters a study on its way to the page. */
export async function alterStudy(page: Page, values: Partial<Study>): Promise<void> {
  await page.route("**/api/study?*", async (route) => {
    const response = await route.fetch();
    await route.fulfill({ response, json: { ...(await response.json()), ...values } });
  });
}

export const studyAt = ({ url }: RealServer, id: string) => `${url}/#/study?id=${id}`;
export const formAt = ({ url }: RealServer, scenario = "search") => `${url}/#/study/new?scenario=${scenario}`;
export const recommendation = (page: Page) =>
  page.getByText(/^Send \d rovers?(\.$| only if that is acceptable)/);

export async function openAnswer(page: Page, server: RealServer, id: string): Promise<void> {
  await page.goto(studyAt(server, id));
  await expect(recommendation(page)).toBeVisible();
}
