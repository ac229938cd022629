import type { Page } from "@playwright/test";
import { altered, asOnPhone, expect, expectAccessible, expectToFit } from "./page";
import { alterStudy, formAt, post, studyAt, summaryOf, test as base } from "./studies";
import { hang_ms } from "../dev/real-server.mjs";

const request = {
  scenario: "classic",
  question: "requirement",
  vary: { "robots.wanderer.count": "1..6" },
  require: ["time_s <= 40"],
  probability: 0.8,
  tolerance: 0.1,
};

/** `required` is the id of a study of a requirement with an answer. */
const test = base.extend<object, { required: string }>({
  required: [
    async ({ server }, use) => {
      const { id } = await post(server, "studies", request);
      const state = async () => (await summaryOf(server, id)).state;
      await expect.poll(state, { timeout: 5 * hang_ms }).toBe("answered");
      await use(id);
    },
    { scope: "worker", timeout: 5 * hang_ms },
  ],
});

/** Opens a study as if it had been stopped before its answer. */
async function openRace(page: Page, address: string): Promise<void> {
  const stopped = { state: "stopped", message: null } as const;
  await altered(page, (sent) => (sent.type === "study_progress" ? { ...sent, ...stopped } : sent));
  await alterStudy(page, { ...stopped, answer: null, is_recommended: null });
  await page.goto(address);
}

test("a race with a requirement has the status of each configuration as text", async ({
  page,
  server,
  required,
}) => {
  await openRace(page, studyAt(server, required));
  await expect(page.getByText("Share of runs so far with time_s <= 40")).toBeVisible();
  await expect(page.getByRole("listitem").filter({ hasText: "1 wanderer" }).first()).toContainText(
    "may meet",
  );
  await expect(page.getByText("certified", { exact: true }).first()).toBeVisible();
  await expect(page.getByText(/^eliminated after \d+ runs$/).first()).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("button", { name: "Table" }).click();
  await expect(page.getByRole("columnheader", { name: "share" })).toBeVisible();
  await expect(page.getByRole("row", { name: /^1 wanderer .*%.* may meet$/ })).toBeVisible();
  const inkOf = (status: string) =>
    page
      .getByRole("cell", { name: status, exact: true })
      .first()
      .locator("span")
      .evaluate((mark) => getComputedStyle(mark).color);
  expect(await inkOf("may meet")).not.toBe(await inkOf("certified"));
  await expectAccessible(page);
  await asOnPhone(page);
  await page.reload();
  await expect(page.getByText("certified", { exact: true }).first()).toBeVisible();
  await expectToFit(page);
});

test("a race is scaled to its contenders, until all teams are selected", async ({
  page,
  server,
  required,
}) => {
  await openRace(page, studyAt(server, required));
  const hopeless = page.getByRole("listitem").filter({ hasText: /^1 wanderer / });
  await expect(hopeless.getByText("←")).toBeVisible();
  await page.getByRole("button", { name: "All teams" }).click();
  await expect(hopeless.locator("circle")).toBeVisible();
  await expect(hopeless.getByText("←")).toBeHidden();
  await expectAccessible(page);
});

test("a chart of the answer is scaled to the contenders, until all teams are selected", async ({
  page,
  server,
  required,
}) => {
  await page.goto(studyAt(server, required));
  const shares = page.getByRole("region", { name: "Missions that meet the requirement" });
  await expect(shares.getByText("←").first()).toBeVisible();
  await shares.getByRole("button", { name: "All teams" }).click();
  await expect(shares.getByText("←")).toHaveCount(0);
  await expectAccessible(page);
});

test("the answer to a requirement is its verdict", async ({ page, server, required }) => {
  await page.goto(studyAt(server, required));
  await expect(page.getByText(/^Send \d wanderers\.$/)).toBeVisible();
  await expect(page.getByText(/in at least 80% of missions \([\d.]+% of [\d,]+ did\)\.$/)).toBeVisible();
  await expect(page.getByText("shares from 80% to 90% are not distinguished")).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "1 wanderer" }).first().click();
  await expect(page.getByRole("dialog", { name: "Runs of 1 wanderer" })).toBeVisible();
});

test("a requirement is entered in the form, with its errors beside the fields", async ({ page, server }) => {
  await page.goto(formAt(server, "classic"));
  const conditions = page.getByRole("textbox", { name: "Conditions" });
  await expect(conditions).toBeHidden();
  await page.getByRole("combobox", { name: "Question" }).selectOption("requirement");
  await expect(page.getByRole("textbox", { name: "Delta" })).toBeHidden();
  await conditions.fill("tim_s <= 40");
  await page.getByRole("textbox", { name: "Probability" }).fill("1.8");
  await expect(conditions).toHaveAccessibleDescription(/time_s/);
  await expect(page.getByRole("textbox", { name: "Probability" })).toHaveAccessibleDescription(/must be/);
  await expect(page.getByRole("button", { name: "Start" })).toBeDisabled();
  await expectAccessible(page);
  await conditions.fill("time_s <= 40\nfailed <= 0");
  await page.getByRole("textbox", { name: "Probability" }).fill("0.8");
  await page.getByRole("textbox", { name: "Tolerance" }).fill("0.1");
  await page.getByRole("textbox", { name: "Number of wanderers" }).fill("1..5");
  await page.getByRole("button", { name: "Start" }).click();
  await expect(page.getByText(/^Send \d wanderers\.$/)).toBeVisible({ timeout: 4 * hang_ms });
});
