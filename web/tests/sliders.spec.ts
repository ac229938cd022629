import { expect, test as base } from "./page";
import { FakeWarden } from "./warden";

const test = base.extend<{ warden: FakeWarden }>({
  bypassCSP: true,
  warden: async ({ page }, use) => {
    const warden = new FakeWarden();
    await warden.start();
    await warden.attach(page);
    await use(warden);
    await warden.kill();
  },
});

test("a slider that jumps when it is pressed never sends what it showed before", async ({
  page,
  server,
  warden,
}) => {
  Object.assign(warden.robot, { mode: "manual", is_armed: true, action: "move" });
  await page.goto(`${server.url}/#/robots`);
  await page.getByRole("button", { name: "Take control" }).click();
  await page.getByRole("tab", { name: "Manual" }).click();
  const both = page.getByRole("slider", { name: "Both tracks" });
  await expect(both).toBeEnabled();
  await both.press("End");
  await expect(both).toHaveValue("200");
  const sent = () => new Set(warden.requests("left", "right").map(String));
  // Values that were held may still arrive after the key or the button is up, but none after the neutral ones.
  const forget = async () => {
    await expect.poll(() => warden.tracks().at(-1)).toMatchObject({ left: 150, right: 150 });
    warden.received.length = 0;
  };

  await forget();
  await both.hover({ position: { x: 2, y: 16 } });
  await page.mouse.down();
  await expect.poll(sent).toEqual(new Set(["/manual,100,100"]));
  await page.mouse.up();

  await forget();
  await page.keyboard.down("End");
  await expect.poll(sent).toEqual(new Set(["/manual,200,200"]));
  await page.keyboard.up("End");
});
