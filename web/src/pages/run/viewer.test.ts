import { afterEach, expect, test, vi } from "vitest";
import type { Opened } from "../../api/protocol";
import { emptyLink } from "../../shared/link";
import { Viewer } from "./viewer.svelte";

afterEach(() => void vi.unstubAllGlobals());

test("a run of a study is named after the scenario, whatever the name of the study's folder", async () => {
  vi.stubGlobal("fetch", async () => Response.json({ label: "5 rovers" }));
  const study = { id: "studies/search-d49513ce", configuration: 4 };
  const viewer = new Viewer({ ...emptyLink, study, run: "9" }, null);
  expect(viewer.studyTitle).toBe("Run 9 of studies/search-d49513ce, configuration 4");
  viewer.session.opened = { scenario: { name: "search" } } as Opened;
  await vi.waitFor(() => expect(viewer.studyTitle).toBe("Run 9 of search, 5 rovers"));
});
