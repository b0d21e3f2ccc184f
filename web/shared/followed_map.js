// A page whose map is made, or made again: it says so, and shows the map when it is there.

import { idHere } from "./address.js";
import { watchJobs } from "./api.js";
import { html, only, render } from "./dom.js";
import { t } from "./texts.js";

/**
 * @import {JobView} from "./http_types"
 * @typedef {object} Newest the map that a project has now
 * @property {boolean} isShown the page shows it
 * @property {boolean} sameFrame its coordinates are those of the map that the page shows
 */

/**
 * Follows the jobs of the project.
 * @param {HTMLElement} element where the page says what happens
 * @param {object} page
 * @param {() => boolean} page.hasMap whether it shows one
 * @param {Promise<unknown>} [page.opening] ends once it is known whether it shows one
 * @param {() => Promise<Newest>} page.newest the map that the project has now
 * @param {() => boolean} page.isBusy whether something is being done that a new page would lose
 * @param {(newest: Newest) => void} page.reload shows the new map
 * @param {() => void} [page.back] the server answers again
 */
export function followMap(element, { hasMap, opening, newest, isBusy, reload, back }) {
  const id = idHere();
  let open = "";

  async function look() {
    const found = await newest();
    if (found.isShown) return render("", element);
    const show = () => reload(found);
    if (!hasMap() || !isBusy()) return show();
    render(
      html`${t("map-was-remade")} <button type="button" @click=${show}>${t("show-new")}</button>`,
      element,
    );
  }

  const onJob = async (/** @type {JobView} */ { job }) => {
    if (job.project !== id) return;
    await opening; // jobs go on meanwhile
    if (!job.finished) {
      open = job.id;
      render(t(hasMap() ? "being-remade" : "being-made"), element);
    } else if (open === job.id) {
      open = ""; // a job that failed has the same id when it is resumed
      look().catch(() => render("", element)); // it has no map now: what is shown stays
    }
  };
  let lost = false;
  watchJobs(onJob, (linked) => {
    only("page-head").linked = linked;
    if (linked && lost) back?.();
    lost = !linked;
  });
}
