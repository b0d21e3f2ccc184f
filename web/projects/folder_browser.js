// <folder-browser>: folders of the server with recordings. Event "pick" has a path.

import { browse } from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import { bytes } from "../shared/format.js";

export class FolderBrowser extends HTMLElement {
  #list = make("div", { className: "folder" });
  #message = make("p", { className: "error", role: "alert" });

  connectedCallback() {
    this.hidden = true;
    this.replaceChildren(this.#list, this.#message);
  }

  async toggle() {
    this.hidden = !this.hidden;
    if (!this.hidden) await this.#open("");
  }

  #pick(path) {
    this.hidden = true;
    this.dispatchEvent(new CustomEvent("pick", { detail: path }));
  }

  async #open(path) {
    this.#list.inert = true; // no choice in a folder that is being left
    const entries = await attempt(this.#message, () => browse(path));
    this.#list.inert = false;
    if (!entries) return;
    const up = path.split("/").slice(0, -1).join("/");
    const row = (text, note, onclick) =>
      make("button", { type: "button", onclick }, make("span", {}, text), make("small", {}, note));
    this.#list.replaceChildren(
      make("p", { className: "path" }, path || "Folders of this server"),
      ...(path
        ? [
            row("↩ All folders", "", () => this.#open("")),
            row("Use this folder", "", () => this.#pick(path)),
          ]
        : []),
      ...(up && path ? [row("↑ Up", "", () => this.#open(up))] : []),
      ...entries.map((entry) =>
        entry.folder
          ? row(`${entry.name}/`, "", () => this.#open(entry.path))
          : row(entry.name, bytes(entry.bytes), () => this.#pick(entry.path)),
      ),
    );
  }
}

customElements.define("folder-browser", FolderBrowser);
