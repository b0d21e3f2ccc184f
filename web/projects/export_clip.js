// The part of a map that the address chooses for an export: boxes, as the page Map shows them.

import { idHere, leftMap, pathHere, at } from "../shared/address.js";
import { mapUrl } from "../shared/api.js";
import { html, nothing } from "../shared/dom.js";
import { asWritten, t } from "../shared/texts.js";

/** @import {ExportOptions} from "../shared/http_types" */

const clipHere = () => new URLSearchParams(location.search).getAll("clip");

/** Whether the page was opened to export what the page Map shows. */
export const comesFromMap = () => clipHere().length > 0;

/** The boxes of the address, as it has them; none = all of the map. */
export const clipOfAddress = () => clipHere().filter(Boolean);

/** Takes the boxes out of the address. */
export const forgetClip = () => history.replaceState(null, "", at(pathHere()));

const short = (/** @type {number} */ x) => asWritten(Number(x.toFixed(2)));

/** Boxes in words. */
export const clipWords = (/** @type {NonNullable<ExportOptions["clip"]>} */ clip) =>
  clip.map(([x, y, z, dx, dy, dz, deg]) =>
    t("option-clip", {
      size: [dx, dy, dz].map(short).join(" × "),
      middle: [x, y, z].map(short).join(t("list-gap")),
      deg: short(deg),
    }),
  );

/**
 * The lines of the form that say which part is written.
 * @param {string[]} words of each box
 * @param {boolean} taken whether this kind of file is made of a part
 * @param {() => void} forget
 */
export const clipLines = (words, taken, forget) =>
  words.length === 0
    ? nothing
    : html`<fieldset class="clip">
        <legend>${t("clip-part")}</legend>
        ${taken ? words.map((line) => html`<p>${line}</p>`) : html`<p>${t("clip-not-taken")}</p>`}
        <div class="buttons">
          <a class="button" href=${mapAddress()}>${t("clip-back")}</a>
          <button type="button" @click=${forget}>${t("clip-forget")}</button>
        </div>
      </fieldset>`;

/** The page Map as this tab left it. */
function mapAddress() {
  const left = leftMap(idHere());
  return mapUrl(idHere()) + (left && `?${left}`);
}
