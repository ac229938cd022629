import type { Stage } from "../../canvas/stage";

/** Has the browser save something under a name. */
export function save(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name.replaceAll("/", "-");
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** What is seen, as a PNG; null if nothing is. */
export function picture(stage: Stage | null): Promise<Blob | null> {
  const canvas = stage?.flat();
  return new Promise((done) => (canvas ? canvas.toBlob(done, "image/png") : done(null)));
}
