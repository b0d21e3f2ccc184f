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
import { decimal, t } from "../shared/texts.js";
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

const cm = (/** @type {number | null} */ m) => (m === null ? "–" : `${decimal(m * 100, 1)} cm`);
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
    const counts = { meant: meant.length, count: asked.length, most: MAX_ROWS };
    const rows = repeat(
      meant.slice(0, MAX_ROWS),
      (wall) => wall,
      (wall) => row(wall, walls.includes(wall), () => go(wall)),
    );
    return html`<p class="quiet" role="status">
        ${t(meant.length > MAX_ROWS ? "places-worst" : "places-of", counts)}
      </p>
      ${meant.length ? table(rows) : nothing}`;
  }

  function draw() {
    const { searching, report, which, where } = found;
    const any = report !== null && report.walls.length + report.surfaces.length > 0;
    render(
      html`<p class="quiet">${t("double-is")}</p>
        <div class="row">
          <button
            type="button"
            ?disabled=${searching}
            @click=${() => attempt(within(host, ".error"), look)}
          >
            ${searching ? t("searching") : t("find-double")}
          </button>
          ${
            any
              ? [
                  choice(t("which-surfaces"), WHICH, which, (one) => set({ which: one })),
                  choice(t("where"), WHERE, where, (one) => set({ where: one })),
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
  ["double", t("only-double")],
  ["all", t("all-twice")],
];
/** @type {Array<[string, string]>} */
const WHERE = [
  ["all", t("whole-map")],
  ["slice", t("in-this-slice")],
];
const HEADS = [
  ...[t("place"), "", t("separation"), t("limit"), t("thickness-measured")],
  ...[t("d-is"), t("weaker-layer"), t("visits")],
];

function verdict(/** @type {DoubleReport} */ found) {
  const seen = found.patches
    ? t("twice-is", {
        patches: count(found.patches),
        median: cm(found.median_separation_m),
        most: cm(found.p95_separation_m),
        sigma: cm(found.median_sigma_m),
      })
    : t("none-twice");
  return html`${
      found.walls.length
        ? html`<p class="verdict bad">${t("double-found", { count: found.walls.length })}</p>`
        : html`<p class="verdict good">${found.patches ? t("no-double") : t("not-checked")}</p>`
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
  const place = wall.middle_m.map((x) => decimal(x, 1)).join(" ");
  const times = wall.spans_s.map(span).join(` ${t("and")} `);
  return html`<tr>
    <td>
      <button type="button" class="go" @click=${go} aria-label=${t("go-to", { place })}>
        ${place}
      </button>
    </td>
    <td class=${double ? "bad" : "good"}>${double ? t("double") : t("single")}</td>
    <td class="number">${cm(wall.separation_m)}</td>
    <td class="number">${cm(wall.limit_m)}</td>
    <td class="number">${cm(wall.sigma_m)}</td>
    <td class="number">${decimal(wall.bimodality, 1)}</td>
    <td class="number">${(wall.share * 100).toFixed(0)} %</td>
    <td>${times}; ${t("multiframes")} ${wall.frames.map(range).join(` ${t("and")} `)}</td>
  </tr>`;
}
