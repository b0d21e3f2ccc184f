// What the slices page shows of a 2-D map, which is itself one slice.

import { fileUrl, projectUrl } from "../shared/api.js";
import { byId, fill, make } from "../shared/dom.js";

/** Whether the map of a project is a 2-D one. */
export const isPlan = (project) => project.summary.map === "2d";

const inCm = (m) => Math.round(m * 1000) / 10;

/** Shows the plan in place of cuts and findings. */
export function showPlan(id, project) {
  const main = document.querySelector("main");
  main.className = "plan";
  const { cell_m, overview_cell_m } = project.summary.grid;
  // Of an earlier version: there is no overview.
  const shown_m = overview_cell_m || cell_m;
  const name = overview_cell_m ? "overview.png" : "map.png";
  const words = make("p", {
    textContent:
      "This is a 2-D map: one slice at the height of the laser, so no other can be cut. " +
      `A pixel is ${inCm(shown_m)} cm. ` +
      (shown_m > cell_m ? `The file map.png has pixels of ${inCm(cell_m)} cm. ` : ""),
  });
  words.append(
    make("a", {
      href: projectUrl(id),
      textContent: "The page Map shows places and distances.",
    }),
  );
  fill(
    main,
    words,
    make("img", {
      src: fileUrl(id, name),
      alt: "Floor plan: walls black, free white, not seen gray",
    }),
  );
  byId("help").remove();
}
