import type { Stage } from "../../canvas/stage";

/** Downloads a file under a name. */
export function save(name: string, blob: Blob): void {
  const url = URL.createObjectURL(blob);
  const link = document.createElement("a");
  link.href = url;
  link.download = name.replaceAll("/", "-");
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** The current view as a PNG; null before anything is drawn. */
export function picture(stage: Stage | null): Promise<Blob | null> {
  const canvas = stage?.snapshot();
  return new Promise((done) => (canvas ? canvas.toBlob(done, "image/png") : done(null)));
}
