import { mkdir, readFile, rename, writeFile } from "node:fs/promises";
import { join } from "node:path";
import type { Page } from "@playwright/test";
import type { RecordingEntry, Refused, Saved } from "../src/api/protocol";
import {
  altered,
  asOnPhone,
  downloaded,
  expect,
  expectAccessible,
  expectToFit,
  hash,
  openFile,
  openRun,
  openTab,
  ownScenario,
  type RealServer,
  runAt,
  status,
  test,
} from "./page";

const scenario = "scenario=search-beliefs&seed=7&run=2";

async function choose(page: Page, name: string): Promise<void> {
  await page.locator("summary", { hasText: "Export" }).click();
  await page.getByRole("button", { name }).click();
}

/** Saves a run, and renames its recording. */
async function record(page: Page, server: RealServer, name: string): Promise<void> {
  const query = "scenario=search&seed=3&changes=[[20,%22robots.rover.count%22,6]]&tick=40";
  await openRun(page, server, query, "4.0 s, 6 robots");
  await choose(page, "Save recording");
  const saved = await page
    .getByText(/^Saved as/)
    .locator("code")
    .textContent();
  await rename(join(server.folder, saved ?? ""), join(server.folder, name));
}

test("a run is saved, and its recording opens as that run, to the bit", async ({ page, server }) => {
  let showSaved = () => {};
  const checked = new Promise<void>((done) => (showSaved = done));
  await altered(page, async (message) => {
    if (message.type === "saved") await checked;
    return message;
  });
  await openRun(
    page,
    server,
    `${scenario}&changes=[[5,%22robots.rover.count%22,6]]&tick=20`,
    "2.0 s, 6 robots",
  );
  const there = await hash(page);
  await choose(page, "Save recording");
  await expect(page.getByRole("progressbar", { name: "Saving the run" })).toBeVisible();
  await expectAccessible(page);
  showSaved();
  await expect(page.getByText(/Saved as recordings\/search-beliefs-7-2-\w+\.mcap/)).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "Open", exact: true }).click();
  await expect(page.getByText("seed 7, run 2, recorded")).toBeVisible();
  await expect(status(page)).toContainText("0.0 s, 4 robots");
  const slider = page.getByRole("slider", { name: "Time" });
  await slider.fill((await slider.getAttribute("max")) ?? "");
  await expect(status(page)).toContainText("2.0 s, 6 robots");
  await expect.poll(() => hash(page)).toBe(there);
  await expect.poll(() => page.url()).toMatch(/recording=recordings\/search-beliefs-7-2-\w+\.mcap&tick=20/);
});

test("a recording that is still being written is listed with its length so far, and opens with a notice", async ({
  page,
  ownServer,
}) => {
  await record(page, ownServer, "drive.mcap");
  await page.route("**/api/recordings", async (route) => {
    const response = await route.fetch();
    const [entry] = (await response.json()) as RecordingEntry[];
    const run = { ...entry?.run, steps: null, length_s: 3.5, is_being_written: true };
    await route.fulfill({ response, json: [{ ...entry, run }] });
  });
  await altered(page, (message) =>
    message.type === "opened" && message.recording
      ? { ...message, recording: { ...message.recording, is_being_written: true } }
      : message,
  );
  await page.goto(`${ownServer.url}/#/recordings`);
  await expect(page.getByText("Still being written, 3.5 s so far")).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "drive.mcap", exact: true }).click();
  await expect(page.getByText("The recording was still being written when it was opened")).toBeVisible();
  await expectAccessible(page);
});

test("saving can be cancelled", async ({ page, server }) => {
  const cancelled: Saved = { type: "saved", recording: null };
  await page.routeWebSocket(/\/ws/, (line) => {
    const onwards = line.connectToServer();
    // Saving takes until it is cancelled.
    onwards.onMessage((data) => {
      const type = typeof data === "string" ? JSON.parse(data).type : null;
      if (type !== "saving" && type !== "saved") line.send(data);
    });
    line.onMessage((data) => {
      if (JSON.parse(String(data)).type === "cancel_save") line.send(JSON.stringify(cancelled));
      else onwards.send(data);
    });
  });
  await page.goto(runAt(server, scenario));
  await choose(page, "Save recording");
  await page.getByRole("button", { name: "Cancel" }).click();
  await expect(page.getByRole("progressbar")).toHaveCount(0);
  await expect(page.getByText("Saved as")).toHaveCount(0);
});

test("the error of a failed save is displayed", async ({ page, server }) => {
  const message = "recordings: the disk is full, and the recording was removed: free some space";
  const error = { file: null, line: null, path: "", value: null, allowed: "", suggestion: null, message };
  const refused: Refused = { type: "refused", about: "save", path: null, errors: [error], total: 1 };
  await altered(page, (sent) => (sent.type === "saved" ? refused : sent));
  await page.goto(runAt(server, "scenario=flock"));
  await choose(page, "Save recording");
  await expect(page.getByRole("alert")).toContainText("the disk is full");
  await expectAccessible(page);
});

test("recordings are listed, opened and downloaded", async ({ page, server }) => {
  await record(page, server, "listed.mcap");
  await mkdir(join(server.folder, "old"), { recursive: true });
  await writeFile(join(server.folder, "old/damaged.mcap"), "not a recording");
  await page.goto(server.url);
  await page.getByRole("link", { name: "Recordings" }).click();
  await expect(page.getByRole("cell", { name: /Cannot be opened: it is not an MCAP file/ })).toBeVisible();
  await expect(page.getByRole("row", { name: /^listed.mcap search 3 0 40/ })).toBeVisible();
  await expectAccessible(page);
  const file = await downloaded(page, () => page.getByRole("link", { name: "Download listed.mcap" }).click());
  expect(await readFile(await file.path())).toEqual(await readFile(join(server.folder, "listed.mcap")));
  await page.getByRole("link", { name: "listed.mcap", exact: true }).click();
  await expect(page.getByText("seed 3, run 0, recorded")).toBeVisible();
  // The address has been updated, so that it does not change again while the next page opens.
  await expect.poll(() => page.url()).toContain("view=");
  await asOnPhone(page);
  await page.goto(`${server.url}/#/recordings`);
  await expect(page.getByRole("link", { name: "listed.mcap", exact: true })).toBeVisible();
  await expectToFit(page);
  await expectAccessible(page);
});

test("changes that do not fit into an address are saved, and the address names the recording", async ({
  page,
  server,
  context,
}) => {
  const corner = (i: number) => [12 + 8 * Math.cos(i / 100), 12 + 8 * Math.sin(i / 100)];
  const area = Array.from({ length: 600 }, (_, i) => corner(i).map((at) => Number(at.toFixed(6))));
  const changes = JSON.stringify([[1, "terrain.mud", { areas_m: [area] }]]);
  await openRun(page, server, `${scenario}&tick=3&changes=${changes}`, "0.3 s");
  await expect.poll(() => page.url()).toMatch(/recording=recordings\/search-beliefs-7-2-\w+\.mcap&tick=3/);
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(status(other)).toContainText("0.3 s");
});

test("a large file of the user's own is saved, so that its address works elsewhere", async ({
  page,
  server,
  context,
}) => {
  const noise = Array.from({ length: 9000 }, (_, i) => ((i * 2654435761) >>> 0).toString(36)).join("\n# ");
  await openFile(page, server, `${ownScenario}# ${noise}`);
  await expect(status(page)).toContainText("4 robots");
  await expect.poll(() => page.url()).toContain("recording=recordings/");
  await page.getByRole("application").press(".");
  await expect.poll(() => page.url()).toContain("tick=1");
  const other = await context.newPage();
  await other.goto(page.url());
  await expect(status(other)).toContainText("0.1 s, 4 robots");
});

test("a change in a recorded run makes a new run, whose address has all changes", async ({
  page,
  server,
}) => {
  await record(page, server, "changed.mcap");
  await openRun(page, server, "recording=changed.mcap&tick=30", "3.0 s, 6 robots");
  await openTab(page, "Parameters");
  await page.getByRole("spinbutton", { name: "Count of rover" }).fill("2");
  await page.keyboard.press("Enter");
  await expect(status(page)).toContainText("2 robots");
  await expect
    .poll(() => decodeURIComponent(page.url()))
    .toContain('changes=[[20,"robots.rover.count",6],[30,"robots.rover.count",2]]');
  await page.getByRole("button", { name: "New run" }).click();
  await expect(page.getByText("the recording's scenario, including all changes")).toBeVisible();
  await page.getByRole("button", { name: "Start" }).click();
  await expect.poll(() => page.url()).toMatch(/text=z.*&seed=3&run=1/);
});

test("a missing recording is reported", async ({ page, server }) => {
  await page.goto(runAt(server, "recording=gone.mcap"));
  await expect(page.getByText("recording = 'gone.mcap': must be one below")).toBeVisible();
  await expectAccessible(page);
});

test("the scenario with its changes is saved as a file, and the file opens", async ({ page, server }) => {
  await openRun(
    page,
    server,
    `${scenario}&tick=20&changes=[[0,%22robots.rover.count%22,3]]`,
    "2.0 s, 3 robots",
  );
  const saved = await downloaded(page, () => choose(page, "Scenario with changes"));
  expect(saved.suggestedFilename()).toBe("search-beliefs-20.toml");
  const buffer = await readFile(await saved.path());
  expect(buffer.toString()).toContain("# From search-beliefs, seed 7, run 2, at tick 20");
  await openFile(page, server, buffer);
  await expect(status(page)).toContainText("3 robots");
});
