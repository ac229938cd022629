import { rm, writeFile } from "node:fs/promises";
import { join } from "node:path";
import {
  altered,
  asOnPhone,
  expect,
  expectAccessible,
  expectToFit,
  openFile,
  openRun,
  ownScenario,
} from "./page";
import { hang_ms } from "../dev/real-server.mjs";
import { formAt, openAnswer, recommendation, test } from "./studies";

test("a study is defined, started and answered by keyboard alone, and its confidence is raised", async ({
  page,
  server,
}) => {
  let showAnswer = () => {};
  const raceWasSeen = new Promise<void>((done) => (showAnswer = done));
  await altered(page, async (message) => {
    if (message.type === "study_progress" && message.state === "answered") await raceWasSeen;
    return message;
  });
  await page.goto(server.url);
  await page.getByRole("link", { name: "Study search", exact: true }).focus();
  await page.keyboard.press("Enter");
  const team = page.getByRole("textbox", { name: "Number of rovers" });
  await expect(team).toHaveValue("1..20");
  await team.focus();
  await page.keyboard.press("Control+a");
  await page.keyboard.type("1..6");
  await page.getByRole("textbox", { name: "Delta" }).focus();
  await page.keyboard.type("0.5");
  await expect(page.getByText("factorial: 6 configurations; delta 0.5")).toBeVisible();
  await page.keyboard.press("Enter");
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expect(page.getByText(/^\d of 6$/)).toBeVisible();
  showAnswer();
  await expect(recommendation(page)).toBeVisible({ timeout: 4 * hang_ms });

  const box = page.getByRole("textbox", { name: /^Raise confidence/ });
  await expect(box).toHaveValue("0.99");
  await box.fill("0.5");
  await page.getByRole("button", { name: "Raise" }).click();
  await expect(page.getByText("must be above the study's 0.95")).toBeVisible();
  await expectAccessible(page, "form");
  await box.fill("0.99");
  await box.press("Enter");
  // The few additional runs may finish before the page displays them.
  await expect(page.getByText("selected one with 99% confidence")).toBeVisible();
});

test("errors are displayed beside their fields, and the study cannot be started", async ({
  page,
  server,
}) => {
  await page.goto(formAt(server));
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
  await page.getByRole("textbox", { name: "Delta" }).fill("0.5");
  await expect(page.getByText("factorial: 4 configurations; delta 0.5")).toBeVisible();
  await expect(page.getByRole("button", { name: "Start" })).toBeEnabled();
});

test("an error under More options opens that section", async ({ page, server }) => {
  await page.goto(formAt(server));
  await page.getByText("More options", { exact: true }).click();
  await page.getByRole("textbox", { name: "Seed" }).fill("minus one");
  await expect(page.getByRole("textbox", { name: "Seed" })).toHaveAccessibleDescription(/whole number/);
  await expectAccessible(page);
});

test("further factors are found by name, added and removed", async ({ page, server }) => {
  await page.goto(formAt(server));
  await page.getByText("Add a factor").click();
  await page.getByRole("searchbox").fill("max speed");
  await expect(page.getByText("3 parameters", { exact: true })).toBeVisible();
  await page.getByRole("button", { name: "Vary robots.rover.drive.max_speed_m_s" }).click();
  const speed = page.getByRole("textbox", { name: "robots.rover.drive.max_speed_m_s" });
  await expect(speed).toBeFocused();
  await speed.fill("1,1.5");
  await expect(page.getByText("factorial: 40 configurations")).toBeVisible();
  await page.getByText("Add a factor").click();
  await page.getByRole("button", { name: "Vary robots.rover.model" }).click();
  await page.getByRole("checkbox", { name: "tracked" }).check();
  await page.getByRole("checkbox", { name: "ugv" }).check();
  await expect(page.getByText("factorial: 80 configurations")).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Remove robots.rover.drive.max_speed_m_s" }).click();
  await expect(page.getByText("factorial: 40 configurations")).toBeVisible();
});

test("an invalid scenario cannot be studied, with the server's message", async ({ page, server }) => {
  const broken = join(server.folder, "broken.toml");
  await writeFile(broken, ownScenario.replace("count = 4", ""));
  await page.goto(`${server.url}/#/study/new?scenario=broken.toml`);
  await expect(page.getByRole("alert")).toContainText("robots.rover.count is missing");
  await expectAccessible(page);
  await rm(broken);
});

test("a study that cannot start now is refused with a reason, and can be started later", async ({
  page,
  server,
}) => {
  const message = "studies/a and studies/b are running, and this server runs at most 2 studies at a time";
  const error = { file: null, line: null, path: "", value: null, allowed: "", suggestion: null, message };
  await page.route("**/api/studies", (route) => route.fulfill({ status: 422, json: { errors: [error] } }));
  await page.goto(formAt(server));
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText("at most 2 studies at a time")).toBeVisible();
  await expectAccessible(page);
  await page.unroute("**/api/studies");
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
});

test("a missing server is reported on the form, which recovers by itself", async ({
  page,
  server,
  context,
}) => {
  await page.goto(formAt(server));
  const team = page.getByRole("textbox", { name: "Number of rovers" });
  await expect(team).toBeVisible();
  await context.setOffline(true);
  await team.fill("1..5");
  await expect(page.getByText("The server is not responding. Retrying.")).toBeVisible();
  await context.setOffline(false);
  await expect(page.getByText("factorial: 5 configurations")).toBeVisible();
});

test("a scenario can be studied from its run, also a dropped one", async ({ page, server }) => {
  await openRun(page, server, "scenario=search&seed=7");
  await page.getByRole("link", { name: "Study this scenario" }).click();
  await expect(page.getByRole("heading", { name: "New study of search" })).toBeVisible();
  await openFile(page, server, ownScenario);
  await page.getByRole("link", { name: "Study this scenario" }).click();
  await expect(page.getByRole("heading", { name: "New study of scenario" })).toBeVisible();
});

test("studies are usable on a phone", async ({ page, server, answered }) => {
  await asOnPhone(page);
  await page.goto(formAt(server));
  await expect(page.getByText("factorial: 20 configurations")).toBeVisible();
  await expectToFit(page);
  await expectAccessible(page);
  await page.getByRole("textbox", { name: "Number of rovers" }).fill("1..9");
  await page.getByRole("textbox", { name: "Delta" }).fill("0.0001");
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByRole("heading", { name: "Remaining" })).toBeVisible();
  await expectToFit(page);
  await page.getByRole("button", { name: "Stop" }).click();
  await expect(page.getByRole("button", { name: "Resume" })).toBeVisible();
  await openAnswer(page, server, answered);
  await expect(page.getByRole("img", { name: /^Runs per/ }).locator("svg")).toBeVisible();
  await expectToFit(page);
  await expectAccessible(page);
  await page.getByRole("link", { name: "3 rovers" }).first().click();
  await expect(page.getByRole("dialog")).toBeVisible();
  await expectToFit(page);
  await page.goto(`${server.url}/#/studies`);
  await expect(page.getByRole("listitem").first()).toBeVisible();
  await expectToFit(page);
  await expectAccessible(page);
});

test("the form of a study of a changed run lists what was changed, also after a reload", async ({
  page,
  server,
}) => {
  const changes = '[[3,"robots.rover.count",6],[4,"clock.time_limit_s",60]]';
  await openRun(page, server, `scenario=search&seed=3&changes=${changes}&tick=10`, "6 robots");
  await page.getByRole("button", { name: "Study this scenario with your 2 changes" }).click();
  const expectChanges = async () => {
    await expect(page.getByRole("heading", { name: "New study of search, changed" })).toBeVisible();
    const listed = page.getByRole("region", { name: "Changed values" });
    await expect(listed.getByRole("heading")).toHaveText("2 values changed since search");
    await expect(listed.getByRole("listitem")).toHaveText([
      /clock\.time_limit_s\s*120.*60/,
      /robots\.rover\.count\s*4.*6/,
    ]);
  };
  await expectChanges();
  await page.reload();
  await expectChanges();
  await expectAccessible(page);
  await expect(page.getByText("studies/search-changed")).toBeVisible();
});
