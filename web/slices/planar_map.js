// What the slices page shows of a 2-D map, which is itself one slice.

import { fileUrl, projectUrl, thumbnailUrl } from "../shared/api.js";
import { t, written } from "../shared/texts.js";
import { byId, html, nothing, render, within } from "../shared/dom.js";

/** @import {ProjectView} from "../shared/http_types" */

/** Whether the map of a project is a 2-D one. */
export const isPlan = (/** @type {ProjectView} */ project) => project.summary.map === "2d";

const inCm = (/** @type {number} */ m) => written(String(Math.round(m * 1000) / 10));

/**
 * Shows the plan in place of cuts and findings.
 * @param {string} id
 * @param {ProjectView} project
 * @param {boolean} guest who sees the image, not the files
 */
export function showPlan(id, { summary }, guest) {
  const { cell_m, overview_cell_m } = summary.grid;
  // Of an earlier version: there is no overview.
  const shown_m = overview_cell_m || cell_m;
  const name = overview_cell_m ? "overview.png" : "map.png";
  const finer = shown_m > cell_m ? `${t("plan-finer", { cm: inCm(cell_m) })} ` : "";
  const main = document.createElement("main");
  main.className = "plan";
  render(
    html`<p>
        ${t("plan-is", { cm: inCm(shown_m) })}
        ${guest ? nothing : html`${finer}<a href=${projectUrl(id)}>${t("page-project")}</a>`}
      </p>
      <img src=${guest ? thumbnailUrl(id, "") : fileUrl(id, name)} alt=${t("plan-alt")} />`,
    main,
  );
  within(document, "main").replaceWith(main);
  byId("help").remove();
}
