// Control and check points: import, pick in the slice, residuals with pass or fail.

import {
  controlFileUrl,
  keepControl,
  previewControl,
  readControl,
  readControlReport,
  readSurface,
} from "../shared/api.js";
import { isRefused } from "../shared/approval.js";
import {
  asError,
  attempt,
  html,
  nothing,
  render,
  repeat,
  say,
  targetOf,
  within,
} from "../shared/dom.js";
import { askFirst } from "../shared/download.js";
import { t } from "../shared/texts.js";
import { ENLARGED, knownPlaces } from "./ellipses.js";
import { limitsForm } from "./limits.js";
import { AXES, combined } from "./measured.js";
import { pointRow } from "./point_row.js";
import { figures, HEADS } from "./residual_table.js";
import { siteSection } from "./site.js";
import { base64Of } from "./survey_file.js";
import { surveyPreview } from "./survey_preview.js";
import { targetsSection } from "./targets.js";

/**
 * @import {
 *   ControlPoint, ControlReport, ControlSpec, ControlState, LimitsSpec,
 *   Residual, SliceFacts
 * } from "../shared/http_types"
 * @import {Columns, Unit} from "./columns.js"
 * @import {Preview} from "./survey_preview.js"
 * @import {Panel, SlicesPage} from "./findings.js"
 * @import {Measurement} from "./measured.js"
 * @typedef {Required<Omit<ControlState, "limits" | "version">> &
 *   Pick<ControlState, "version"> & {limits: LimitsSpec}} KeptControl as the server sends it
 */

const MAX_ROWS = 300;
const FILES = ".csv,.txt,.dxf";
const MAX_NAMED = 10;

/**
 * A record without one of its fields.
 * @template {object} T
 * @param {T} record
 * @param {string} key
 */
const without = (record, key) =>
  /** @type {T} */ (Object.fromEntries(Object.entries(record).filter(([name]) => name !== key)));

const named = (/** @type {string[]} */ ids) =>
  ids.length > MAX_NAMED
    ? t("named-more", {
        names: ids.slice(0, MAX_NAMED).join(", "),
        count: ids.length - MAX_NAMED,
      })
    : ids.join(", ");

/**
 * Fills the panel of control and check points.
 * @param {HTMLElement} host
 * @param {SlicesPage} page
 * @returns {Panel}
 */
export function controlPanel(host, { id, change, point: pointAt, measured, known }) {
  const state = {
    kept: /** @type {KeptControl | null} */ (null),
    report: /** @type {ControlReport | null} */ (null),
    preview: /** @type {Preview | null} */ (null),
    mapKey: "",
    refused: false, // the approval of the map does not count
    crs: "", // of the map
    searching: "", // id of the point whose surface is searched
  };
  /** Changes, one after the other. */
  const turns = { last: /** @type {Promise<unknown>} */ (Promise.resolve()) };
  const message = () => within(host, ".problem");
  const set = (/** @type {Partial<typeof state>} */ changes) => {
    Object.assign(state, changes);
    draw();
  };
  const button = (
    /** @type {string} */ text,
    /** @type {() => unknown} */ action,
    { label = "", className = "", disabled = false } = {},
  ) =>
    html`<button
      type="button"
      class=${className}
      aria-label=${label || nothing}
      ?disabled=${disabled}
      @click=${() => attempt(message(), action)}
    >
      ${text}
    </button>`;

  /**
   * Reads the points of a survey file, to be confirmed.
   * @param {File} file
   * @param {Columns} [columns]
   * @param {Unit | null} [unit]
   */
  async function look(file, columns = [], unit = null) {
    const { status } = places();
    say(status, t("being-read", { name: file.name }));
    try {
      const asked = { name: file.name, base64: await base64Of(file), columns, unit };
      set({ preview: { file, found: await previewControl(id, asked), unit } });
    } finally {
      say(status, "");
    }
  }

  /** Stores the points; their system is that of the map if they lie in it. */
  async function use(/** @type {Preview} */ { found }) {
    const frame = found.lies || (state.crs ? "crs" : "map");
    const { points, crs = "" } = found;
    site.suggest(crs || (frame === "crs" ? state.crs : ""));
    await keep((now) => ({ points, frame, picks: {}, along: {}, limits: now.limits }));
  }

  /**
   * Applies changes one after the other to the stored state, which others may change too.
   * @param {(now: KeptControl) => ControlState} edit
   */
  function keep(edit) {
    const done = turns.last.then(() => write(edit));
    turns.last = done.catch(() => {});
    return done;
  }

  /**
   * @param {(now: KeptControl) => ControlState} edit
   * @returns {Promise<void>}
   */
  async function write(edit, tries = 5) {
    const now = state.kept ?? (await readKept());
    try {
      state.kept = kept(await keepControl(id, { ...edit(now), version: now.version }));
    } catch (error) {
      if (asError(error).status !== 409) throw error;
      await readKept();
      if (tries) return write(edit, tries - 1);
      await report();
      throw new Error(t("others-change"));
    }
    state.preview = null;
    return report();
  }

  const kept = (/** @type {ControlState} */ found) => /** @type {KeptControl} */ (found);
  const readKept = async () => (state.kept = kept(await readControl(id)));

  /** Stores measurements by point, each joined with what was measured there before. */
  const put = (/** @type {Record<string, Measurement>} */ measurements) =>
    keep((now) => {
      /** @type {Record<string, any>} */
      const picks = { ...now.picks };
      /** @type {Record<string, any>} */
      const along = { ...now.along };
      for (const [name, one] of Object.entries(measurements)) {
        const here = now.found_in?.[name] === state.mapKey && along[name];
        const joined = combined(here ? { p: picks[name], along: along[name] } : null, one);
        [picks[name], along[name]] = [joined.p, joined.along];
      }
      return { ...now, picks, along };
    });

  const drop = (/** @type {ControlSpec} */ { id: name }) =>
    keep((now) => ({
      ...now,
      picks: without(now.picks, name),
      along: without(now.along, name),
    }));

  async function report() {
    const points = state.kept?.points.length;
    set({ report: points ? await readControlReport(id) : null });
    known(knownPlaces(state.kept?.picks ?? {}, state.report?.rows ?? []));
  }

  /** null = the usual limits. */
  const setLimits = (/** @type {LimitsSpec | null} */ limits) =>
    attempt(message(), () => keep((now) => (limits ? { ...now, limits } : without(now, "limits"))));

  async function everySurface() {
    /** @type {Record<string, Measurement>} */
    const places = {};
    const none = [];
    try {
      for (const one of state.kept?.points ?? []) {
        set({ searching: one.id });
        const { surface, normal } = await readSurface(id, one.id);
        if (surface && normal) places[one.id] = { p: surface, along: [normal] };
        else none.push(one.id);
      }
    } finally {
      set({ searching: "" });
    }
    await put(places);
    if (none.length) say(message(), t("no-surface-of", { names: named(none) }));
  }

  const setRole = (
    /** @type {ControlSpec} */ { id: name },
    /** @type {ControlSpec["role"]} */ role,
  ) =>
    keep((now) => ({
      ...now,
      points: now.points.map((p) => (p.id === name ? { ...p, role } : p)),
    }));

  const go = async (/** @type {ControlSpec} */ one) => show((await readSurface(id, one.id)).p_map);

  function show(/** @type {[number, number, number]} */ p_map) {
    pointAt(p_map.slice(0, 2));
    change({ kind: "horizontal", z: p_map[2], u: p_map[0], v: p_map[1], m: 0.005 });
  }

  async function pick(/** @type {ControlSpec} */ one) {
    const picked = measured();
    if (!picked) throw new Error(t("pick-first", { name: one.id }));
    await put({ [one.id]: { p: picked.p_map, along: picked.along } });
  }

  async function target(/** @type {ControlSpec} */ one) {
    const found = measured()?.target;
    if (!found) throw new Error(t("no-target", { name: one.id }));
    await put({ [one.id]: { p: found.p_map, along: AXES } });
  }

  async function surface(/** @type {ControlSpec} */ one) {
    const { surface: at, normal } = await readSurface(id, one.id);
    if (!at || !normal) throw new Error(t("no-surface-pick", { name: one.id }));
    await put({ [one.id]: { p: at, along: [normal] } });
  }

  function draw() {
    const { kept: now, report: found, preview } = state;
    const pickFile = (/** @type {Event} */ event) => {
      const [file] = targetOf(event).files ?? [];
      if (file) attempt(message(), () => look(file));
    };
    const shown = preview
      ? surveyPreview(preview, state.crs, {
          read: (columns, unit) => attempt(message(), () => look(preview.file, columns, unit)),
          show: (other) => set({ preview: other }),
          use: () => use(preview),
          button,
        })
      : nothing;
    const none = html`<p class="quiet">${t("no-points-yet")}</p>`;
    render(
      html`<input type="file" accept=${FILES} aria-label=${t("survey-file")} @change=${pickFile} />
        <div>${shown}</div>
        <p class="quiet status" role="status"></p>
        <p class="error problem" role="alert"></p>
        <div>${now && found ? judged(found) : now && !preview ? none : nothing}</div>
        <section class="targets"></section>
        <div>${now && found ? pointsOf(now, found) : nothing}</div>
        <section class="site" ?hidden=${!found}></section>
        <div>${now && found ? figuresOf(now, found) : nothing}</div>`,
      host,
    );
  }

  const places = () => ({ message: message(), status: within(host, ".status") });

  const judged = (/** @type {ControlReport} */ found) =>
    html`<p class="verdict ${found.verdict.level}">${found.verdict.text}</p>
      ${
        found.outdated.length
          ? html`<p>${t("measured-earlier", { names: named(found.outdated) })}</p>`
          : nothing
      }
      ${found.hint ? html`<p class="bad">✕ ${found.hint}</p>` : nothing}`;

  /**
   * The points with their residuals, to be measured.
   * @param {KeptControl} now
   * @param {ControlReport} found
   */
  function pointsOf({ points }, found) {
    const { searching } = state;
    const residuals = new Map(found.rows.map((one) => [one.id, one]));
    const unused = new Map([
      ...found.outdated.map((name) => /** @type {const} */ ([name, t("found-earlier")])),
      ...found.absent.map((name) => /** @type {const} */ ([name, t("found-absent")])),
    ]);
    return html`<div class="scroll points" tabindex="0" role="region" aria-label=${t("points")}>
        <table>
          <thead>
            <tr>
              ${HEADS.map(
                (text, k) => html`<th scope="col" class=${k > 1 ? "number" : ""}>${text}</th>`,
              )}
            </tr>
          </thead>
          <tbody>
            ${repeat(
              points.slice(0, MAX_ROWS),
              (one) => one.id,
              (one) =>
                pointRow(one, residuals.get(one.id), unused.get(one.id) ?? "", {
                  attempt: (action) => attempt(message(), action),
                  ...{ setRole, go, pick, target, surface, drop },
                }),
            )}
          </tbody>
        </table>
      </div>
      ${
        points.length > MAX_ROWS
          ? html`<p class="quiet">
              ${t("first-of-points", { shown: MAX_ROWS, count: points.length })}
            </p>`
          : nothing
      }
      <p class="quiet">${t("residuals-are")} ${t("ellipses-are", { times: ENLARGED })}</p>
      <div class="buttons">
        ${button(searching ? `${searching}…` : t("all-surfaces"), everySurface, {
          disabled: searching !== "",
        })}
      </div>`;
  }

  /**
   * What was measured against the limits, and the files.
   * @param {KeptControl} now
   * @param {ControlReport} found
   */
  function figuresOf({ limits }, found) {
    const file = (/** @type {string} */ ending) => controlFileUrl(id, ending, state.refused);
    const draft = state.refused ? t("as-draft") : "";
    return html`${found.figures.map(figures)} ${limitsForm(limits, found.limits, setLimits)}
      <div class="buttons">
        <a class="button" download href=${file("csv")} @click=${askFirst(places)}
          >${t("residuals-csv")}${draft}</a
        >
        <a class="button" target="_blank" rel="noopener" href=${file("html")}
          >${t("sheet-to-sign")}${draft}</a
        >
      </div>`;
  }

  draw();
  const crs = () => /** @type {HTMLInputElement} */ (within(host, ".site input")).value.trim();
  targetsSection(within(host, ".targets"), { id, crs, stored: () => turns.last, put, go: show });
  const site = siteSection(within(host, ".site"), id, readKept);
  attempt(message(), async () => {
    await readKept();
    await report();
  });
  return {
    facts: (/** @type {SliceFacts} */ { crs, key, approval }) => {
      set({ crs, mapKey: key, refused: isRefused(approval) });
      if (state.kept?.frame === "crs") site.suggest(crs);
    },
  };
}
