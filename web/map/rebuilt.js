// The page while its map is made, or made again: it says so, and shows the map when it is there.

import { idHere } from "../shared/address.js";
import { readMapIndex, watchJobs } from "../shared/api.js";
import { html, only, render } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { page } from "./page.js";
import { format } from "./state.js";

/** @import {JobView} from "../shared/http_types" */

const id = idHere();
const AGAIN = "map made again"; // in the history of the tab: it has just been loaded again

/** Whether this page was loaded again because of a new map; says so once. */
export function takeNews() {
  const news = history.state === AGAIN;
  if (news) history.replaceState(null, "");
  return news;
}

/** Whether something is being done that a new page would lose. */
const isBusy = () => page.draft.length > 0 || page.notes.draft !== null || page.drag !== null;

/** Loads the page again, with its view and its measurements. */
export function reload() {
  history.replaceState(AGAIN, "", `?${format(page.state)}`);
  location.reload();
}

/**
 * Follows the jobs of the project.
 * @param {HTMLElement} element where the page says what happens
 */
export function followJobs(element) {
  const followed = { open: "" };

  async function look() {
    const { key, version } = await readMapIndex(id);
    if (!page.index) return location.reload();
    if (key === page.index?.key && version === page.index.version) return render("", element);
    if (!isBusy()) return reload();
    render(
      html`${t("map-was-remade")} <button type="button" @click=${reload}>${t("show-new")}</button>`,
      element,
    );
  }

  const onJob = (/** @type {JobView} */ { job }) => {
    if (job.project !== id) return;
    if (!job.finished) {
      followed.open = job.id;
      render(t(page.index ? "being-remade" : "being-made"), element);
    } else if (followed.open === job.id) {
      followed.open = ""; // a job that failed has the same id when it is resumed
      look().catch(() => render("", element)); // it has no map now: what is shown stays
    }
  };
  watchJobs(onJob, (linked) => {
    only("page-head").linked = linked;
  });
}
