// The page while the map of its slices is made, or made again: it says so, and shows the new one.

import { idHere } from "../shared/address.js";
import { readSliceFacts, watchJobs } from "../shared/api.js";
import { byId, html, only, render } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { page } from "./drawing.js";

/** @import {JobView} from "../shared/http_types" */

const id = idHere();

/** Whether something is being done that a new page would lose. */
const isBusy = () =>
  page.outline.corners.length > 0 ||
  page.brush.strokes.length > 0 ||
  page.measured.length > 0 ||
  byId("findings").contains(document.activeElement);

/** Follows the jobs of the project; the address keeps what is shown. */
export function followJobs() {
  const news = byId("news");
  const followed = { open: "" };

  async function look() {
    const facts = await readSliceFacts(id, page.state.source);
    if (page.facts?.key === facts.key) return render("", news);
    if (!page.facts || !isBusy()) return location.reload();
    const show = () => location.reload();
    render(
      html`${t("map-was-remade")} <button type="button" @click=${show}>${t("show-new")}</button>`,
      news,
    );
  }

  const onJob = (/** @type {JobView} */ { job }) => {
    if (job.project !== id) return;
    if (!job.finished) {
      followed.open = job.id;
      render(t(page.facts ? "being-remade" : "being-made"), news);
    } else if (followed.open === job.id) {
      followed.open = ""; // a job that failed has the same id when it is resumed
      look().catch(() => render("", news)); // it has no map now: what is shown stays
    }
  };
  watchJobs(onJob, (linked) => {
    only("page-head").linked = linked;
  });
}
