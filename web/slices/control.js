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
import { columnTable, missing } from "./columns.js";
import { ENLARGED, knownPlaces } from "./ellipses.js";
import { limitsForm } from "./limits.js";
import { AXES, combined } from "./measured.js";
import { figures, HEADS, residualCells, roleText } from "./residual_table.js";
import { siteSection } from "./site.js";
import { base64Of, firstPoint } from "./survey_file.js";
import { targetsSection } from "./targets.js";

/**
 * @import {
 *   ControlPoint, ControlPreview, ControlReport, ControlSpec, ControlState, LimitsSpec,
 *   Residual, SliceFacts
 * } from "../shared/http_types"
 * @import {Columns, Unit} from "./columns.js"
 * @import {Panel, SlicesPage} from "./findings.js"
 * @import {Measurement} from "./measured.js"
 * @typedef {Required<Omit<ControlState, "limits" | "version">> &
 *   Pick<ControlState, "version"> & {limits: LimitsSpec}} KeptControl as the server sends it
 * @typedef {{file: File, found: ControlPreview, unit: Unit | null}} Preview of a survey file
 */

const MAX_ROWS = 300;
const FILES = ".csv,.txt,.dxf";
const MAX_NAMED = 10;
/** @type {Record<string, Columns[number]>} */
const SWAPPED = { x: "y", y: "x", "-x": "-y", "-y": "-x" };

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
    georeferenced: false,
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

  /** The first rows of a survey file, its columns and its points. */
  function previewed(/** @type {Preview} */ { file, found, unit }) {
    const use = (/** @type {ControlState["frame"]} */ frame) => () =>
      keep((now) => ({ points: found.points, frame, picks: {}, along: {}, limits: now.limits }));
    const again = (/** @type {Columns} */ columns, /** @type {Unit | null} */ other) => {
      const open = missing(columns);
      const asked = { ...found.table, columns, question: `${open}.` };
      if (open)
        return set({
          preview: { file, found: { ...found, points: [], table: asked }, unit: other ?? unit },
        });
      return attempt(message(), () => look(file, columns, other ?? unit));
    };
    const columns = found.table.columns.map((one) => SWAPPED[one] ?? one);
    const some = found.points.length > 0;
    return html`${columnTable(found.table, again)}
      <p>${firstPoint(found)}</p>
      ${found.skipped.slice(0, 5).map((text) => html`<p class="error">${text}</p>`)}
      <div class="buttons">
        ${button(t("swap"), () => look(file, columns, unit))}
        ${some ? button(t("use-map"), use("map")) : nothing}
        ${some && state.georeferenced ? button(t("use-crs"), use("crs")) : nothing}
      </div>`;
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

  const drop = (/** @type {string} */ name) =>
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

  /**
   * @param {ControlSpec} one
   * @param {Residual | undefined} residual
   * @param {boolean} earlier measured in an earlier map only
   */
  function row(one, residual, earlier) {
    const setRole = (/** @type {Event} */ event) => {
      const role = /** @type {ControlSpec["role"]} */ (targetOf(event).value);
      const points = (/** @type {KeptControl} */ now) =>
        now.points.map((p) => (p.id === one.id ? { ...p, role } : p));
      attempt(message(), () => keep((now) => ({ ...now, points: points(now) })));
    };
    const act = (
      /** @type {string} */ text,
      /** @type {string} */ label,
      /** @type {() => unknown} */ action,
    ) => button(text, action, { label, className: "go" });
    return html`<tr>
      <th scope="row">${one.id}</th>
      <td>
        <select aria-label=${t("role-of", { name: one.id })} @change=${setRole}>
          ${["check", "control"].map(
            (role) =>
              html`<option value=${role} .selected=${role === one.role}>${roleText(role)}</option>`,
          )}
        </select>
      </td>
      ${residualCells(residual, earlier)}
      <td>
        <span class="buttons"
          >${act(t("go"), t("go-to-point", { name: one.id }), () => go(one))}${act(
            t("here"),
            t("is-picked", { name: one.id }),
            () => pick(one),
          )}
          ${act(t("target"), t("is-target", { name: one.id }), () => target(one))}
          ${act(t("surface"), t("on-surface", { name: one.id }), () => surface(one))}
          ${
            residual || earlier
              ? act(t("clear"), t("clear-point", { name: one.id }), () => drop(one.id))
              : nothing
          }</span
        >
      </td>
    </tr>`;
  }

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
    const none = html`<p class="quiet">${t("no-points-yet")}</p>`;
    render(
      html`<input type="file" accept=${FILES} aria-label=${t("survey-file")} @change=${pickFile} />
        <div>${preview ? previewed(preview) : nothing}</div>
        <p class="quiet status" role="status"></p>
        <p class="error problem" role="alert"></p>
        <div>${now && found ? reported(now, found) : now ? none : nothing}</div>
        <section class="targets"></section>
        <section class="site" ?hidden=${!found}></section>`,
      host,
    );
  }

  const places = () => ({ message: message(), status: within(host, ".status") });

  /**
   * The residuals, with the verdict on them.
   * @param {KeptControl} now
   * @param {ControlReport} found
   */
  function reported({ points, limits }, found) {
    const { searching, refused } = state;
    const residuals = new Map(found.rows.map((one) => [one.id, one]));
    const earlier = new Set(found.outdated);
    const file = (/** @type {string} */ ending) => controlFileUrl(id, ending, refused);
    const draft = refused ? t("as-draft") : "";
    return html`<p class="verdict ${found.verdict.level}">${found.verdict.text}</p>
      ${
        earlier.size
          ? html`<p>${t("measured-earlier", { names: named(found.outdated) })}</p>`
          : nothing
      }
      ${limitsForm(limits, found.limits, setLimits)}
      ${found.hint ? html`<p class="bad">✕ ${found.hint}</p>` : nothing}
      ${found.figures.map(figures)}
      <div class="scroll">
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
              (one) => row(one, residuals.get(one.id), earlier.has(one.id)),
            )}
          </tbody>
        </table>
      </div>
      <p class="quiet">${t("residuals-are")} ${t("ellipses-are", { times: ENLARGED })}</p>
      ${
        points.length > MAX_ROWS
          ? html`<p class="quiet">
              ${t("first-of-points", { shown: MAX_ROWS, count: points.length })}
            </p>`
          : nothing
      }
      <div class="buttons">
        ${button(searching ? `${searching}…` : t("all-surfaces"), everySurface, {
          disabled: searching !== "",
        })}
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
  siteSection(within(host, ".site"), id);
  attempt(message(), async () => {
    await readKept();
    await report();
  });
  return {
    facts: (/** @type {SliceFacts} */ { crs, key, approval }) =>
      set({ georeferenced: Boolean(crs), mapKey: key, refused: isRefused(approval) }),
  };
}
