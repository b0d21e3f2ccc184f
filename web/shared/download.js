// Links to files that the server may refuse: a browser shows no reason of a refused download.

import { attempt, make } from "./dom.js";
import { canBeRead } from "./http.js";

/**
 * Lets a link ask the server for its file first. A refusal is shown on the page, with its remedy;
 * meanwhile `status` says that the file is made.
 */
export function checked(link, { message, status }) {
  link.addEventListener("click", async (event) => {
    if (event.ctrlKey || event.metaKey || event.shiftKey) return; // in another tab
    event.preventDefault();
    if (link.ariaBusy === "true") return;
    const { href } = link; // the link may change while the file is made
    link.ariaBusy = "true";
    status.textContent = `${link.textContent}: the file is being made…`;
    await attempt(message, async () => {
      await canBeRead(href);
      make("a", { href, download: "" }).click();
    });
    link.ariaBusy = status.textContent = "";
  });
  return link;
}
