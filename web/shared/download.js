// Links to files that the server may refuse: a browser shows no reason of a refused download.

import { attempt } from "./dom.js";
import { canBeRead } from "./http.js";

/**
 * The `@click` of a link that asks the server for its file first. A refusal is shown in `message`,
 * with its remedy; meanwhile `status` says that the file is made. Both are found at
 * the click.
 * @param {() => {message: HTMLElement, status: HTMLElement}} places
 */
export const askFirst = (places) => async (/** @type {MouseEvent} */ event) => {
  if (event.ctrlKey || event.metaKey || event.shiftKey) return; // in another tab
  event.preventDefault();
  const link = /** @type {HTMLAnchorElement} */ (event.currentTarget);
  if (link.ariaBusy === "true") return;
  const { href } = link; // the link may change while the file is made
  const { message, status } = places();
  link.ariaBusy = "true";
  status.textContent = `${link.textContent}: the file is being made…`;
  await attempt(message, async () => {
    await canBeRead(href);
    const file = document.createElement("a");
    Object.assign(file, { href, download: "" }).click();
  });
  link.ariaBusy = status.textContent = "";
};
