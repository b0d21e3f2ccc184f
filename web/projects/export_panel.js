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
import { bytes, shareText } from "../shared/format.js";
import { t, wordOf } from "../shared/texts.js";
import { clipLines, clipOfAddress, clipWords, comesFromMap, forgetClip } from "./export_clip.js";
import {
  DELIVERY,
  deliveryFields,
  deliveryOf,
  takeField,
  usualDelivery,
} from "./delivery_fields.js";
import { exportList } from "./export_list.js";
import { clipBoxOf, orderOf, usual } from "./export_options.js";

/**
 * @import {ExportChoices, ExportKind, ExportView, JobView, Me} from "../shared/http_types"
 * @import {Chosen} from "./export_options.js"
 */

const ESTIMATE_AFTER_MS = 500;
const CORNERS = [t("box-from-x"), "y", "z", t("box-to-x"), "y", "z"];

export class ExportPanel extends HTMLElement {
  #chosen = { ...usual(), clip: clipOfAddress() };
  #packed = usualDelivery();
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
      if (comesFromMap()) within(this, "form").scrollIntoView();
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
            : html`<p class="quiet">${t("export-looking")}</p>`
        }
        ${messagePlace()}
        <h3>${t("export-list")}</h3>
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
      html`<option value=${name} ?selected=${name === kind.name}>
        ${wordOf("export", title)}: ${wordOf("program", programs)}
      </option>`;
    return html`<form @input=${this.#change} @submit=${this.#submit}>
      <label>
        <span>${t("file")}</span>
        <select name="file">
          ${groups.map(
            (group) =>
              html`<optgroup label=${wordOf("export", group)}>
                ${choices.kinds.filter((one) => one.group === group).map(option)}
              </optgroup>`,
          )}
        </select>
      </label>
      ${this.#clip(takes("clip"))}
      ${kind.name === DELIVERY ? deliveryFields(this.#packed, choices, this.#rows) : nothing}
      ${takes("classes") ? this.#points(choices, takes("all_points")) : nothing}
      ${takes("storey") && choices.storeys.length ? this.#storey(choices, kind) : nothing}
      ${takes("thin_m") ? this.#number("thin", t("thin-out"), t("thin-all")) : nothing}
      ${takes("pixel_m") ? this.#number("pixel", t("pixel-mm"), "") : nothing}
      ${takes("cell_m") ? this.#number("cell", t("cell-m"), "") : nothing}
      ${this.#more(choices, takes)}
      <p class="estimate" role="status">${this.#estimate}</p>
      <button class="primary">${t("make-file")}</button>
    </form>`;
  }

  #clip(/** @type {boolean} */ taken) {
    const words = this.#chosen.clip.map((text) => {
      try {
        return clipWords([clipBoxOf(text)])[0];
      } catch {
        return text; // the estimate says what is wrong
      }
    });
    return clipLines(words, taken, () => {
      this.#chosen.clip = [];
      forgetClip();
      this.#renew();
    });
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
        <span>${t("points")}</span>
        <select name="points">
          ${option("map", t("points-map"))} ${mayAll ? option("all", t("points-all")) : nothing}
          ${option("some", t("points-some"))}
        </select>
      </label>
      ${
        points !== "some"
          ? nothing
          : html`<fieldset class="classes">
              <legend>${t("classes")}</legend>
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
                      <span>${wordOf("class", title)}, ${shareText(percent)}</span>
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
    const all = kind.takes.includes("pixel_m") ? "0" : t("storeys-all");
    return html`<label>
      <span>${t("storey")}</span>
      <select name="storey">
        <option value="">${all}</option>
        ${storeys.map(
          ({ name, floor_m }) =>
            html`<option value=${name} ?selected=${name === this.#chosen.storey}>
              ${t("storey-at", { name, m: floor_m })}
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
      <summary>${t("export-more")}</summary>
      ${
        takes("crs")
          ? html`<label>
              <span>${t("crs")}</span>
              <input
                name="crs"
                placeholder=${crs ? t("crs-of-map", { crs }) : t("crs-local")}
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
              <legend>${t("box-only")}</legend>
              ${CORNERS.map(
                (label, k) =>
                  html`<label>
                    <span>${label}</span>
                    <input
                      name="box"
                      data-corner=${k}
                      aria-label=${t(k < 3 ? "box-from" : "box-to", { axis: "xyz"[k % 3] ?? "" })}
                      inputmode="decimal"
                      autocomplete="off"
                      .value=${this.#chosen.box[k]}
                    />
                  </label>`,
              )}
            </fieldset>`
          : nothing
      }
      ${takes("raw") ? check("raw", t("export-raw")) : nothing}
      ${takes("draft") ? check("draft", t("export-draft")) : nothing}
    </details>`;
  }

  #change = (/** @type {Event} */ event) => {
    const field = targetOf(event);
    const { name, value, checked } = field;
    if (takeField(this.#packed, field)) return this.#renew();
    if (name === "class") {
      const others = this.#chosen.classes.filter((code) => code !== Number(value));
      this.#chosen.classes = checked ? [...others, Number(value)] : others;
    } else if (name === "box") {
      this.#chosen.box[Number(field.dataset.corner)] = value;
    } else Object.assign(this.#chosen, { [name]: field.type === "checkbox" ? checked : value });
    if (name === "file" && !this.#kind?.takes.includes("all_points")) this.#leaveAll();
    this.#renew();
  };

  #renew() {
    this.#estimate = "";
    this.#draw();
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(this.#askEstimate, ESTIMATE_AFTER_MS);
  }

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
      const found = await estimateExport(idHere(), this.#order(kind));
      if (asked === this.#asked) say(this.#message(), "");
      const points = found.points ? [t("estimate-points", { points: found.points })] : [];
      const most = found.is_most ? "estimate-most" : "estimate-size";
      const size = found.bytes ? [t(most, { size: bytes(found.bytes) })] : [];
      const none = kind.point_bytes && !found.points;
      estimate = none ? t("estimate-none") : [...points, ...size].join(", ");
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
    if (kind) this.#act(() => orderExport(idHere(), this.#order(kind)));
  };

  /** What the server is asked for; throws an error with words if a field cannot be read. */
  #order(/** @type {ExportKind} */ kind) {
    const order = orderOf(this.#chosen, kind);
    if (kind.name !== DELIVERY) return order;
    return { ...order, delivery: deliveryOf(this.#packed, this.#rows) };
  }

  async #act(/** @type {() => Promise<unknown>} */ action) {
    const done = await attempt(this.#message(), async () => {
      await action();
      return true;
    });
    if (done) await this.#reload();
  }
}

customElements.define("export-panel", ExportPanel);
