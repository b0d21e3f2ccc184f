// <export-panel>: files of the map for other programs, and the list of what was exported.

import { idHere } from "../shared/address.js";
import {
  cancelExport,
  estimateExport,
  listExports,
  orderExport,
  readCurrentUser,
  readExportChoices,
  removeExport,
} from "../shared/api.js";
import {
  attempt,
  html,
  messagePlace,
  nothing,
  render,
  say,
  showError,
  targetOf,
  within,
} from "../shared/dom.js";
import { bytes, count, shareText } from "../shared/format.js";
import { exportList } from "./export_list.js";
import { orderOf, usual } from "./export_options.js";

/**
 * @import {ExportChoices, ExportKind, ExportView, JobView, Me} from "../shared/http_types"
 * @import {Chosen} from "./export_options.js"
 */

const ESTIMATE_AFTER_MS = 500;
const CORNERS = ["from x", "y", "z", "to x", "y", "z"];
const THIN_OUT = "Thin out: one point each … mm";

export class ExportPanel extends HTMLElement {
  #chosen = usual();
  /** @type {ExportChoices | null} */
  #choices = null;
  /** @type {ExportView[]} */
  #rows = [];
  /** @type {Me | null} */
  #me = null;
  #estimate = "";
  #asked = 0; // number of the newest estimate: an earlier one may come later
  #timer = 0;

  /** Shows the panel for the map that the project has now. */
  async show() {
    if (!this.firstChild) this.#draw();
    await attempt(this.#message(), async () => {
      [this.#me, this.#rows] = await Promise.all([readCurrentUser(), listExports(idHere())]);
      this.#draw();
      this.#choices = await readExportChoices(idHere());
      this.#draw();
      await this.#askEstimate();
    });
  }

  /** An export that changed. */
  async receive(/** @type {JobView} */ { job, status, fraction }) {
    if (job.project !== idHere()) return;
    const row = this.#rows.find((one) => one.id === job.id);
    if (row?.state === job.state) {
      Object.assign(row, { fraction, what: status.what });
      this.#draw();
    } else await this.#reload();
  }

  /** Reads the list again after the stream of changes was cut. */
  refresh() {
    if (this.#me) this.#reload();
  }

  #message = () => within(this, ".error");

  #reload = async () => {
    await attempt(this.#message(), async () => {
      this.#rows = await listExports(idHere());
    });
    this.#draw();
  };

  get #kind() {
    return this.#choices?.kinds.find((one) => one.name === this.#chosen.file);
  }

  #draw() {
    const mine = (/** @type {ExportView} */ row) =>
      Boolean(this.#me?.may.includes("process")) || this.#me?.name === row.person;
    const known = { classes: this.#choices?.classes ?? [], mine };
    render(
      html`${
          this.#choices && this.#kind
            ? this.#form(this.#choices, this.#kind)
            : html`<p class="quiet">Looking at the map…</p>`
        }
        ${messagePlace()}
        <h3>What was exported</h3>
        ${exportList(idHere(), this.#rows, known, {
          cancel: (row) => this.#act(() => cancelExport(idHere(), row.id)),
          remove: (row) => this.#act(() => removeExport(idHere(), row.id)),
        })}`,
      this,
    );
  }

  /**
   * @param {ExportChoices} choices
   * @param {ExportKind} kind
   */
  #form(choices, kind) {
    const takes = (/** @type {string} */ name) => kind.takes.includes(name);
    const groups = [...new Set(choices.kinds.map((one) => one.group))];
    const option = (/** @type {ExportKind} */ { name, title, programs }) =>
      html`<option value=${name} ?selected=${name === kind.name}>${title}: ${programs}</option>`;
    return html`<form @input=${this.#change} @submit=${this.#submit}>
      <label>
        <span>File</span>
        <select name="file">
          ${groups.map(
            (group) =>
              html`<optgroup label=${group}>
                ${choices.kinds.filter((one) => one.group === group).map(option)}
              </optgroup>`,
          )}
        </select>
      </label>
      ${takes("classes") ? this.#points(choices, takes("all_points")) : nothing}
      ${takes("storey") && choices.storeys.length ? this.#storey(choices, kind) : nothing}
      ${takes("thin_m") ? this.#number("thin", THIN_OUT, "all points") : nothing}
      ${takes("pixel_m") ? this.#number("pixel", "Pixel, mm", "") : nothing}
      ${takes("cell_m") ? this.#number("cell", "Cell, m", "") : nothing}
      ${this.#more(choices, takes)}
      <p class="estimate" role="status">${this.#estimate}</p>
      <button class="primary">Make file</button>
    </form>`;
  }

  /**
   * @param {ExportChoices} choices
   * @param {boolean} mayAll
   */
  #points({ classes }, mayAll) {
    const { points, classes: chosen } = this.#chosen;
    const option = (/** @type {Chosen["points"]} */ value, /** @type {string} */ label) =>
      html`<option value=${value} ?selected=${value === points}>${label}</option>`;
    return html`<label>
        <span>Points</span>
        <select name="points">
          ${option("map", "those of the map")}
          ${mayAll ? option("all", "all: also noise, the carrier, what moves") : nothing}
          ${option("some", "some classes…")}
        </select>
      </label>
      ${
        points !== "some"
          ? nothing
          : html`<fieldset class="classes">
              <legend>Classes</legend>
              ${classes
                .filter((one) => mayAll || one.delivered)
                .map(
                  ({ code, title, percent }) =>
                    html`<label class="check">
                      <input
                        type="checkbox"
                        name="class"
                        value=${code}
                        .checked=${chosen.includes(code)}
                      />
                      <span>${title}, ${shareText(percent)}</span>
                    </label>`,
                )}
            </fieldset>`
      }`;
  }

  /**
   * @param {ExportChoices} choices
   * @param {ExportKind} kind
   */
  #storey({ storeys }, kind) {
    const all = kind.takes.includes("pixel_m") ? "0" : "all";
    return html`<label>
      <span>Storey</span>
      <select name="storey">
        <option value="">${all}</option>
        ${storeys.map(
          ({ name, floor_m }) =>
            html`<option value=${name} ?selected=${name === this.#chosen.storey}>
              ${name}: floor at ${floor_m.toFixed(2)} m
            </option>`,
        )}
      </select>
    </label>`;
  }

  /**
   * @param {"thin" | "pixel" | "cell"} name
   * @param {string} label
   * @param {string} placeholder
   */
  #number(name, label, placeholder) {
    return html`<label>
      <span>${label}</span>
      <input
        name=${name}
        inputmode="decimal"
        autocomplete="off"
        placeholder=${placeholder}
        .value=${this.#chosen[name]}
      />
    </label>`;
  }

  /**
   * @param {ExportChoices} choices
   * @param {(name: string) => boolean} takes
   */
  #more({ crs }, takes) {
    const check = (/** @type {"raw" | "draft"} */ name, /** @type {string} */ label) =>
      html`<label class="check">
        <input type="checkbox" name=${name} .checked=${this.#chosen[name]} />
        <span>${label}</span>
      </label>`;
    if (!["crs", "box_m", "raw", "draft"].some(takes)) return nothing;
    return html`<details>
      <summary>Coordinates, box and more</summary>
      ${
        takes("crs")
          ? html`<label>
              <span>CRS</span>
              <input
                name="crs"
                placeholder=${crs ? `${crs}, that of the map` : "local frame of the map"}
                autocomplete="off"
                maxlength="100"
                .value=${this.#chosen.crs}
              />
            </label>`
          : nothing
      }
      ${
        takes("box_m")
          ? html`<fieldset class="box">
              <legend>Only a box, in the coordinates of the file, m</legend>
              ${CORNERS.map(
                (label, k) =>
                  html`<label>
                    <span>${label}</span>
                    <input
                      name="box"
                      data-corner=${k}
                      aria-label=${`Box ${k < 3 ? "from" : "to"} ${"xyz"[k % 3]}`}
                      inputmode="decimal"
                      autocomplete="off"
                      .value=${this.#chosen.box[k]}
                    />
                  </label>`,
              )}
            </fieldset>`
          : nothing
      }
      ${takes("raw") ? check("raw", "Points as measured, not on fitted surfaces") : nothing}
      ${takes("draft") ? check("draft", "As a draft, without the approval") : nothing}
    </details>`;
  }

  #change = (/** @type {Event} */ event) => {
    const field = targetOf(event);
    const { name, value, checked } = field;
    if (name === "class") {
      const others = this.#chosen.classes.filter((code) => code !== Number(value));
      this.#chosen.classes = checked ? [...others, Number(value)] : others;
    } else if (name === "box") {
      this.#chosen.box[Number(field.dataset.corner)] = value;
    } else Object.assign(this.#chosen, { [name]: field.type === "checkbox" ? checked : value });
    if (name === "file" && !this.#kind?.takes.includes("all_points")) this.#leaveAll();
    this.#estimate = "";
    this.#draw();
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(this.#askEstimate, ESTIMATE_AFTER_MS);
  };

  /** A format without classes holds no points that the map leaves out. */
  #leaveAll() {
    if (this.#chosen.points === "all") this.#chosen.points = "map";
    const delivered = this.#choices?.classes.filter((one) => one.delivered) ?? [];
    const codes = delivered.map((one) => one.code);
    this.#chosen.classes = this.#chosen.classes.filter((code) => codes.includes(code));
  }

  #askEstimate = async () => {
    const kind = this.#kind;
    if (!kind) return;
    const asked = ++this.#asked;
    let estimate = "";
    try {
      const found = await estimateExport(idHere(), orderOf(this.#chosen, kind));
      if (asked === this.#asked) say(this.#message(), "");
      const points = found.points ? [`about ${count(found.points)} points`] : [];
      const size = found.bytes
        ? [`${found.is_most ? "at most" : "about"} ${bytes(found.bytes)}`]
        : [];
      const none = kind.point_bytes && !found.points;
      estimate = none ? "no point of the map is chosen" : [...points, ...size].join(", ");
    } catch (error) {
      if (asked === this.#asked) showError(this.#message(), error);
    }
    if (asked !== this.#asked) return;
    this.#estimate = estimate && `${estimate[0].toUpperCase()}${estimate.slice(1)}`;
    this.#draw();
  };

  #submit = (/** @type {Event} */ event) => {
    event.preventDefault();
    const kind = this.#kind;
    if (kind) this.#act(() => orderExport(idHere(), orderOf(this.#chosen, kind)));
  };

  async #act(/** @type {() => Promise<unknown>} */ action) {
    const done = await attempt(this.#message(), async () => {
      await action();
      return true;
    });
    if (done) await this.#reload();
  }
}

customElements.define("export-panel", ExportPanel);
