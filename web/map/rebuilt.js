// The page while its map is made, or made again.

import { idHere } from "../shared/address.js";
import { readMapIndex } from "../shared/api.js";
import { followMap } from "../shared/followed_map.js";
import { page } from "./page.js";
import { format } from "./state.js";

const newest = { frame: "" };
const AGAIN = "map made again"; // in the history of the tab: it has just been loaded again

/** Whether this page was loaded again because of a new map; says so once. */
export function takeNews() {
  const news = history.state === AGAIN;
  if (news) history.replaceState(null, "");
  return news;
}

/** Loads the page again, with its view and its measurements if they are in the same coordinates. */
function reload() {
  const shown = page.index?.frame === newest.frame ? `?${format(page.state)}` : "?";
  if (page.index) history.replaceState(AGAIN, "", shown);
  location.reload();
}

/** Whether the map of the project is the one that is shown. */
async function isNewest() {
  const { key, version, frame } = await readMapIndex(idHere());
  newest.frame = frame;
  return page.index !== null && key === page.index.key && version === page.index.version;
}

/**
 * Follows the jobs of the project.
 * @param {HTMLElement} element where the page says what happens
 */
export function followJobs(element) {
  followMap(element, {
    hasMap: () => Boolean(page.index),
    isNewest,
    isBusy: () => page.draft.length > 0 || page.notes.draft !== null || page.drag !== null,
    reload,
  });
}
