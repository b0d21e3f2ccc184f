// Opens a guest link: exchanges the token in the fragment for a session, and shows the map.

import { forgetFragment } from "../shared/address.js";
import { isSignedIn, mapUrl, openGuestLink } from "../shared/api.js";
import { attempt, byId } from "../shared/dom.js";
import "../shared/language_choice.js";
import { t } from "../shared/texts.js";

/** The token, and the view that the link shows: "TOKEN?camera=…". */
const [token, query] = location.hash.slice(1).split(/\?(.*)/s);
const ended = location.search === "?ended";
forgetFragment();

async function open() {
  if (await isSignedIn().catch(() => false)) {
    byId("words").textContent = t("guest-signed-in");
    return;
  }
  const place = token && (await attempt(byId("message"), () => openGuestLink(token)));
  if (place) return location.replace(mapUrl(place.project) + (query ? `?${query}` : ""));
  byId("words").textContent = t(token ? "guest-nothing" : ended ? "guest-ended" : "guest-no-link");
}

addEventListener("hashchange", () => location.reload()); // a link pasted into this page
open();
