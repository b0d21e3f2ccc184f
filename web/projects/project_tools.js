// <project-tools>: run a project again, rename it, delete it. <job-log>: the log of a job.

import { at, idHere } from "../shared/address.js";
import {
  deleteProject,
  listJobsOf,
  logUrl,
  readLog,
  readCurrentUser,
  renameProject,
} from "../shared/api.js";
import { attempt, make } from "../shared/dom.js";
import "./new_job.js";

const MAX_LETTERS = 200_000;

export class ProjectTools extends HTMLElement {
  #id = idHere();
  #again = make("details", {}, make("summary", {}, "Run again, with other settings"));
  #name = make("input", { name: "name", maxLength: 100, required: true, autocomplete: "off" });
  #message = make("p", { className: "error", role: "alert" });
  #dialog = make("dialog", { ariaLabel: "Delete the project" });

  async connectedCallback() {
    const { may } = await readCurrentUser();
    this.hidden = !may.includes("process");
    if (this.hidden) return;
    this.#again.addEventListener("toggle", () => this.#again.open && this.#form());
    this.replaceChildren(
      this.#again,
      make(
        "details",
        {},
        make("summary", {}, "Rename or delete"),
        make(
          "form",
          { onsubmit: (event) => this.#rename(event) },
          make("label", {}, make("span", {}, "Name"), this.#name),
          make(
            "div",
            { className: "buttons" },
            make("button", {}, "Rename"),
            make("button", { type: "button", onclick: () => this.#ask() }, "Delete…"),
          ),
        ),
      ),
      this.#message,
      this.#dialog,
    );
  }

  /** The project's name as it is. */
  set name(text) {
    if (document.activeElement !== this.#name) this.#name.value = text;
  }

  /** Opens the form that runs this project with other settings. */
  runAgain() {
    this.#again.open = true;
    this.#again.scrollIntoView({ block: "start" });
    this.#again.querySelector("summary").focus({ preventScroll: true });
  }

  async #form() {
    if (this.#again.querySelector("new-job")) return;
    const views = await attempt(this.#message, () => listJobsOf(this.#id));
    if (!views) return;
    const form = document.createElement("new-job");
    form.again = views[0]?.job ?? { project: this.#id, inputs: { recordings: [], settings: [] } };
    this.#again.append(form);
  }

  async #rename(event) {
    event.preventDefault();
    const project = await attempt(this.#message, () => renameProject(this.#id, this.#name.value));
    if (project) this.dispatchEvent(new CustomEvent("renamed", { detail: project }));
  }

  #ask() {
    const close = () => this.#dialog.close();
    const go = async () => {
      close();
      if (await attempt(this.#message, () => deleteProject(this.#id))) location.assign(at("/"));
    };
    this.#dialog.replaceChildren(
      make("h2", {}, `Delete ${this.#name.value || this.#id}?`),
      make(
        "p",
        {},
        "It can be restored from the list of projects for a week. The recording is not deleted.",
      ),
      make(
        "div",
        { className: "buttons" },
        make("button", { type: "button", autofocus: true, onclick: close }, "Keep"),
        make("button", { type: "button", className: "danger", onclick: go }, "Delete"),
      ),
    );
    this.#dialog.showModal();
  }
}

/** <job-log>: the log of a job as it grows; read only while it is open. */
export class JobLog extends HTMLElement {
  #pre = make("pre", { tabIndex: 0, ariaLabel: "Log" });
  #link = make("a", { download: "" }, "Download the log");
  #details = make("details", {}, make("summary", {}, "Log"), this.#pre, this.#link);
  #job = "";
  #next = 0;
  #busy = false;

  connectedCallback() {
    this.replaceChildren(this.#details);
    this.#details.addEventListener("toggle", () => this.read());
  }

  set job(id) {
    if (id === this.#job) return;
    [this.#job, this.#next] = [id, 0];
    this.#pre.textContent = "";
    this.#link.href = logUrl(id);
    this.hidden = false;
  }

  /** Reads what was appended since. */
  async read() {
    if (!this.#job || !this.#details.open || this.#busy) return;
    this.#busy = true;
    try {
      for (let piece; piece === undefined || piece.text;) {
        piece = await readLog(this.#job, this.#next);
        this.#next = piece.next;
        const atEnd = this.#pre.scrollHeight - this.#pre.scrollTop - this.#pre.clientHeight < 40;
        if (piece.text)
          this.#pre.textContent = (this.#pre.textContent + piece.text).slice(-MAX_LETTERS);
        if (atEnd) this.#pre.scrollTop = this.#pre.scrollHeight;
      }
    } finally {
      this.#busy = false;
    }
  }
}

customElements.define("project-tools", ProjectTools);
customElements.define("job-log", JobLog);
