// The page while its map is made, or made again.

import { idHere } from "../shared/address.js";
import { readMapIndex } from "../shared/api.js";
import { followMap } from "../shared/followed_map.js";
import { page } from "./page.js";
import { format } from "./state.js";

/** @import {Newest} from "../shared/followed_map.js" */

const AGAIN = "map made again"; // in the history of the tab: it has just been loaded again

/** Whether this page was loaded again because of a new map; says so once. */
export function takeNews() {
  const news = history.state === AGAIN;
  if (news) history.replaceState(null, "");
  return news;
}

/**
 * Loads the page again, with its view and its measurements if they are in the same coordinates.
 * @param {Newest} newest
 */
function reload({ sameFrame }) {
  const shown = sameFrame ? `?${format(page.state)}` : "?";
  if (page.index) history.replaceState(AGAIN, "", shown);
  location.reload();
}

/** The map that the project has now. */
async function newest() {
  const { key, version, frame } = await readMapIndex(idHere());
  const { index } = page;
  return {
    isShown: index !== null && key === index.key && version === index.version,
    sameFrame: frame === index?.frame,
  };
}

/**
 * Follows the jobs of the project.
 * @param {HTMLElement} element where the page says what happens
 * @param {() => void} [back] the server answers again
 */
export function followJobs(element, back) {
  followMap(element, {
    hasMap: () => Boolean(page.index),
    newest,
    isBusy: () => page.draft.length > 0 || page.notes.draft !== null || page.drag !== null,
    reload,
    back,
  });
}
