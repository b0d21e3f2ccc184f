// The page while the map of its slices is made, or made again.

import { idHere } from "../shared/address.js";
import { isGuest, readCurrentUser, readSliceFacts } from "../shared/api.js";
import { byId } from "../shared/dom.js";
import { followMap } from "../shared/followed_map.js";
import { page } from "./drawing.js";
import { keepOpenPanels } from "./findings.js";
import { withoutPlane } from "./state.js";

/** @import {Newest} from "../shared/followed_map.js" */

/** The map that the project has now. */
async function newest() {
  const { key, frame } = await readSliceFacts(idHere(), page.state.source);
  return { isShown: key === page.facts?.key, sameFrame: frame === page.facts?.frame };
}

/**
 * Loads the page again; in other coordinates the plane would be anywhere.
 * @param {Newest} newest
 */
function reload({ sameFrame }) {
  keepOpenPanels();
  if (page.facts && !sameFrame) history.replaceState(null, "", `?${withoutPlane(location.search)}`);
  location.reload();
}

/** Whether something is being done that a new page would lose. */
const isBusy = () =>
  page.outline.corners.length > 0 ||
  page.brush.strokes.length > 0 ||
  page.measured.length > 0 ||
  byId("findings").contains(document.activeElement);

/**
 * Follows the jobs of the project; the address keeps what is shown.
 * @param {Promise<unknown>} opening ends once it is known whether there is a map
 */
export async function followJobs(opening) {
  const news = byId("news"); // a 2-D map takes its place meanwhile
  const me = await readCurrentUser().catch(() => null);
  if (!me || isGuest(me)) return;
  followMap(news, {
    hasMap: () => Boolean(page.facts),
    opening,
    newest,
    isBusy,
    reload,
  });
}
