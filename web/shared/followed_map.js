// A page whose map is made, or made again: it says so, and shows the map when it is there.

import { idHere } from "./address.js";
import { watchJobs } from "./api.js";
import { html, only, render } from "./dom.js";
import { t } from "./texts.js";

/** @import {JobView} from "./http_types" */

/**
 * Follows the jobs of the project.
 * @param {HTMLElement} element where the page says what happens
 * @param {object} page
 * @param {() => boolean} page.hasMap whether it shows one
 * @param {Promise<unknown>} [page.opening] ends once it is known whether it shows one
 * @param {() => Promise<boolean>} page.isNewest whether the map is still the one it shows
 * @param {() => boolean} page.isBusy whether something is being done that a new page would lose
 * @param {() => void} page.reload shows the new map
 */
export function followMap(element, { hasMap, opening, isNewest, isBusy, reload }) {
  const id = idHere();
  let open = "";

  async function look() {
    if (await isNewest()) return render("", element);
    if (!hasMap() || !isBusy()) return reload();
    render(
      html`${t("map-was-remade")} <button type="button" @click=${reload}>${t("show-new")}</button>`,
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
  watchJobs(onJob, (linked) => {
    only("page-head").linked = linked;
  });
}
