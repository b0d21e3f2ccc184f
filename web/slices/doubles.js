// Double walls: surfaces that two visits put at two places; a click on one shows it in the slice.

import { readDoubleWalls } from "../shared/api.js";
import {
  attempt,
  byId,
  html,
  messagePlace,
  nothing,
  render,
  repeat,
  within,
} from "../shared/dom.js";
import { count } from "../shared/format.js";
import { choice } from "./columns.js";
import { distanceFrom } from "./state.js";

/**
 * @import {DoubleReport, DoubleWall} from "../shared/http_types"
 * @import {Panel, SlicesPage} from "./findings.js"
 * @import {SliceState} from "./state.js"
 */

/** Half the size of a place [m]. */
const REACH_M = 0.75;
const MAX_ROWS = 50;

const cm = (/** @type {number | null} */ m) => (m === null ? "–" : `${(m * 100).toFixed(1)} cm`);
const range = (/** @type {number[]} */ [from, to]) => `${from}–${to}`;
const span = (/** @type {number[]} */ [from, to]) => `${from.toFixed(0)}–${to.toFixed(0)} s`;

/**
 * A close horizontal slice through the middle; if the surface is level, a vertical one across.
 * @returns {Partial<SliceState>}
 */
function cutAt(/** @type {DoubleWall} */ wall) {
  const [x, y, z] = wall.middle_m;
  /** @type {Partial<SliceState>} */
  const close = { t: 0.1, color: "time", lo: null, hi: null, m: 0.003 };
  if (Math.abs(wall.normal[2]) < 0.7) return { ...close, kind: "horizontal", z, u: x, v: y };
  return { ...close, kind: "vertical", a: [x - 2, y], b: [x + 2, y], u: 2, v: z };
}

/**
 * Fills the panel of double walls.
 * @param {HTMLElement} host
 * @param {SlicesPage} page
 * @returns {Panel}
 */
export function doublesPanel(host, { id, change, point, state }) {
  const found = {
    searching: false,
    /** @type {DoubleReport | null} */
    report: null,
    which: "double",
    where: "all",
  };
  const set = (/** @type {Partial<typeof found>} */ changes) => {
    Object.assign(found, changes);
    draw();
  };

  async function look() {
    set({ searching: true });
    try {
      const report = await readDoubleWalls(id, state().source);
      set({ report, which: report.walls.length ? "double" : "all" });
    } finally {
      set({ searching: false });
    }
  }

  const inSlice = (/** @type {DoubleWall} */ wall) =>
    distanceFrom(state(), wall.middle_m) <= state().t / 2 + REACH_M;

  function go(/** @type {DoubleWall} */ wall) {
    point(wall.middle_m.slice(0, 2));
    change(cutAt(wall));
    byId("views").scrollIntoView({ block: "nearest" });
  }

  /** The selected places; with "In this slice" they follow the slice. */
  function places(/** @type {DoubleReport} */ { walls, surfaces }) {
    const asked = found.which === "all" ? [...walls, ...surfaces] : walls;
    if (!asked.length) return nothing;
    const meant = found.where === "slice" ? asked.filter(inSlice) : asked;
    const most = meant.length > MAX_ROWS ? `, the ${MAX_ROWS} worst are listed` : "";
    const rows = repeat(
      meant.slice(0, MAX_ROWS),
      (wall) => wall,
      (wall) => row(wall, walls.includes(wall), () => go(wall)),
    );
    return html`<p class="quiet" role="status">${meant.length} of ${asked.length} places${most}</p>
      ${meant.length ? table(rows) : nothing}`;
  }

  function draw() {
    const { searching, report, which, where } = found;
    const any = report !== null && report.walls.length + report.surfaces.length > 0;
    render(
      html`<p class="quiet">
          A wall is double where two visits put one surface at two places. The whole map is checked.
        </p>
        <div class="row">
          <button
            type="button"
            ?disabled=${searching}
            @click=${() => attempt(within(host, ".error"), look)}
          >
            ${searching ? "Searching…" : "Find double walls"}
          </button>
          ${
            any
              ? [
                  choice("Which surfaces", WHICH, which, (one) => set({ which: one })),
                  choice("Where", WHERE, where, (one) => set({ where: one })),
                ]
              : nothing
          }
        </div>
        ${messagePlace()} ${report ? verdict(report) : nothing}
        <div class="scroll">${report ? places(report) : nothing}</div>`,
      host,
    );
  }

  draw();
  return { show: draw };
}

/** @type {Array<[string, string]>} */
const WHICH = [
  ["double", "Only double ones"],
  ["all", "All visited twice, worst first"],
];
/** @type {Array<[string, string]>} */
const WHERE = [
  ["all", "Whole map"],
  ["slice", "In this slice"],
];
const HEADS = [
  ...["Place", "", "Separation", "Limit", "Thickness σ as measured"],
  ...["D = separation / σ", "Weaker layer", "Visits"],
];

function verdict(/** @type {DoubleReport} */ found) {
  const seen = found.patches
    ? `${count(found.patches)} patches were visited twice; distance between the visits ` +
      `${cm(found.median_separation_m)} (median), ${cm(found.p95_separation_m)} (95 %); ` +
      `thickness σ as measured ${cm(found.median_sigma_m)}.`
    : "No surface was visited twice: double walls cannot be detected.";
  return html`${
      found.walls.length
        ? html`<p class="verdict bad">✕ ${found.walls.length} double walls</p>`
        : html`<p class="verdict good">
            ${found.patches ? "✓ No double wall found" : "– Not checked"}
          </p>`
    }
    <p class="quiet">${seen}</p>`;
}

const table = (/** @type {unknown} */ rows) =>
  html`<table>
    <thead>
      <tr>
        ${HEADS.map((text) => html`<th scope="col">${text}</th>`)}
      </tr>
    </thead>
    <tbody>
      ${rows}
    </tbody>
  </table>`;

/**
 * @param {DoubleWall} wall
 * @param {boolean} double
 * @param {() => void} go
 */
function row(wall, double, go) {
  const place = wall.middle_m.map((x) => x.toFixed(1)).join(" ");
  const times = wall.spans_s.map(span).join(" and ");
  return html`<tr>
    <td>
      <button type="button" class="go" @click=${go} aria-label="Go to ${place}">${place}</button>
    </td>
    <td class=${double ? "bad" : "good"}>${double ? "✕ double" : "✓ single"}</td>
    <td class="number">${cm(wall.separation_m)}</td>
    <td class="number">${cm(wall.limit_m)}</td>
    <td class="number">${cm(wall.sigma_m)}</td>
    <td class="number">${wall.bimodality.toFixed(1)}</td>
    <td class="number">${(wall.share * 100).toFixed(0)} %</td>
    <td>${times}; multiframes ${wall.frames.map(range).join(" and ")}</td>
  </tr>`;
}
