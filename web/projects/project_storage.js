// <project-storage>: what takes the space of a project, and freeing what can be made again.

import { idHere } from "../shared/address.js";
import { freeSpace, readCurrentUser, readProjectStorage } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { bytes } from "../shared/format.js";

/** @import {Freeable, ProjectStorage, StoredPart} from "../shared/http_types" */

const DAY_S = 86_400;
/** @type {Record<Freeable, {label: string, without: string}>} */
const KINDS = {
  earlier: {
    label: "Of earlier runs",
    without: "Going back to their settings or decisions computes them again.",
  },
  frames: {
    label: "Points as recorded",
    without: "New decisions, and the views of pairs and multiframes, need them.",
  },
  map: {
    label: "Tiles of the map",
    without: "The map, slices and exports need them. The LAZ stays.",
  },
};

/** Bytes of the parts that can be freed, by kind; only of kinds that there are. */
export function freeable(/** @type {StoredPart[]} */ parts) {
  /** @type {Map<Freeable, number>} */
  const sizes = new Map();
  for (const { freeable: kind, bytes: size } of parts)
    if (kind) sizes.set(kind, (sizes.get(kind) ?? 0) + size);
  return sizes;
}

export class ProjectStoragePanel extends HTMLElement {
  #id = idHere();
  /** @type {ProjectStorage | null} */
  #found = null;
  #freed = "";

  async connectedCallback() {
    this.hidden = true;
    const { may } = await readCurrentUser();
    this.hidden = !may.includes("process");
    this.#draw();
  }

  /** Reads the sizes again, if they are shown. */
  async reload() {
    const shown = this.querySelector("details")?.open;
    if (!shown) return;
    const found = await attempt(this.#message, () => readProjectStorage(this.#id));
    if (found) this.#show(found);
  }

  get #message() {
    return within(this, ".error");
  }

  #show(/** @type {ProjectStorage} */ found) {
    this.#found = found;
    this.#draw();
  }

  #draw() {
    render(
      html`<details @toggle=${() => this.reload()}>
        <summary>Storage</summary>
        ${this.#found ? this.#parts(this.#found) : nothing}
        <p class="quiet" role="status">${this.#freed}</p>
        ${messagePlace()}
      </details>`,
      this,
    );
  }

  #parts(/** @type {ProjectStorage} */ { parts, keep_earlier_s }) {
    const sizes = freeable(parts);
    const days = Math.round((10 * keep_earlier_s) / DAY_S) / 10;
    return html`<table>
        <thead>
          <tr>
            <th scope="col">What</th>
            <th scope="col" class="number">Size</th>
            <th scope="col">Can be freed</th>
          </tr>
        </thead>
        <tbody>
          ${parts.filter(({ bytes: size }) => size > 0).map(partRow)}
        </tbody>
      </table>
      <p class="quiet">
        ${
          days
            ? `What only earlier runs needed is freed ${days} days after the last run.`
            : "Nothing is freed by itself: see recon4 serve --keep-earlier."
        }
        What an approval needs stays.
      </p>
      ${sizes.size ? this.#form(sizes) : html`<p class="quiet">Nothing can be freed.</p>`}`;
  }

  #form(/** @type {Map<Freeable, number>} */ sizes) {
    const boxes = [...sizes].map(
      ([kind, size]) =>
        html`<label class="check">
          <input type="checkbox" name=${kind} />
          <span>${KINDS[kind].label}, ${bytes(size)}. ${KINDS[kind].without}</span>
        </label>`,
    );
    return html`<form @submit=${(/** @type {SubmitEvent} */ event) => this.#ask(event)}>
      ${boxes}
      <button>Free space…</button>
    </form>`;
  }

  #ask(/** @type {SubmitEvent} */ event) {
    event.preventDefault();
    const form = /** @type {HTMLFormElement} */ (event.currentTarget);
    const chosen = new FormData(form);
    const what = /** @type {Freeable[]} */ (Object.keys(KINDS).filter((kind) => chosen.has(kind)));
    if (!what.length) {
      this.#message.textContent = "Choose what is freed.";
      return;
    }
    const sizes = freeable(this.#found?.parts ?? []);
    const size = what.reduce((sum, kind) => sum + (sizes.get(kind) ?? 0), 0);
    const go = () => {
      dialog.close();
      this.#free(what);
    };
    const dialog = openDialog(
      `Free ${bytes(size)}?`,
      html`<ul>
          ${what.map((kind) => html`<li>${KINDS[kind].label}. ${KINDS[kind].without}</li>`)}
        </ul>
        <p>Running the project again makes it again. That needs the recording.</p>
        <div class="buttons">
          ${closeButton("Keep")}<button type="button" class="danger" @click=${go}>Free</button>
        </div>`,
    );
  }

  async #free(/** @type {Freeable[]} */ what) {
    const before = total(this.#found?.parts ?? []);
    const left = await attempt(this.#message, () => freeSpace(this.#id, what));
    if (!left) return;
    this.#freed = `Freed: ${bytes(before - left.bytes)}.`;
    this.#draw();
    this.dispatchEvent(new CustomEvent("freed"));
  }
}

const total = (/** @type {StoredPart[]} */ parts) =>
  parts.reduce((sum, { bytes: size }) => sum + size, 0);

const partRow = (/** @type {StoredPart} */ { what, bytes: size, freeable: kind, why }) =>
  html`<tr>
    <th scope="row">${what}</th>
    <td class="number">${bytes(size)}</td>
    <td>${kind ? KINDS[kind].label : why || "–"}</td>
  </tr>`;

customElements.define("project-storage", ProjectStoragePanel);
