import { cp, rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import { altered, droppable, expect, expectAccessible, expectReportAtOnce } from "./page";
import { alterStudy, post, recommendation, studyAt, summaryOf, test } from "./studies";

test("the race is displayed as text and as a table, and is stopped and resumed", async ({
  page,
  server,
  race,
}) => {
  let requests = 0;
  page.on("request", (request) => (requests += Number(request.url().includes("api/study?"))));
  await page.goto(studyAt(server, race));
  await expect(page.getByRole("status").filter({ hasText: /^Running: \d+ of 18 remaining/ })).toHaveCount(1);
  await expect(page.getByText("runs per second")).toBeVisible();
  await expect(
    page.getByText(/eliminated by items.mine.count \d, \d rovers? after \d+ runs/).first(),
  ).toBeVisible();
  // The study is loaded once when it is opened.
  expect(requests).toBe(1);
  await page.getByRole("button", { name: "Table" }).click();
  await expect(page.getByRole("columnheader", { name: "merit" })).toBeVisible();
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByText("Stopped", { exact: true })).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Chart" }).click();
  await expectAccessible(page);
  await page.getByRole("link", { name: "Studies", exact: true }).click();
  await page.getByRole("link", { name: new RegExp(`^Stopped search ${race} `) }).click();
  await page.getByRole("button", { name: "Resume" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
  await expect(page.getByText("runs per second")).toBeVisible();
});

test("a study that another page resumed is displayed as running", async ({ page, server, race }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto(studyAt(server, race));
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await post(server, "studies/resume", { id: race, confidence: null });
  await page.route("**/api/studies/resume", (route) => route.fulfill({ status: 422, json: { errors: [] } }));
  await page.getByRole("button", { name: "Resume" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
});

test("a lost connection is reported at once, and the race continues", async ({ page, server, race }) => {
  const line = await droppable(page);
  const reportsAtOnce = await expectReportAtOnce(page);
  await page.goto(studyAt(server, race));
  await expect(page.getByText("runs per second")).toBeVisible();
  await reportsAtOnce(() => line.drop());
  await expect(page.getByText("runs per second")).toBeVisible();
  await expectAccessible(page);
  line.restore();
  await expect(page.getByText("The connection is lost.")).toBeHidden();
  const runs = () =>
    page
      .getByText(/^[\d,]+$/)
      .first()
      .textContent();
  const before = await runs();
  await expect.poll(runs).not.toBe(before);
});

test("a study that is answered while it is being stopped displays its answer", async ({
  page,
  server,
  answered,
}) => {
  let showAnswer = () => {};
  const stopped = new Promise<void>((done) => (showAnswer = done));
  await page.routeWebSocket(/\/ws/, (line) => {
    const study = line.connectToServer();
    study.onClose(() => {});
    study.onMessage(async (data) => {
      line.send(JSON.stringify({ ...JSON.parse(String(data)), state: "running" }));
      await stopped;
      line.send(data);
    });
  });
  const summary = await summaryOf(server, answered);
  await page.route("**/api/studies/stop", async (route) => {
    await route.fulfill({ json: summary });
    showAnswer();
  });
  await page.goto(studyAt(server, answered));
  await expect(recommendation(page)).toHaveCount(0);
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(recommendation(page)).toBeVisible();
});

test("a study that failed displays its error and can be resumed", async ({ page, server, answered }) => {
  const message = "The disk is full. Free some space, then resume the study.";
  const failed = { state: "stopped", message } as const;
  await altered(page, (sent) => (sent.type === "study_progress" ? { ...sent, ...failed } : sent));
  await alterStudy(page, { ...failed, answer: null });
  await page.goto(studyAt(server, answered));
  await expect(page.getByRole("alert")).toContainText("The disk is full");
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await expectAccessible(page);
});

test("missing and damaged studies are reported with the server's message", async ({
  page,
  server,
  answered,
}) => {
  const damaged = join(server.folder, "studies/damaged");
  await cp(join(server.folder, answered), damaged, { recursive: true });
  await rm(join(damaged, "answer.json"));
  await writeFile(join(damaged, "ledger.sqlite"), "not a ledger");
  await page.goto(studyAt(server, "studies/damaged"));
  await expect(page.getByRole("alert")).toContainText("ledger.sqlite: cannot be read as a ledger");
  await page.goto(studyAt(server, "studies/none"));
  await expect(page.getByRole("alert")).toContainText("must be the id of a study in the list");
  await expectAccessible(page);
  await page.getByRole("link", { name: "Other studies" }).click();
  await expect(page.getByRole("link", { name: /^Damaged/ })).toContainText(
    "ledger.sqlite: cannot be read as a ledger",
  );
  await expectAccessible(page);
  await rm(damaged, { recursive: true });
});

test("an unreadable study is reported under a heading", async ({ page, server, answered }) => {
  await page.route("**/api/study?*", (route) => route.abort("connectionfailed"));
  await page.goto(studyAt(server, answered));
  await expect(page.getByRole("heading", { name: "studies/" })).toBeVisible();
  await expect(page.getByText("The server is not responding.")).toBeVisible();
  await expectAccessible(page);
});

test("a killed server is reported at once, and the study is read from its folder", async ({
  page,
  ownServer,
}) => {
  const reportsAtOnce = await expectReportAtOnce(page);
  await page.goto(`${ownServer.url}/#/study/new?scenario=search`);
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText("runs per second")).toBeVisible();
  await reportsAtOnce(() => ownServer.kill());
  await ownServer.start();
  await expect(page.getByText("The connection is lost.")).toBeHidden();
  await expect(page.getByText(/^(Running|Stopped)$/)).toBeVisible();
});
