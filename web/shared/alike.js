// All things like one, as <class-corrections> shows them: how many, where, which are meant.

import { html, nothing, targetOf } from "./dom.js";
import { classText } from "./class_words.js";
import { count } from "./format.js";
import { decimal, t } from "./texts.js";

/**
 * @import {AlikeClusterView, AlikeView, ClustersSpec} from "./http_types"
 * @typedef {object} Found
 * @property {AlikeView} view
 * @property {number} limit more different ones are not meant
 * @property {Set<AlikeClusterView>} off those that were taken out
 * @typedef {object} Box bounds of a thing [m]
 * @property {number[]} low
 * @property {number[]} high
 */

export const USUAL = 1; // as one thing looks from two sides
const MOST = 3;
const STEP = 0.1;

/** Those that are as alike as was asked for. */
export const listed = (/** @type {Found} */ { view, limit }) =>
  view.clusters.filter(({ difference }) => difference <= limit);

/** Those of them that are meant. */
export const chosen = (/** @type {Found} */ found) =>
  listed(found).filter((one) => !found.off.has(one));

/** What is drawn of them. @returns {Box[]} */
export const boxesOf = (/** @type {Found | null} */ found) =>
  found ? chosen(found).map(({ low_m, high_m }) => ({ low: low_m, high: high_m })) : [];

/** Those that are meant as the server expects them. @returns {ClustersSpec | null} */
export function volumeOf(/** @type {Found} */ found) {
  const clusters = chosen(found).map(({ origin_m, columns }) => ({ origin_m, columns }));
  return clusters.length
    ? /** @type {ClustersSpec} */ ({ shape: "clusters", edge_m: found.view.edge_m, clusters })
    : null;
}

/** Middle of a thing [m]. */
export const middleOf = (/** @type {AlikeClusterView} */ { low_m, high_m }) =>
  low_m.map((x, k) => (x + high_m[k]) / 2);

/**
 * The fields.
 * @param {Found} found
 * @param {{change: (next: Partial<Found>) => void, look: (p: number[]) => void,
 *   forget: () => void}} act
 */
export function alikeFields(found, { change, look, forget }) {
  const { view, limit, off } = found;
  const meant = chosen(found);
  const points = meant.reduce((sum, one) => sum + one.points, 0);
  const toggle = (/** @type {AlikeClusterView} */ one) => () => {
    const next = new Set(off);
    if (!next.delete(one)) next.add(one);
    change({ off: next });
  };
  const row = (/** @type {AlikeClusterView} */ one) => {
    const [x, y, z] = middleOf(one).map((m) => decimal(m, 1));
    const where = t("alike-where", { x, y, z });
    return html`<li>
      <label class="check"
        ><input type="checkbox" .checked=${!off.has(one)} @change=${toggle(one)} /><span
          >${t("alike-points", { points: one.points })}<small
            >${where} · ${aboutOf(one)}</small
          ></span
        ></label
      ><button
        type="button"
        aria-label=${t("alike-show-of", { where })}
        @click=${() => look(middleOf(one))}
      >
        ${t("alike-show")}
      </button>
    </li>`;
  };
  return html`<p class="alike-count">
      <b>${t("alike-things", { count: meant.length, class: classText(view.only), points })}</b>
    </p>
    <label title=${t("alike-limit-means")}
      ><span>${t("alike-limit", { limit: decimal(limit, 1) })}</span
      ><input
        type="range"
        min="0"
        max=${MOST}
        step=${STEP}
        .value=${String(limit)}
        @input=${(/** @type {Event} */ event) => change({ limit: Number(targetOf(event).value) })}
    /></label>
    <ol class="alike">
      ${listed(found).map(row)}
    </ol>
    ${
      view.left_out
        ? html`<p class="quiet">${t("alike-left-out", { count: count(view.left_out) })}</p>`
        : nothing
    }
    <div class="buttons">
      <button type="button" @click=${forget}>${t("alike-forget")}</button>
    </div>`;
}

/** How alike a thing is and why, in words. */
function aboutOf(/** @type {AlikeClusterView} */ one) {
  const high = one.high_m[2] - one.low_m[2];
  const seen = one.seen_through;
  return [
    t("alike-difference", { difference: decimal(one.difference, 1) }),
    t("alike-high", { m: decimal(high, 1) }),
    one.over_ground_m === null
      ? ""
      : t("alike-over", { m: decimal(Math.max(0, one.over_ground_m), 1) }),
    seen === null ? "" : t("alike-seen", { percent: decimal(100 * seen, 0) }),
  ]
    .filter(Boolean)
    .join(" · ");
}
