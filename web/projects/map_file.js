// <map-file>: the map as a file for another program.

import { idHere } from "../shared/address.js";
import { mapFileUrl } from "../shared/api.js";
import { html, messagePlace, render, targetOf, within } from "../shared/dom.js";
import { askFirst } from "../shared/download.js";

/** @type {Record<string, string>} */
const FORMATS = {
  "copc.laz": "COPC: QGIS, web viewers",
  laz: "LAZ: CloudCompare, PDAL",
  e57: "E57: scans with poses",
  ply: "PLY: all fields, normals",
  pcd: "PCD: PCL, ROS",
  xyz: "XYZ: lines of text",
};
const WITHOUT_CLASSES = ["e57"];

export class MapFile extends HTMLElement {
  #wanted = { ending: "copc.laz", crs: "", raw: false, all_points: false };

  connectedCallback() {
    this.#draw();
  }

  #draw() {
    const { ending, crs, raw, all_points } = this.#wanted;
    const hasClasses = !WITHOUT_CLASSES.includes(ending);
    const href = mapFileUrl(idHere(), ending, { crs, raw, all_points: all_points && hasClasses });
    const option = (/** @type {[string, string]} */ [value, label]) =>
      html`<option value=${value} ?selected=${value === ending}>${label}</option>`;
    const box = (/** @type {"raw" | "all_points"} */ name, /** @type {string} */ label) =>
      html`<label class="check">
        <input
          type="checkbox"
          name=${name}
          .checked=${this.#wanted[name]}
          ?disabled=${name === "all_points" && !hasClasses}
        />
        <span>${label}</span>
      </label>`;
    render(
      html`<details>
        <summary>Map for another program</summary>
        <form @input=${this.#change} @submit=${(/** @type {Event} */ one) => one.preventDefault()}>
          <label>
            Format
            <select name="ending">
              ${Object.entries(FORMATS).map(option)}
            </select>
          </label>
          <label>
            CRS
            <input name="crs" placeholder="that of the map" autocomplete="off" maxlength="100" />
          </label>
          ${box("raw", "Points as measured, not on fitted surfaces")}
          ${box("all_points", "Also noise, the carrier and what moves, by class")}
          <a class="button" href=${href} download @click=${askFirst(this.#places)}>Download</a>
        </form>
        <p class="quiet" role="status"></p>
        ${messagePlace()}
      </details>`,
      this,
    );
  }

  #places = () => ({ message: within(this, ".error"), status: within(this, ".quiet") });

  #change = (/** @type {Event} */ event) => {
    const field = /** @type {HTMLInputElement} */ (targetOf(event));
    const value = field.type === "checkbox" ? field.checked : field.value.trim();
    Object.assign(this.#wanted, { [field.name]: value });
    this.#draw();
  };
}

customElements.define("map-file", MapFile);
