// Another map beside this one: ordered, watched, shown as differences or behind a divider.

import { idHere } from "../shared/address.js";
import {
  cancelComparison,
  comparisonUrl,
  listComparisons,
  orderComparison,
  pointReader,
  readCorePoints,
  readMapIndex,
} from "../shared/api.js";
import {
  attempt,
  byId,
  html,
  nothing,
  render,
  showError,
  targetOf,
  within,
} from "../shared/dom.js";
import { count, when } from "../shared/format.js";
import { decimal, t } from "../shared/texts.js";
import { ALONE, BELOW, OTHER, RAMP, usualReach } from "./compare_colors.js";
import { CorePoints } from "./compare_points.js";
import { MapBeside } from "./compare_swipe.js";
import { NOT_COMPARED } from "./compare_state.js";
import { css } from "./colors.js";
import { numberField } from "./number_field.js";
import { page } from "./page.js";

/**
 * @import {Act} from "./bar.js"
 * @import {Compared} from "./compare_state.js"
 * @import {Stored} from "./tiles.js"
 * @import {MapCanvas} from "./map_canvas.js"
 * @import {Comparisons, ComparisonView, OtherMap} from "../shared/http_types"
 */

const WATCH_MS = 1000;
const id = idHere();
const known = {
  /** @type {Comparisons | null} */
  list: null,
  watching: 0,
  /** @type {CorePoints | null} */
  points: null,
  /** @type {MapBeside | null} */
  other: null,
  shown: "", // what was read: the id of a comparison, and how it is shown
  align: false,
};

const chosen = () => known.list?.comparisons.find((one) => one.id === page.state.compare.id);
const reachOf = (/** @type {ComparisonView} */ one) =>
  page.state.compare.reach ?? usualReach(one.found?.distances);

/**
 * What is done with comparisons; the caller shows refusals.
 * @param {{change: Act["change"], draw: () => void, canvas: () => MapCanvas | null,
 *   values: () => Stored | ""}} stage `values`: by what the map is colored
 */
export function compareOf({ change, draw, canvas, values }) {
  async function read() {
    known.list = await listComparisons(id);
    const running = known.list.comparisons.some(({ state }) =>
      ["queued", "running"].includes(state),
    );
    clearTimeout(known.watching);
    if (running) known.watching = setTimeout(() => read().catch(() => {}), WATCH_MS);
    await show();
    draw();
  }

  /** Puts what the state says onto the canvas. */
  const show = () => attempt(byId("message"), draws);

  async function draws() {
    const one = chosen();
    const { swipe } = page.state.compare;
    if (!one?.kept || !one.found) return clear();
    const wanted = `${one.id} ${swipe === null}`;
    if (known.shown !== wanted) {
      clear();
      known.shown = wanted;
      const made = swipe === null ? await pointsOf(one) : await otherOf(one);
      if (known.shown !== wanted) return made.dispose(); // another one was chosen meanwhile
      if (made instanceof MapBeside) known.other = made;
      else known.points = made;
      known.other?.begin(values()).catch(report);
    }
    known.points?.color(reachOf(one));
    canvas()?.differ(known.points);
    if (known.other) known.other.part = swipe ?? 1;
    canvas()?.beside(known.other);
  }

  function clear() {
    canvas()?.differ(null);
    canvas()?.beside(null);
    known.points?.dispose();
    known.other?.dispose();
    Object.assign(known, { points: null, other: null, shown: "" });
  }

  return {
    read,
    show,
    /** Colors the other map by other values. */
    color: () => known.other?.color(values()).catch(report),
    /** Changes what is shown of the other map. */
    async set(/** @type {Partial<Compared>} */ next) {
      change({ compare: { ...page.state.compare, ...next } });
      await show();
      draw();
    },
    order: (/** @type {string} */ against) =>
      attempt(byId("message"), async () => {
        const body = { against, align: known.align, core_spacing_m: 0.1 };
        const made = await orderComparison(id, body);
        change({ compare: { ...NOT_COMPARED, id: made.id } });
        await read();
      }),
    cancel: (/** @type {string} */ comparison) =>
      attempt(byId("message"), async () => {
        await cancelComparison(id, comparison);
        await read();
      }),
  };
}

const report = (/** @type {unknown} */ problem) => showError(byId("message"), problem);

async function pointsOf(/** @type {ComparisonView} */ one) {
  const data = await readCorePoints(id, one.id);
  return new CorePoints(data, { step: known.list?.step_m ?? 1, spacing: one.core_spacing_m });
}

/** The other map as it was compared. */
async function otherOf(/** @type {ComparisonView} */ { against, found }) {
  const [kind, name] = against.split(":");
  const project = kind === "project" ? name : id;
  const index = await readMapIndex(project, found?.second.key);
  const other = new MapBeside(index, pointReader(project, index), found?.T_a_b ?? []);
  other.tiles.onProblem = report;
  return other;
}

/**
 * The divider between the two maps, over the canvas.
 * @param {HTMLElement} element
 * @param {Act} act
 */
export function drawDivider(element, act) {
  const { swipe } = page.state.compare;
  const slides = (/** @type {Event} */ event) =>
    act.compare.set({ swipe: Number(targetOf(event).value) / 100 });
  const one = chosen();
  render(
    swipe === null || !one?.found || !known.other
      ? nothing
      : html`<span class="here" .style=${`right: ${100 - 100 * swipe}%`}>${t("cmp-here")}</span
          ><span .style=${`left: ${100 * swipe}%`}>${titleOf(one.against)}</span
          ><input
            type="range"
            min="0"
            max="100"
            step="0.5"
            aria-label=${t("cmp-divider")}
            .value=${String(100 * swipe)}
            @input=${slides}
          />`,
    element,
  );
}

/** What another map is called. */
const nameOf = (/** @type {OtherMap} */ { kind, name }) =>
  kind === "map" ? t("cmp-earlier", { time: name }) : t("cmp-project", { name });

const titleOf = (/** @type {string} */ against) => {
  const other = known.list?.others.find((one) => one.id === against);
  return other ? nameOf(other) : against.slice(0, 24);
};

/** The section of the panel. */
export function compareSection(/** @type {Act} */ act) {
  const { list } = known;
  if (!list) return nothing;
  const done = list.comparisons.filter((one) => one.kept && one.found);
  return html`<section aria-labelledby="compare-title" class="compare">
    <h2 id="compare-title">${t("compare")}</h2>
    ${list.others.length ? order(list, act) : html`<p class="quiet">${t("cmp-nothing")}</p>`}
    ${shown(act)}
    ${
      done.length
        ? html`<details>
            <summary>${t("cmp-before")}</summary>
            <ul class="rows">
              ${done.map(
                (one) =>
                  html`<li>
                    <button
                      type="button"
                      class="place"
                      aria-pressed=${String(one.id === page.state.compare.id)}
                      @click=${() => act.compare.set({ ...NOT_COMPARED, id: one.id })}
                    >
                      ${titleOf(one.against)} <small>${one.person}, ${when(one.created)}</small>
                    </button>
                  </li>`,
              )}
            </ul>
          </details>`
        : nothing
    }
  </section>`;
}

/**
 * What is compared next.
 * @param {Comparisons} list
 * @param {Act} act
 */
function order(list, act) {
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    act.compare.order(within(targetOf(event), "select", HTMLSelectElement).value);
  };
  return html`<form class="line" @submit=${submit}>
    <label
      ><span>${t("cmp-with")}</span
      ><select required>
        ${list.others.map((one) => html`<option value=${one.id}>${nameOf(one)}</option>`)}
      </select></label
    >
    <label class="check" title=${t("cmp-align-hint")}
      ><input
        type="checkbox"
        .checked=${known.align}
        @change=${(/** @type {Event} */ event) => (known.align = targetOf(event).checked)}
      /><span>${t("cmp-align")}</span></label
    >
    <button>${t("cmp-order")}</button>
  </form>`;
}

/** The comparison that is chosen. */
function shown(/** @type {Act} */ act) {
  const one = chosen();
  if (!one) return nothing;
  if (["queued", "running"].includes(one.state))
    return html`<p role="status">
        ${
          one.state === "queued"
            ? t("cmp-waits")
            : t("cmp-runs", { percent: (100 * (one.fraction ?? 0)).toFixed(0) })
        }
      </p>
      <button type="button" @click=${() => act.compare.cancel(one.id)}>${t("cmp-cancel")}</button>`;
  if (!one.found || !one.kept)
    return html`<p class="error">
      ${one.note ? t("cmp-failed", { note: one.note }) : t("cmp-gone")}
    </p>`;
  return html`<p><b>${titleOf(one.against)}</b></p>
    <div class="buttons" role="group" aria-label=${t("cmp-show")}>
      ${mode(t("cmp-differences"), page.state.compare.swipe === null, () =>
        act.compare.set({ swipe: null }),
      )}
      ${mode(t("cmp-swipe"), page.state.compare.swipe !== null, () =>
        act.compare.set({ swipe: 0.5 }),
      )}
      ${mode(t("cmp-off"), false, () => act.compare.set(NOT_COMPARED))}
    </div>
    ${page.state.compare.swipe === null ? figures(one, act) : nothing}
    <a class="button" href=${comparisonUrl(id, one.id)} download>${t("cmp-download")}</a>`;
}

/**
 * @param {string} text
 * @param {boolean} pressed
 * @param {() => void} act
 */
const mode = (text, pressed, act) =>
  html`<button type="button" aria-pressed=${String(pressed)} @click=${act}>${text}</button>`;

/** What the colors of differences mean, and how many core points have each; null = none are. */
export function differencesLegend() {
  const one = chosen();
  if (!one?.found || !one.kept || page.state.compare.swipe !== null) return null;
  const { counts } = one.found;
  const mm = decimal(1000 * reachOf(one), 0);
  const ramp = `background: linear-gradient(to right, ${RAMP.map(css).join(", ")})`;
  const rows = /** @type {Array<[string, number[] | null, number]>} */ ([
    [t("cmp-significant"), null, counts.significant],
    [t("cmp-below"), BELOW, counts.below_lod],
    [t("cmp-alone"), ALONE, counts.without_partner],
    [t("cmp-other"), OTHER, counts.without_normal + counts.sparse],
  ]);
  return html`<p><b>${t("cmp-colors", { name: titleOf(one.against) })}</b></p>
    <div class="ramp" .style=${ramp}></div>
    <p class="ends">
      <span>${t("cmp-behind", { mm })}</span><span>${t("cmp-front", { mm })}</span>
    </p>
    <ul class="classes">
      ${rows.map(
        ([text, color, n]) =>
          html`<li>
            <i .style=${color ? `background: ${css(color)}` : ramp}></i>${text}
            <small>${count(n)}, ${decimal((100 * n) / Math.max(counts.core_points, 1), 1)} %</small>
          </li>`,
      )}
    </ul>`;
}

/**
 * The distances, and the ends of their colors.
 * @param {ComparisonView} one
 * @param {Act} act
 */
function figures(one, act) {
  if (!one.found) return nothing;
  const { distances, first, second } = one.found;
  return html`${
    distances
      ? html`<p class="quiet">
          ${t("cmp-figures", {
            median: decimal(1000 * distances.p50_m, 1),
            high: decimal(1000 * distances.p95_m, 1),
            lod: decimal(1000 * distances.lod_p50_m, 1),
          })}
          ${[first, second].some((of) => of.registration === "usual") ? t("cmp-usual") : nothing}
          ${one.of_this_map ? nothing : t("cmp-older")}
        </p>`
      : nothing
  }
  ${numberField(
    t("cmp-reach"),
    page.state.compare.reach === null ? null : 1000 * page.state.compare.reach,
    (value) => act.compare.set({ reach: value && value > 0 ? value / 1000 : null }),
    { usual: decimal(1000 * reachOf(one), 0), step: 1 },
  )}`;
}
