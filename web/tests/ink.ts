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
