import type { APIRequestContext, Page } from "@playwright/test";
import { expect, expectAccessible, runAt, test } from "./page";

const plain = {
  scenario: "search",
  text: null,
  vary: {},
  design: null,
  delta: null,
  confidence: null,
  guarantee: null,
  merit: null,
  runs: null,
  max_runs: null,
  seed: "0",
};
/** Does not end during a test: the number of mines makes no difference to the fake server's robots. */
const long = {
  ...plain,
  vary: { "robots.rover.count": "1..9", "items.mine.count": "4,5" },
  delta: 0.0001,
};

interface At {
  url: string;
}

async function start(request: APIRequestContext, fake: At, ask: object = plain): Promise<string> {
  const answer = await request.post(`${fake.url}/api/studies`, { data: ask });
  return ((await answer.json()) as { id: string }).id;
}

const at = (fake: At, id: string) => `${fake.url}/#/study?id=${id}`;
const sentence = (page: Page) => page.getByText(/^Send \d rovers?\. A run takes/);

async function answered(page: Page, fake: At) {
  await page.goto(at(fake, await start(page.request, fake)));
  await expect(sentence(page)).toBeVisible({ timeout: 10_000 });
}

test("without studies the page explains what a study is and how to start one", async ({ page, fake }) => {
  await page.goto(fake.url);
  await page.getByRole("link", { name: "Studies" }).click();
  await expect(page.getByRole("heading", { name: "No studies yet" })).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "New study" }).click();
  await expect(page.getByRole("link", { name: /^search Four items/ })).toBeVisible();
  await expectAccessible(page);
});

test("a study is defined, started and answered by keyboard alone", async ({ page, fake }) => {
  await page.goto(fake.url);
  await page.getByRole("link", { name: "Study search", exact: true }).focus();
  await page.keyboard.press("Enter");
  const team = page.getByRole("textbox", { name: "Number of rovers" });
  await expect(team).toHaveValue("1..9");
  await team.focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("1..6");
  await expect(page.getByText("factorial: 6 configurations")).toBeVisible();
  await page.keyboard.press("Enter");
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expect(page.getByText(/^\d of 6$/)).toBeVisible();
  await expect(sentence(page)).toBeVisible({ timeout: 10_000 });
});

test("errors are displayed beside their fields, and the study cannot be started", async ({ page, fake }) => {
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  const team = page.getByRole("textbox", { name: "Number of rovers" });
  await team.fill("1..4x");
  await expect(team).toHaveAccessibleDescription(/must be a string of values/);
  await expect(page.getByRole("button", { name: "Start" })).toBeDisabled();
  await page.getByRole("textbox", { name: "Confidence" }).fill("high");
  await expect(page.getByRole("textbox", { name: "Confidence" })).toHaveAccessibleDescription(
    /must be a number/,
  );
  await expectAccessible(page);
  await page.getByRole("textbox", { name: "Confidence" }).fill("");
  await team.fill("");
  await expect(page.getByText("No factor is varied")).toBeVisible();
  await team.fill("1..4");
  await expect(page.getByRole("button", { name: "Start" })).toBeEnabled();
});

test("an error under More options opens that section", async ({ page, fake }) => {
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  await page.getByText("More options", { exact: true }).click();
  await page.getByRole("textbox", { name: "Seed" }).fill("minus one");
  await expect(page.getByRole("textbox", { name: "Seed" })).toHaveAccessibleDescription(/whole number/);
  await expectAccessible(page);
});

test("further factors are found by name, added and removed", async ({ page, fake }) => {
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  await page.getByText("Add a factor").click();
  await page.getByRole("searchbox").fill("camera range");
  await expect(page.getByText("1 parameter", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: "Vary robots.rover.sensors.camera.range_m" }).click();
  const range = page.getByRole("textbox", { name: "robots.rover.sensors.camera.range_m" });
  await expect(range).toBeFocused();
  await range.fill("2,4");
  await expect(page.getByText("factorial: 18 configurations")).toBeVisible();
  await page.getByText("Add a factor").click();
  await page.getByRole("button", { name: /^Vary .*arbitration.kind/ }).click();
  await page.getByRole("checkbox", { name: "goals" }).check();
  await page.getByRole("checkbox", { name: "schemas" }).check();
  await expect(page.getByText("factorial: 36 configurations")).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Remove robots.rover.sensors.camera.range_m" }).click();
  await expect(page.getByText("factorial: 18 configurations")).toBeVisible();
});

test("an invalid scenario cannot be studied, with the server's message", async ({ page, fake }) => {
  await page.goto(`${fake.url}/#/study/new?scenario=broken`);
  await expect(page.getByRole("alert")).toContainText("robots.rover.count is missing");
  await expectAccessible(page);
});

test("the race is displayed as text and as a table, stops and resumes", async ({ page, fake }) => {
  await page.goto(at(fake, await start(page.request, fake, long)));
  await expect(
    page.getByRole("status").filter({ hasText: /^Running: \d+ configurations of 18/ }),
  ).toHaveCount(1);
  await expect(page.getByText(/eliminated by \d rovers?, count \d after \d+ runs/).first()).toBeVisible();
  await page.getByRole("button", { name: "Table" }).click();
  await expect(page.getByRole("columnheader", { name: "merit" })).toBeVisible();
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByText("Stopped", { exact: true })).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Chart" }).click();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Resume" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
  await expect(page.getByText("runs per second")).toBeVisible();
});

test("a study is loaded once when it is opened", async ({ page, fake }) => {
  const id = await start(page.request, fake, long);
  let requests = 0;
  page.on("request", (request) => (requests += Number(request.url().includes("api/study?"))));
  await page.goto(at(fake, id));
  await expect(page.getByText("runs per second")).toBeVisible();
  await expect(page.getByText(/eliminated by/).first()).toBeVisible();
  expect(requests).toBe(1);
});

test("a study that is answered while it is being stopped displays its answer", async ({ page, fake }) => {
  await page.route("**/api/studies/stop", async (route) => {
    const { studies } = await (await page.request.get(`${fake.url}/api/studies`)).json();
    await route.fulfill({ json: { ...studies[0], state: "answered" } });
  });
  await page.goto(at(fake, await start(page.request, fake)));
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(sentence(page)).toBeVisible({ timeout: 10_000 });
});

test("a study that another page resumed is displayed as running", async ({ page, fake }) => {
  const id = await start(page.request, fake, long);
  await page.goto(at(fake, id));
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await page.request.post(`${fake.url}/api/studies/resume`, { data: { id, confidence: null } });
  await page.route("**/api/studies/resume", (route) => route.fulfill({ status: 422, json: { errors: [] } }));
  await page.getByRole("button", { name: "Resume" }).click();
  await expect(page.getByRole("button", { name: "Stop" })).toBeVisible();
});

test("an unreadable study is reported under a heading", async ({ page, fake }) => {
  await page.route("**/api/study?*", (route) => route.abort("connectionfailed"));
  await page.goto(at(fake, await start(page.request, fake, long)));
  await expect(page.getByRole("heading", { name: "studies/" })).toBeVisible();
  await expect(page.getByText("The server is not responding.")).toBeVisible();
  await expectAccessible(page);
});

test("the race passes axe", async ({ page, fake }) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  await page.goto(at(fake, await start(page.request, fake, long)));
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expectAccessible(page);
});

test("an answer has its sentence, guarantee, charts with tables, and files", async ({ page, fake }) => {
  await answered(page, fake);
  await expect(page.getByText("selected one with 95% confidence")).toBeVisible();
  await expect(
    page.getByRole("img", { name: /^Figure of merit with its interval/ }).locator("svg"),
  ).toBeVisible();
  await expect(page.getByRole("row", { name: /^4 rovers/ }).first()).toBeVisible();
  await page.getByText("Table of values").first().click();
  await expect(page.getByRole("columnheader", { name: "mean time, s" })).toBeVisible();
  await expectAccessible(page);
  const [saved] = await Promise.all([
    page.waitForEvent("download"),
    page.getByRole("link", { name: "Report (HTML)" }).click(),
  ]);
  expect(saved.suggestedFilename()).toBe("search-report.html");
});

test("charts follow the theme and the width of the window", async ({ page, fake }) => {
  await answered(page, fake);
  const chart = page.getByRole("img", { name: /^Figure of merit with its interval/ });
  const width = () =>
    chart
      .locator("svg")
      .first()
      .evaluate((svg) => svg.getBoundingClientRect().width);
  const ink = () =>
    chart
      .locator(".role-axis-title text")
      .first()
      .evaluate((text) => getComputedStyle(text).fill);
  await expect.poll(width).toBeGreaterThan(900);
  const before = await ink();
  await page.setViewportSize({ width: 700, height: 800 });
  await expect.poll(width).toBeLessThan(660);
  await page.emulateMedia({ colorScheme: "dark" });
  await expect.poll(ink).not.toBe(before);
});

test("a click on a point of a chart opens the runs of its configuration, and from there a run", async ({
  page,
  fake,
}) => {
  await answered(page, fake);
  const chart = page.getByRole("img", { name: /^Figure of merit with its interval/ });
  await chart.locator(".mark-symbol.role-mark path").nth(3).click();
  const dialog = page.getByRole("dialog", { name: "Runs of 4 rovers" });
  await expect(dialog.getByRole("row", { name: /^median/ })).toBeVisible();
  await expectAccessible(page);
  const link = dialog.getByRole("row", { name: /^worst/ }).getByRole("link");
  const run = (await link.textContent()) ?? "";
  await link.click();
  await expect(page.getByRole("heading", { name: `Run ${run} of search, 4 rovers` })).toBeVisible();
  await expect(page.locator("#status")).toContainText("4 robots");
  await expectAccessible(page);
  await page.getByRole("link", { name: "Back to the study" }).click();
  await expect(dialog).toBeVisible();
  await page.keyboard.press("Escape");
  await expect(dialog).toBeHidden();
  await expect(sentence(page)).toBeVisible();
  await expect.poll(() => page.url()).not.toContain("configuration");
  // Back to the run, not to the dialog that was closed.
  await page.goBack();
  await expect(page.getByRole("heading", { name: `Run ${run} of search, 4 rovers` })).toBeVisible();
  await expect(dialog).toBeHidden();
});

test("all runs of a configuration can be paged through", async ({ page, fake }) => {
  await answered(page, fake);
  await page.getByRole("link", { name: "3 rovers" }).first().click();
  await page.getByText("All runs", { exact: true }).click();
  await expect(page.getByText(/^1 to 50 of [\d,]+, in order/)).toBeVisible();
  await page.getByRole("button", { name: "Next" }).click();
  await expect(page.getByText(/^51 to 100 of/)).toBeVisible();
  await expect(page.getByRole("link", { name: "Watch run 50", exact: true })).toBeVisible();
  await page.getByRole("button", { name: "Previous" }).click();
  await expect(page.getByText(/^1 to 50 of/)).toBeVisible();
});

test("the confidence of an answer is raised, and an invalid value is reported beside the field", async ({
  page,
  fake,
}) => {
  await answered(page, fake);
  const box = page.getByRole("textbox", { name: /^Raise confidence/ });
  await expect(box).toHaveValue("0.99");
  await box.fill("0.5");
  await page.getByRole("button", { name: "Raise" }).click();
  await expect(page.getByText("must be greater than 0.95")).toBeVisible();
  await expectAccessible(page);
  await box.fill("0.99");
  await box.press("Enter");
  // The few additional runs may finish before the page displays them.
  await expect(page.getByText("selected one with 99% confidence")).toBeVisible({ timeout: 10_000 });
});

test("studies are listed with their state, newest first, and the list is updated", async ({ page, fake }) => {
  await start(page.request, fake, { ...plain, seed: "13" });
  await expect(async () => {
    const { studies } = await (await page.request.get(`${fake.url}/api/studies`)).json();
    expect(studies[0].state).toBe("stopped");
  }).toPass();
  await start(page.request, fake, long);
  await start(page.request, fake);
  await page.goto(`${fake.url}/#/studies`);
  await expect(page.getByRole("listitem")).toHaveCount(3);
  await expect(page.getByRole("link", { name: /^Stopped.*The disk is full/ })).toBeVisible();
  await expect(page.getByRole("link", { name: /^Running/ }).first()).toBeVisible();
  await expectAccessible(page);
  await expect(page.getByRole("link", { name: /^Answered search studies\/search Send/ })).toBeVisible({
    timeout: 10_000,
  });
});

test("a study that failed displays its error and can be resumed", async ({ page, fake }) => {
  await page.goto(at(fake, await start(page.request, fake, { ...plain, seed: "13" })));
  await expect(page.getByRole("alert")).toContainText("The disk is full");
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await expectAccessible(page);
});

test("missing and damaged studies are reported with the server's message", async ({ page, fake }) => {
  await page.goto(at(fake, "studies/none"));
  await expect(page.getByRole("alert")).toContainText("must be the id of a study in the list");
  await expectAccessible(page);
  await page.goto(at(fake, await start(page.request, fake, { ...plain, seed: "14" })));
  await expect(page.getByRole("alert")).toContainText("ledger.sqlite is damaged");
  await page.getByRole("link", { name: "Other studies" }).click();
  await expect(page.getByRole("link", { name: /^Damaged/ })).toContainText("ledger.sqlite is damaged");
  await expectAccessible(page);
});

test("a study that cannot start now is refused with a reason, and can be started later", async ({
  page,
  fake,
}) => {
  const first = await start(page.request, fake, long);
  await start(page.request, fake, { ...long, seed: "1" });
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText("that run already are two")).toBeVisible();
  await expectAccessible(page);
  await page.request.post(`${fake.url}/api/studies/stop`, { data: { id: first } });
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
});

test("a lost connection is reported at once, and the race continues", async ({ page, fake }) => {
  await page.goto(at(fake, await start(page.request, fake, long)));
  await expect(page.getByText("runs per second")).toBeVisible();
  fake.drop();
  await expect(page.getByText("The connection is lost.")).toBeVisible();
  await expect(page.getByText("runs per second")).toBeVisible();
  await expectAccessible(page);
  await expect(page.getByText("The connection is lost.")).toBeHidden();
  const runs = () =>
    page
      .getByText(/^[\d,]+$/)
      .first()
      .textContent();
  const before = await runs();
  await expect.poll(runs).not.toBe(before);
});

test("a missing server is reported on lists and forms, which recover by themselves", async ({
  page,
  fake,
  context,
}) => {
  await start(page.request, fake, long);
  await page.goto(`${fake.url}/#/studies`);
  await expect(page.getByRole("listitem")).toHaveCount(1);
  await context.setOffline(true);
  await expect(page.getByText("The server is not responding.")).toBeVisible();
  await expect(page.getByRole("listitem")).toHaveCount(1);
  await expectAccessible(page);
  await context.setOffline(false);
  await expect(page.getByText("The server is not responding.")).toBeHidden();
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  const team = page.getByRole("textbox", { name: "Number of rovers" });
  await expect(team).toBeVisible();
  await context.setOffline(true);
  await team.fill("1..5");
  await expect(page.getByText("The server is not responding. Retrying.")).toBeVisible();
  await context.setOffline(false);
  await expect(page.getByText("factorial: 5 configurations")).toBeVisible();
});

test("a scenario can be studied from its run, also a dropped one", async ({ page, fake }) => {
  await page.goto(runAt(fake, "scenario=search&seed=7"));
  await page.getByRole("link", { name: "Study this scenario" }).click();
  await expect(page.getByRole("heading", { name: "New study of search" })).toBeVisible();
  await page.goto(fake.url);
  const file = { name: "my.toml", mimeType: "application/toml", buffer: Buffer.from('engine = "metric"\n') };
  await page.locator("input[type=file]").setInputFiles(file);
  await page.getByRole("link", { name: "Study this scenario" }).click();
  await expect(page.getByRole("heading", { name: "New study of my scenario" })).toBeVisible();
});

test("studies are usable on a phone", async ({ page, fake }) => {
  await page.setViewportSize({ width: 360, height: 740 });
  const fits = async () =>
    expect(
      await page.evaluate(() => [document.documentElement.scrollWidth, document.body.scrollWidth]),
    ).toEqual([360, 360]);
  await page.goto(`${fake.url}/#/study/new?scenario=search`);
  await expect(page.getByText("factorial: 9 configurations")).toBeVisible();
  await fits();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await fits();
  await expect(sentence(page)).toBeVisible({ timeout: 10_000 });
  await expect(page.getByRole("img", { name: /^Runs per/ }).locator("svg")).toBeVisible();
  await fits();
  await expectAccessible(page);
  await page.getByRole("link", { name: "3 rovers" }).first().click();
  await expect(page.getByRole("dialog")).toBeVisible();
  await fits();
  await page.goto(`${fake.url}/#/studies`);
  await expect(page.getByRole("listitem")).toHaveCount(1);
  await fits();
  await expectAccessible(page);
});
