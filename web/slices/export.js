// Slices as files: sheets at a true scale, points, georeferenced images.

import { sliceFileUrl } from "../shared/api.js";
import { approvalLines } from "../shared/approval_lines.js";
import { html, messagePlace, nothing, render, targetOf, within } from "../shared/dom.js";
import { askFirst } from "../shared/download.js";
import { t } from "../shared/texts.js";
import { choice } from "./columns.js";

/**
 * @import {SliceFacts} from "../shared/http_types"
 * @import {SlicesPage} from "./findings.js"
 */

/** @type {Array<[string, string, string]>} */
const KINDS = [
  ["png", "PNG", t("file-png")],
  ["svg", "SVG", t("file-sheet")],
  ["pdf", "PDF", t("file-sheet")],
  ["dxf", "DXF", t("file-dxf")],
  ["tif", "GeoTIFF", t("file-tif")],
  ["laz", "LAZ", t("file-laz")],
  ["csv", "CSV", t("file-csv")],
];
/** @type {Array<[string, string]>} */
const PARTS = [
  ["all", t("part-all")],
  ["seen", t("part-seen")],
];
/** @type {Array<[string, string]>} */
const SIZES = [
  ["a4", "A4"],
  ["a3", "A3"],
  ["a2", "A2"],
  ["a1", "A1"],
];
/** @type {Array<[string, string]>} */
const SCALES = [
  ["0", t("largest-scale")],
  .../** @type {Array<[string, string]>} */ (
    [10, 20, 25, 50, 100, 200, 250, 500, 1000].map((one) => [String(one), `1 : ${one}`])
  ),
];

/**
 * Fills the panel of exported files.
 * @param {HTMLElement} host
 * @param {SlicesPage} page
 */
export function exportPanel(host, { id, change, state, ask }) {
  const chosen = { part: "all", size: "a4", scale: "0", flat: false, draft: false };
  /** @type {{facts: SliceFacts | null}} */
  const map = { facts: null };
  const choose = (/** @type {Partial<typeof chosen>} */ changes) => {
    Object.assign(chosen, changes);
    draw();
  };

  function wanted() {
    const { window, ...look } = ask();
    const ofTheScreen = { width: undefined, height: undefined, ground: undefined };
    const { count, spacing } = state();
    const { part, size, scale, flat, draft } = chosen;
    return {
      ...look,
      ...ofTheScreen,
      window: part === "seen" ? (window ?? null) : null,
      count,
      spacing_m: spacing,
      size,
      scale: Number(scale),
      flat,
      draft,
    };
  }

  const setCount = (/** @type {Event} */ event) => {
    const count = targetOf(event).valueAsNumber;
    if (count >= 1) change({ count: Math.round(count) }, { keep: true });
  };
  const setSpacing = (/** @type {Event} */ event) => {
    const spacing = targetOf(event).valueAsNumber;
    if (Number.isFinite(spacing)) change({ spacing }, { keep: true });
  };
  const places = () => ({ message: within(host, ".error"), status: within(host, ".status") });
  const check = (/** @type {"flat" | "draft"} */ name, /** @type {string} */ text) => {
    const set = (/** @type {Event} */ event) => choose({ [name]: targetOf(event).checked });
    return html`<label class="check"
      ><input type="checkbox" id=${name} .checked=${chosen[name]} @change=${set} /><span
        >${text}</span
      ></label
    >`;
  };

  function draw() {
    const { part, size, scale } = chosen;
    const file = wanted();
    render(
      html`<div class="row">
          <label
            ><span>${t("part")}</span>${choice(t("what-exported"), PARTS, part, (one) =>
              choose({ part: one }),
            )}</label
          >
          <label
            ><span>${t("paper")}</span>${choice(t("paper"), SIZES, size, (one) =>
              choose({ size: one }),
            )}</label
          >
          <label
            ><span>${t("scale")}</span>${choice(t("scale"), SCALES, scale, (one) =>
              choose({ scale: one }),
            )}</label
          >
          <label
            ><span>${t("slices-label")}</span
            ><input
              type="number"
              min="1"
              max="200"
              aria-label=${t("number-of-slices")}
              .value=${String(state().count)}
              @change=${setCount}
          /></label>
          <label
            ><span>${t("spacing")}</span
            ><input
              type="number"
              step="0.05"
              aria-label=${t("spacing-label")}
              .value=${String(state().spacing)}
              @change=${setSpacing}
          /></label>
        </div>
        ${check("flat", t("dxf-flat"))}
        <div>${map.facts ? approvalLines(map.facts.approval) : nothing}</div>
        ${check("draft", t("draft"))}
        <ul class="files">
          ${KINDS.map(
            ([ending, name, about]) =>
              html`<li>
                <a download href=${sliceFileUrl(id, ending, file)} @click=${askFirst(places)}
                  >${name}</a
                ><small>${about}</small>
              </li>`,
          )}
        </ul>
        <p class="quiet status" role="status"></p>
        ${messagePlace()}`,
      host,
    );
  }

  return {
    show: draw,
    facts: (/** @type {SliceFacts} */ facts) => {
      map.facts = facts;
      draw();
    },
  };
}
