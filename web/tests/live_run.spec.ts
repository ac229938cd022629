import { type ChildProcess, spawn } from "node:child_process";
import { mkdtemp, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { expect, expectAccessible, expectReportAtOnce, openTab, status, test as base, time_s } from "./page";
import { FakeWarden, token } from "./warden";

const program = join(import.meta.dirname, "../../python/tests/live_page.py");

/** A drive of one robot in a team of five, whose page is served by the real server. */
class LiveDrive {
  /** With the secret of the page, without a hash. */
  url = "";
  /** The process of the server, not that of the drive, which starts another one when it ends. */
  pid = 0;
  private process: ChildProcess | null = null;
  private lines: AsyncIterator<string> | null = null;

  async start(warden: FakeWarden, folder: string): Promise<void> {
    const python = process.env.PYTHON ?? "python";
    const running = spawn(python, [program, String(warden.port), token], {
      cwd: folder,
      stdio: ["pipe", "pipe", "inherit"],
    });
    this.process = running;
    this.lines = createInterface(running.stdout)[Symbol.asyncIterator]();
    await this.served();
  }

  /** Waits until a server serves the page. */
  async served(): Promise<void> {
    const { value } = (await this.lines?.next()) ?? {};
    const { url, pid } = JSON.parse(value) as { url: string; pid: number };
    Object.assign(this, { url: url.split("#")[0], pid });
  }

  async end(): Promise<void> {
    const ended = new Promise((done) => this.process?.once("exit", done));
    this.process?.stdin?.end();
    await ended;
  }
}

const test = base.extend<{ drive: LiveDrive }>({
  drive: async ({}, use) => {
    const folder = await mkdtemp(join(tmpdir(), "agent-economy-"));
    const warden = new FakeWarden();
    await warden.start();
    const drive = new LiveDrive();
    await drive.start(warden, folder);
    await use(drive);
    await drive.end();
    await warden.kill();
    await rm(folder, { recursive: true });
  },
});

const reason = "This run is driven by real robots";

test("the view of the robots leads to the live run, with the robot selected, and back", async ({
  page,
  drive,
}) => {
  await page.goto(`${drive.url}#/robots`);
  await page.getByRole("region", { name: "bender/0" }).waitFor();
  await page.getByRole("link", { name: "What the brains believe" }).click();
  await expect(status(page)).toContainText("5 robots");
  expect(page.url()).toContain("#/run?live=1");
  await expect(page.getByRole("combobox", { name: "Robot" })).toHaveValue("bender/0");
  await expect(page.getByText("A real robot:")).toBeVisible();
  await expect(page.getByText("Goals").first()).toBeVisible();
  await expectAccessible(page);
  await page.getByRole("link", { name: "Robots", exact: true }).first().click();
  await expect(page.getByRole("region", { name: "bender/0" })).toBeVisible();
});

test("a live run continues by itself, and can be neither moved nor changed", async ({ page, drive }) => {
  await page.goto(`${drive.url}#/run?live=1`);
  await expect(status(page)).toContainText("running");
  await expect(page.getByText(reason).first()).toBeVisible();
  const start_s = await time_s(page);
  for (const key of [" ", ",", "."]) await page.keyboard.press(key);
  await expect.poll(() => time_s(page)).toBeGreaterThan(start_s + 1);
  for (const name of ["Pause", "Step back", "Step forward"])
    await expect(page.getByRole("button", { name })).toBeDisabled();
  await expect(page.getByRole("slider", { name: "Time" })).toBeDisabled();
  await expect(page.getByRole("combobox", { name: "Speed" })).toBeDisabled();
  for (const name of [/^Study/, "New run", "Undo"])
    await expect(page.locator("header").getByText(name)).toHaveCount(0);
  await openTab(page, "Parameters");
  await expect(page.getByRole("spinbutton", { name: "Count of bender" })).toBeDisabled();
  await expect(page.getByRole("tabpanel")).toContainText(reason);
  await expectAccessible(page, "aside");
  await openTab(page, "Edit");
  await expect(page.getByRole("button", { name: "Add circle" })).toBeDisabled();
  await expect(page.getByRole("tabpanel")).toContainText(reason);
  await openTab(page, "Events");
  await expect(page.getByRole("heading", { name: "Changes" })).toHaveCount(0);
  await expect.poll(() => new URL(page.url()).hash).toMatch(/^#\/run\?live=1&view=[^&]*$/);
});

test("a page joins the live run again when its server was killed and is back", async ({ page, drive }) => {
  const reportsAtOnce = await expectReportAtOnce(page);
  await page.goto(`${drive.url}#/run?live=1&robot=bender/1`);
  await expect(status(page)).toContainText("running");
  const before_s = await time_s(page);
  const { url, pid } = drive;
  await reportsAtOnce(async () => void process.kill(pid, "SIGKILL"));
  await expect(page.getByText("will then join the live run again")).toBeVisible();
  await drive.served();
  expect(drive.url).toBe(url);
  await expect(status(page)).toContainText("running");
  await expect.poll(() => time_s(page)).toBeGreaterThan(before_s);
  await expect(page.getByRole("alert")).toHaveCount(0);
  await expect(page.getByRole("combobox", { name: "Robot" })).toHaveValue("bender/1");
});

test("the secret of the page does not stay in its address, and a page without it is refused", async ({
  page,
  drive,
  browser,
}) => {
  await page.goto(`${drive.url}#/robots`);
  await page.getByRole("region", { name: "bender/0" }).waitFor();
  const { origin } = new URL(drive.url);
  expect(page.url()).toBe(`${origin}/#/robots`);
  await page.reload();
  await page.getByRole("region", { name: "bender/0" }).waitFor();
  const other = await (await browser.newContext()).newPage();
  await other.goto(`${origin}/#/robots`);
  await expect(other.getByText("Open the link with the token")).toBeVisible();
  await other.context().close();
});

test("a server without a drive has no live run", async ({ page, server }) => {
  await page.goto(`${server.url}/#/run?live=1`);
  await expect(page.getByRole("heading", { name: "Live run could not be opened" })).toBeVisible();
  await expect(page.getByRole("listitem")).toContainText("live");
});
