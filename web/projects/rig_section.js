// <rig-section>: what the recording says of its rig, and what to do about it.

import { idHere } from "../shared/address.js";
import {
  addJob,
  listJobsOf,
  listRigs,
  projectUrl,
  readCalibration,
  readCalibrationSlices,
  readCurrentUser,
  rigUrl,
  saveCalibratedRig,
} from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import {
  attempt,
  fields,
  html,
  messagePlace,
  nothing,
  render,
  targetOf,
  within,
} from "../shared/dom.js";
import { decimal, t } from "../shared/texts.js";
import { calibrationSlices } from "./calibration_slices.js";
import { beamRows, calibratingJob, outcomeOf, rowsOf } from "./rig_audit.js";

/**
 * @import {CalibrationSlices, CalibrationView, SavedRig} from "../shared/http_types"
 * @import {Content} from "../shared/dom.js"
 */

const BEAM_HEADS = [t("rig-beam"), t("rig-range"), t("rig-elevation"), t("rig-azimuth")];
const HEADS = [t("rig-sensor"), t("rig-quantity"), t("rig-change"), t("rig-result")];

export class RigSection extends HTMLElement {
  #id = idHere();
  #mayProcess = false;
  #read = 0; // number of the newest request

  connectedCallback() {
    this.hidden = true;
    render(
      html`<h2>${t("figure-rig")}</h2>
        <div></div>
        ${messagePlace()}`,
      this,
    );
  }

  get #message() {
    return within(this, ":scope > .error");
  }

  /** Reads the audit of the latest run again. */
  async reload() {
    const number = ++this.#read;
    const found = await attempt(this.#message, async () => ({
      audit: await readCalibration(this.#id),
      slices: await readCalibrationSlices(this.#id),
      me: await readCurrentUser(),
    }));
    if (number !== this.#read) return;
    this.hidden = !found?.audit && !this.#message.textContent;
    if (!found?.audit) return;
    this.#mayProcess = found.me.may.includes("process");
    this.#draw(found.audit, found.slices);
  }

  /**
   * @param {CalibrationView} audit
   * @param {CalibrationSlices | null} slices
   */
  #draw(audit, slices) {
    const { mark, word, className } = outcomeOf(audit);
    render(
      html`<p class=${className}><b>${mark} ${word}</b></p>
        <p>${audit.outcome}</p>
        ${rigLine(audit)} ${audit.parameters.length ? auditTable(audit) : nothing}
        ${audit.beams.length ? beamTable(audit) : nothing} ${agreement(audit)}
        ${slices ? calibrationSlices(slices) : nothing}
        ${this.#mayProcess ? this.#buttons(audit) : nothing}`,
      within(this, "div"),
    );
  }

  #buttons(/** @type {CalibrationView} */ audit) {
    const { applied, saved, parameters } = audit;
    const off = parameters.some((one) => one.status === "off");
    return html`<div class="buttons">
      ${
        off && !applied
          ? html`<button type="button" @click=${() => this.#calibrate()}>
              ${t("rig-calibrate")}
            </button>`
          : nothing
      }
      ${
        applied && !saved
          ? html`<button type="button" @click=${() => this.#ask(audit)}>
              ${t("rig-save-open")}
            </button>`
          : nothing
      }
    </div>`;
  }

  async #calibrate() {
    const added = await attempt(this.#message, async () => {
      const job = calibratingJob(this.#id, await listJobsOf(this.#id));
      if (!job) throw new Error(t("rig-no-job"));
      return addJob(job);
    });
    if (added) location.assign(projectUrl(this.#id));
  }

  async #ask(/** @type {CalibrationView} */ { rig: used }) {
    const rigs = await attempt(this.#message, listRigs);
    if (!rigs) return;
    const own = rigs.filter((rig) => !rig.shipped).map((rig) => rig.id);
    const mine = own.find((id) => id === used?.id) ?? "";
    const option = (/** @type {string} */ value, /** @type {string} */ text) =>
      html`<option value=${value} ?selected=${value === mine}>${text}</option>`;
    const choose = (/** @type {string} */ into) => {
      const name = within(dialog, "[name=rig]", HTMLInputElement);
      name.disabled = /** @type {HTMLElement} */ (name.closest("label")).hidden = into !== "";
    };
    const dialog = openDialog(
      t("rig-save-title"),
      html`<form @submit=${(/** @type {SubmitEvent} */ event) => this.#save(event, dialog)}>
        <label
          ><span>${t("rig-save-as")}</span
          ><select name="into" @change=${(/** @type {Event} */ e) => choose(targetOf(e).value)}>
            ${own.map((id) => option(id, t("rig-new-version", { id })))} ${option("", t("rig-new"))}
          </select></label
        >
        <label
          ><span>${t("rig-new-name")}</span
          ><input
            name="rig"
            value=${this.#id}
            pattern="[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}"
            required
            autocomplete="off"
        /></label>
        <label
          ><span>${t("rig-note")}</span
          ><input name="note" maxlength="500" autocomplete="off" /><small
            >${t("rig-note-hint")}</small
          ></label
        >
        ${messagePlace()}
        <div class="buttons">${closeButton()}<button class="primary">${t("save")}</button></div>
      </form>`,
    );
    choose(mine);
  }

  /**
   * @param {SubmitEvent} event
   * @param {HTMLDialogElement} dialog
   */
  async #save(event, dialog) {
    event.preventDefault();
    const { into, rig, note } = fields(within(dialog, "form", HTMLFormElement));
    const create = into.value === "";
    const version = { rig: create ? rig.value : into.value, create, note: note.value.trim() };
    const save = () => saveCalibratedRig(this.#id, version);
    if (!(await attempt(within(dialog, ".error"), save))) return;
    dialog.close();
    await this.reload();
  }
}

customElements.define("rig-section", RigSection);

function rigLine(/** @type {CalibrationView} */ { rig, saved }) {
  const link = (/** @type {SavedRig} */ { id, version }) =>
    html`<a href=${rigUrl(id)}
      >${version ? t("rig-version", { id, version: String(version) }) : id}</a
    >`;
  if (!rig && !saved) return nothing;
  return html`<p class="quiet">
    ${rig ? html`${t("rig-of-recording")} ${link(rig)}. ` : nothing}
    ${saved ? html`${t("rig-saved-as")} ${link(saved)}.` : nothing}
  </p>`;
}

function auditTable(/** @type {CalibrationView} */ { parameters }) {
  const rows = rowsOf(parameters);
  const off = parameters.some((one) => one.status === "off");
  const cells = rows.map(
    ({ sensor, quantity, change, mark, word, className }) =>
      html`<th scope="row">${sensor}</th>
        <td>${quantity}</td>
        <td class="number">${change}</td>
        <td class=${className}>${mark} ${word}</td>`,
  );
  const summary = t("rig-compared", { count: String(rows.length) });
  return folded({ summary, label: t("rig-audit"), open: off }, table(HEADS, cells));
}

function beamTable(/** @type {CalibrationView} */ { beams }) {
  const rows = beamRows(beams);
  const summary = t("rig-corrections", { count: rows.length });
  return folded({ summary, label: t("rig-beams") }, table(BEAM_HEADS, rows.map(numbers)));
}

/** How well points agree before and after; nothing if that was not worked out. */
function agreement(/** @type {CalibrationView} */ { before, after }) {
  if (!before || !after) return nothing;
  const text = (/** @type {number | null} */ value) =>
    value === null ? "–" : `${decimal(1e3 * value, 1)} mm`;
  /** @type {Array<[string, number | null, number | null]>} */
  const rows = [
    [t("rig-distance"), before.rms_m, after.rms_m],
    [t("rig-surface"), before.offset_m, after.offset_m],
  ];
  const known = rows.filter(([, first, last]) => first !== null || last !== null);
  return table(
    ["", t("rig-before"), t("rig-after")],
    known.map(([name, first, last]) => numbers([name, text(first), text(last)])),
    t("rig-windows"),
  );
}

/**
 * A table of rows of cells.
 * @param {string[]} heads
 * @param {Content[]} rows
 */
const table = (heads, rows, caption = "") =>
  html`<table class="audit">
    ${
      caption
        ? html`<caption>
            ${caption}
          </caption>`
        : nothing
    }
    <thead>
      <tr>
        ${heads.map((text) => html`<th scope="col">${text}</th>`)}
      </tr>
    </thead>
    <tbody>
      ${rows.map(
        (cells) =>
          html`<tr>
            ${cells}
          </tr>`,
      )}
    </tbody>
  </table>`;

/** Cells of a row: its name, then numbers. */
const numbers = (/** @type {string[]} */ [name, ...texts]) =>
  html`<th scope="row">${name}</th>
    ${texts.map((text) => html`<td class="number">${text}</td>`)}`;

/**
 * What can be opened, and scrolled by the keyboard.
 * @param {{summary: string, label: string, open?: boolean}} about
 * @param {Content} content
 */
const folded = ({ summary, label, open = false }, content) =>
  html`<details ?open=${open}>
    <summary>${summary}</summary>
    <div class="scroll" tabindex="0" role="region" aria-label=${label}>${content}</div>
  </details>`;
