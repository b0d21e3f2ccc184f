// <project-storage>: what takes the space of a project, and freeing what can be made again.

import { idHere } from "../shared/address.js";
import { freeSpace, readCurrentUser, readProjectStorage } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { bytes } from "../shared/format.js";
import { asWritten, t } from "../shared/texts.js";
import { stageText } from "./steps.js";

/** @import {Freeable, ProjectStorage, StoredPart} from "../shared/http_types" */

const DAY_S = 86_400;
/** @type {Record<Freeable, {label: string, without: string}>} */
const KINDS = {
  earlier: {
    label: t("stored-earlier"),
    without: t("stored-earlier-without"),
  },
  frames: {
    label: t("stored-frames"),
    without: t("stored-frames-without"),
  },
  map: {
    label: t("stored-map"),
    without: t("stored-map-without"),
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
        <summary>${t("head-storage")}</summary>
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
            <th scope="col">${t("stored-what")}</th>
            <th scope="col" class="number">${t("size")}</th>
            <th scope="col">${t("stored-free")}</th>
          </tr>
        </thead>
        <tbody>
          ${parts.filter(({ bytes: size }) => size > 0).map(partRow)}
        </tbody>
      </table>
      <p class="quiet">
        ${days ? t("stored-days", { days: asWritten(days) }) : t("stored-stays")}
        ${t("stored-approved")}
      </p>
      ${sizes.size ? this.#form(sizes) : html`<p class="quiet">${t("stored-nothing")}</p>`}`;
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
      <button>${t("free-it")}</button>
    </form>`;
  }

  #ask(/** @type {SubmitEvent} */ event) {
    event.preventDefault();
    const form = /** @type {HTMLFormElement} */ (event.currentTarget);
    const chosen = new FormData(form);
    const what = /** @type {Freeable[]} */ (Object.keys(KINDS).filter((kind) => chosen.has(kind)));
    if (!what.length) {
      this.#message.textContent = t("free-choose");
      return;
    }
    const sizes = freeable(this.#found?.parts ?? []);
    const size = what.reduce((sum, kind) => sum + (sizes.get(kind) ?? 0), 0);
    const go = () => {
      dialog.close();
      this.#free(what);
    };
    const dialog = openDialog(
      t("free-ask", { size: bytes(size) }),
      html`<ul>
          ${what.map((kind) => html`<li>${KINDS[kind].label}. ${KINDS[kind].without}</li>`)}
        </ul>
        <p>${t("free-again")}</p>
        <div class="buttons">
          ${closeButton(t("keep"))}<button type="button" class="danger" @click=${go}>
            ${t("free")}
          </button>
        </div>`,
    );
  }

  async #free(/** @type {Freeable[]} */ what) {
    const before = total(this.#found?.parts ?? []);
    const left = await attempt(this.#message, () => freeSpace(this.#id, what));
    if (!left) return;
    this.#freed = t("freed", { size: bytes(before - left.bytes) });
    this.#draw();
    this.dispatchEvent(new CustomEvent("freed"));
  }
}

const total = (/** @type {StoredPart[]} */ parts) =>
  parts.reduce((sum, { bytes: size }) => sum + size, 0);

/**
 * Why a part stays.
 * @param {StoredPart["kept"]} kept
 * @param {StoredPart["version"]} version
 */
const keptText = (kept, version) =>
  kept ? t(`storing-${kept}`, { version: String(version ?? "") }) : "–";

const partRow = (/** @type {StoredPart} */ { what, bytes: size, freeable: kind, kept, version }) =>
  html`<tr>
    <th scope="row">${stageText(what)}</th>
    <td class="number">${bytes(size)}</td>
    <td>${kind ? KINDS[kind].label : keptText(kept, version)}</td>
  </tr>`;

customElements.define("project-storage", ProjectStoragePanel);
