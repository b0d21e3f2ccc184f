// The page of the map where there are no points in 3-D: it leads to what there is.

import { idHere } from "../shared/address.js";
import { projectUrl, slicesUrl, stretchUrl } from "../shared/api.js";
import { byId, html, say } from "../shared/dom.js";
import { t } from "../shared/texts.js";
import { page } from "./page.js";
import { followJobs } from "./rebuilt.js";

const id = idHere();

/**
 * Shows the way to what the project has, also where a link leads; a map that a job makes appears.
 * @param {string[]} stages those of the project that are done
 */
export function withoutPoints(stages) {
  const { span, place } = Object.fromEntries(new URLSearchParams(location.search));
  const stretch = [span && `span=${span}`, place && `place=${place}`].filter(Boolean).join("&");
  if (page.guest) return location.replace(slicesUrl(id));
  if (stretch) return location.replace(stretchUrl(id, stretch));
  say(
    byId("message"),
    html`${t("no-points-3d")} <a href=${projectUrl(id)}>${t("its-page")}</a> ${t("shows-what-is")}`,
  );
  if (!stages.includes("map_2d")) followJobs(byId("news"));
}
