// <folder-browser>: folders of the server with recordings. Event "pick" has a path.

import { browse } from "../shared/api.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import { bytes } from "../shared/format.js";
import { t } from "../shared/texts.js";

/** @import {FolderEntry} from "../shared/http_types" */

export class FolderBrowser extends HTMLElement {
  connectedCallback() {
    this.hidden = true;
    render(
      html`<div class="folder"></div>
        ${messagePlace()}`,
      this,
    );
  }

  async toggle() {
    this.hidden = !this.hidden;
    if (!this.hidden) await this.#open("");
  }

  #pick(/** @type {string} */ path) {
    this.hidden = true;
    this.dispatchEvent(new CustomEvent("pick", { detail: path }));
  }

  async #open(/** @type {string} */ path) {
    const list = within(this, ".folder");
    list.inert = true; // no choice in a folder that is being left
    const entries = await attempt(within(this, ".error"), () => browse(path));
    list.inert = false;
    if (!entries) return;
    const up = path.split("/").slice(0, -1).join("/");
    render(
      html`<p class="path">${path || t("folders")}</p>
        ${path ? row(`↩ ${t("folders-all")}`, () => this.#open("")) : nothing}
        ${path ? row(t("folder-use"), () => this.#pick(path)) : nothing}
        ${up ? row(`↑ ${t("folder-up")}`, () => this.#open(up)) : nothing}
        ${entries.map((entry) => this.#entry(entry))}`,
      list,
    );
  }

  #entry(/** @type {FolderEntry} */ { name, path, folder, bytes: size }) {
    if (folder) return row(`${name}/`, () => this.#open(path));
    return row(name, () => this.#pick(path), bytes(size));
  }
}

/**
 * @param {string} text
 * @param {() => unknown} act
 */
const row = (text, act, note = "") =>
  html`<button type="button" @click=${act}><span>${text}</span><small>${note}</small></button>`;

customElements.define("folder-browser", FolderBrowser);
