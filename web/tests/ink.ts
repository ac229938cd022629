import type { Page } from "@playwright/test";

/** Where a picture is looked at: x, y in the middle, and pixels for each metre. */
export type View = [x: number, y: number, scale: number];

/** Whether anything is drawn over the robots' layer within two pixels of a place. */
export async function inkAt(page: Page, [x, y, scale]: View, at: [number, number]): Promise<boolean> {
  const way = [(at[0] - x) * scale, (y - at[1]) * scale];
  return page
    .locator("canvas")
    .nth(1)
    .evaluate((canvas: HTMLCanvasElement, [right = 0, down = 0]) => {
      if (canvas.hidden) return false;
      const ratio = canvas.width / canvas.clientWidth;
      const [left, top] = [canvas.width / 2 + right * ratio - 2, canvas.height / 2 + down * ratio - 2];
      const { data } = canvas.getContext("2d")?.getImageData(left, top, 5, 5) ?? { data: [] };
      return Array.from(data).some((value, i) => i % 4 === 3 && value > 0);
    }, way);
}

export function opens(view: View): string {
  return `view=${view.join(",")}`;
}

/** Number of pixels near a colour, [red, green, blue], on the screen where the canvas is. */
export async function pixelsOf(page: Page, colour: number[]): Promise<number> {
  const picture = await page.locator("canvas").first().screenshot();
  return page.evaluate(
    async ([data, colour]) => {
      const image = new Image();
      image.src = `data:image/png;base64,${data}`;
      await image.decode();
      const context = Object.assign(document.createElement("canvas"), {
        width: image.width,
        height: image.height,
      }).getContext("2d");
      context?.drawImage(image, 0, 0);
      const pixels = context?.getImageData(0, 0, image.width, image.height).data ?? [];
      let found = 0;
      for (let i = 0; i < pixels.length; i += 4)
        if (colour.every((value, part) => Math.abs((pixels[i + part] ?? 0) - value) < 32)) found += 1;
      return found;
    },
    [picture.toString("base64"), colour] as const,
  );
}

/** Makes the page draw robots with Canvas 2D. */
export const withoutWebGl = (page: Page) =>
  page.addInitScript(() => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (this: HTMLCanvasElement, kind: string, ...rest: []) {
      return kind === "webgl2" ? null : getContext.call(this, kind, ...rest);
    } as typeof getContext;
  });
