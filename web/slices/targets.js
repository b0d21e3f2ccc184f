// Survey targets found in the whole map: proposals, of which a person takes some.

import { cancelSearch, listSearches, orderSearch, readFound, readSearch } from "../shared/api.js";
import { attempt, html, nothing, render, targetOf, within } from "../shared/dom.js";
import { decimal, t } from "../shared/texts.js";
import { AXES } from "./measured.js";

/**
 * @import {TargetList, TargetRow, TargetSearch} from "../shared/http_types"
 * @import {Measurement} from "./measured.js"
 * @typedef {object} TargetsPage what the section needs of the panel
 * @property {string} id of the project
 * @property {() => string} crs of the survey
 * @property {() => Promise<unknown>} stored when what was decided of the survey is
 * @property {(measured: Record<string, Measurement>) => Promise<unknown>} put
 * @property {(p_map: [number, number, number]) => void} go
 */

const MAX_OTHERS = 100;
const WATCH_MS = 1000;
const waits = (/** @type {TargetSearch} */ one) => ["queued", "running"].includes(one.state);
const KINDS = {
  plate: t("target-plate"),
  board: t("target-board"),
  sphere: t("target-sphere"),
};
const mm = (/** @type {number | null | undefined} */ m) =>
  m === null || m === undefined ? "–" : decimal(1000 * m, 1);

/**
 * Fills the section of targets.
 * @param {HTMLElement} host
 * @param {TargetsPage} page
 */
export function targetsSection(host, { id, crs, stored, put, go }) {
  const state = {
    found: /** @type {TargetList | null} */ (null),
    chosen: /** @type {Set<string>} */ (new Set()),
    searching: false,
    search: /** @type {TargetSearch | null} */ (null),
    taken: 0,
  };
  const set = (/** @type {Partial<typeof state>} */ changes) => {
    Object.assign(state, changes);
    draw();
  };
  const run = (/** @type {() => Promise<unknown>} */ work) => attempt(within(host, ".error"), work);

  async function search() {
    set({ searching: true, taken: 0 });
    try {
      await stored(); // else its points have no names yet
      await watch(await orderSearch(id));
    } finally {
      set({ searching: false, search: null });
    }
  }

  /** Waits for the end of a search, and shows what it found. */
  async function watch(/** @type {TargetSearch} */ one) {
    set({ searching: true, search: one });
    while (waits(one)) {
      await new Promise((resolve) => setTimeout(resolve, WATCH_MS));
      one = await readSearch(id, one.id);
      set({ search: one });
    }
    if (one.state === "failed") throw new Error(one.note);
    if (one.state !== "succeeded") return; // a person cancelled it
    const found = await readFound(id, one.id, crs());
    const sure = found.rows.filter((row) => row.id && !row.ambiguous);
    set({ found, chosen: new Set(sure.map((row) => row.id ?? "")) });
  }

  /** Goes on with a search that was ordered before the page was opened. */
  async function resume() {
    const [newest] = await listSearches(id);
    if (!newest || !waits(newest) || state.searching) return;
    try {
      await watch(newest);
    } finally {
      set({ searching: false, search: null });
    }
  }

  async function take() {
    const rows = state.found?.rows.filter((one) => state.chosen.has(one.id ?? "")) ?? [];
    await put(Object.fromEntries(rows.map((one) => [one.id, { p: one.p_map, along: AXES }])));
    set({ taken: rows.length, found: null }); // its rows are those of the points now
  }

  function choose(/** @type {string} */ name, /** @type {boolean} */ wanted) {
    const chosen = new Set(state.chosen);
    if (wanted) chosen.add(name);
    else chosen.delete(name);
    set({ chosen, taken: 0 });
  }

  function row(/** @type {TargetRow} */ one, /** @type {number} */ number) {
    const name = one.id ?? "";
    const [x, y, z] = one.p_map.map((value) => decimal(value, 3));
    return html`<tr>
      <td>
        ${
          name
            ? html`<label class="check"
                ><input
                  type="checkbox"
                  aria-label=${t("target-choose", { name })}
                  .checked=${state.chosen.has(name)}
                  @change=${(/** @type {Event} */ event) =>
                    choose(name, /** @type {HTMLInputElement} */ (targetOf(event)).checked)}
                /><span>${name}</span></label
              >`
            : "–"
        }
      </td>
      <td>${KINDS[one.kind]}</td>
      <td class="number">${mm(one.off_m)}</td>
      <td class="number">${mm(one.sd_m)}</td>
      <td class="number">${x} ${y} ${z}</td>
      <td>
        <button
          type="button"
          class="go"
          aria-label=${t("target-go", { number: number + 1 })}
          @click=${() => go(one.p_map)}
        >
          ${t("go")}
        </button>
      </td>
    </tr>`;
  }

  function table(/** @type {TargetRow[]} */ rows, first = 0) {
    const heads = ["target-point", "target-kind", "target-off", "target-sd"];
    return html`<div class="scroll">
      <table>
        <thead>
          <tr>
            ${heads.map(
              (text, k) => html`<th scope="col" class=${k > 1 ? "number" : ""}>${t(text)}</th>`,
            )}
            <th scope="col" class="number">x y z [m]</th>
            <th scope="col">${t("where")}</th>
          </tr>
        </thead>
        <tbody>
          ${rows.map((one, k) => row(one, first + k))}
        </tbody>
      </table>
    </div>`;
  }

  function outcome(/** @type {TargetList} */ { rows, missing, rmse_m }) {
    if (!rows.length) return html`<p>${t("targets-none")}</p>`;
    const named = rows.filter((one) => one.id);
    const others = rows.filter((one) => !one.id);
    const count = named.length + (missing?.length ?? 0);
    const doubtful = named.filter((one) => one.ambiguous).map((one) => one.id);
    return html`${
      !count
        ? nothing
        : named.length
          ? html`<p>${t("targets-named", { named: named.length, count, off: mm(rmse_m) })}</p>`
          : html`<p class="bad">✕ ${t("targets-unnamed")}</p>`
    }
    ${
      doubtful.length
        ? html`<p class="bad">✕ ${t("targets-ambiguous", { names: doubtful.join(", ") })}</p>`
        : nothing
    }
    ${
      named.length && missing?.length
        ? html`<p>${t("targets-missing", { names: missing.join(", ") })}</p>`
        : nothing
    }
    ${
      named.length
        ? html`${table(named)}
            <div class="buttons">
              <button type="button" ?disabled=${!state.chosen.size} @click=${() => run(take)}>
                ${t("targets-take", { count: state.chosen.size })}
              </button>
            </div>`
        : nothing
    }
    ${
      others.length
        ? html`<details ?open=${!named.length}>
            <summary>${t("targets-others", { count: others.length })}</summary>
            ${table(others.slice(0, MAX_OTHERS), named.length)}
          </details>`
        : nothing
    }`;
  }

  function progress(/** @type {TargetSearch} */ { id: search_id, state: now, step, fraction }) {
    const kind = KINDS[/** @type {keyof typeof KINDS} */ (step.slice(0, -1))]; // "plates"
    const what = kind ?? t("targets-tiles");
    return html`<p role="status">
        ${now === "queued" ? t("targets-wait") : `${what}: ${Math.round(100 * (fraction ?? 0))} %`}
      </p>
      <div class="buttons">
        <button type="button" @click=${() => run(() => cancelSearch(id, search_id))}>
          ${t("cancel")}
        </button>
      </div>`;
  }

  function draw() {
    const { found, searching, search: one, taken } = state;
    render(
      html`<h2>${t("targets-of-map")}</h2>
        <p class="quiet">${t("targets-are")}</p>
        <div class="buttons">
          <button type="button" ?disabled=${searching} @click=${() => run(search)}>
            ${searching ? t("searching-targets") : t("find-targets")}
          </button>
        </div>
        ${one && waits(one) ? progress(one) : nothing}
        <p class="quiet" role="status">${taken ? t("targets-taken", { count: taken }) : ""}</p>
        <p class="error" role="alert"></p>
        ${found ? outcome(found) : nothing}`,
      host,
    );
  }

  draw();
  run(resume);
}
