import type { StudySummary } from "../src/api/study";
import { expect, expectAccessible } from "./page";
import { summaryOf, test } from "./studies";

test("without studies the page explains what a study is and how to start one", async ({ page, server }) => {
  await page.route("**/api/studies", (route) => route.fulfill({ json: { studies: [] } }));
  await page.goto(server.url);
  await page.getByRole("link", { name: "Studies" }).click();
  await expect(page.getByRole("heading", { name: "No studies yet" })).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "New study" }).click();
  await expect(page.getByRole("link", { name: /^search Four items/ })).toBeVisible();
  await expectAccessible(page);
});

test("studies are listed with their state, and the list is updated", async ({ page, server, answered }) => {
  const last = await summaryOf(server, answered);
  const running: StudySummary = { ...last, state: "running", sentence: null };
  const message = "The disk is full. Free some space, then resume the study.";
  const failed: StudySummary = { ...running, id: "studies/failed", state: "stopped", message };
  const others = [{ ...running, id: "studies/long" }, failed];
  let studies = [running, ...others];
  await page.route("**/api/studies", (route) => route.fulfill({ json: { studies } }));
  await page.goto(`${server.url}/#/studies`);
  await expect(page.getByRole("listitem")).toHaveCount(3);
  await expect(page.getByRole("link", { name: /^Stopped.*The disk is full/ })).toBeVisible();
  await expect(page.getByRole("link", { name: /^Running/ })).toHaveCount(2);
  await expectAccessible(page);
  studies = [last, ...others];
  await expect(
    page.getByRole("link", { name: new RegExp(`^Answered search ${answered} Send`) }),
  ).toBeVisible();
});

test("a missing server is reported on the list, which recovers by itself", async ({
  page,
  server,
  race,
  context,
}) => {
  await page.goto(`${server.url}/#/studies`);
  const listed = page.getByRole("link", { name: new RegExp(`^Running search ${race} `) });
  await expect(listed).toBeVisible();
  await context.setOffline(true);
  await expect(page.getByText("The server is not responding.")).toBeVisible();
  await expect(listed).toBeVisible();
  await expectAccessible(page);
  await context.setOffline(false);
  await expect(page.getByText("The server is not responding.")).toBeHidden();
});
