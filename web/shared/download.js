// Links to files that the server may refuse: a browser shows no reason of a refused download.

import { attempt } from "./dom.js";
import { canBeRead, readBytes } from "./http.js";
import { t } from "./texts.js";

const NAME_AGAIN_MS = 60_000; // until then a browser has begun to save

/**
 * The `@click` of a link that asks the server for its file first. A refusal is shown in `message`,
 * with its remedy; meanwhile `status` says that the file is made. Both are found at
 * the click.
 * @param {() => {message: HTMLElement, status: HTMLElement}} places
 */
export const askFirst = (places) =>
  clicked(places, async (href) => {
    await canBeRead(href);
    save(href, "");
  });

/**
 * As `askFirst`, for a small file that the server makes again at each request: it is asked for
 * once.
 * @param {() => {message: HTMLElement, status: HTMLElement}} places
 * @param {() => string} name
 */
export const askOnce = (places, name) =>
  clicked(places, async (href) => {
    const url = URL.createObjectURL(new Blob([await readBytes(href)]));
    save(url, name());
    setTimeout(() => URL.revokeObjectURL(url), NAME_AGAIN_MS);
  });

function save(/** @type {string} */ href, /** @type {string} */ download) {
  const file = document.createElement("a");
  Object.assign(file, { href, download }).click();
}

/**
 * @param {() => {message: HTMLElement, status: HTMLElement}} places
 * @param {(href: string) => Promise<void>} download
 */
const clicked = (places, download) => async (/** @type {MouseEvent} */ event) => {
  if (event.ctrlKey || event.metaKey || event.shiftKey) return; // in another tab
  event.preventDefault();
  const link = /** @type {HTMLAnchorElement} */ (event.currentTarget);
  if (link.ariaBusy === "true") return;
  const { href } = link; // the link may change while the file is made
  const { message, status } = places();
  link.ariaBusy = "true";
  status.textContent = t("file-being-made", { name: link.textContent ?? "" });
  await attempt(message, () => download(href));
  link.ariaBusy = status.textContent = "";
};
