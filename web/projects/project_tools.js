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
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, html, messagePlace, nothing, render, within } from "../shared/dom.js";
import "./new_job.js";
import { t } from "../shared/texts.js";

/** @import {RepeatedJob} from "./new_job.js" */

const MAX_LETTERS = 200_000;

export class ProjectTools extends HTMLElement {
  #id = idHere();
  #state = {
    name: "",
    mayProcess: false,
    /** @type {RepeatedJob | null} */
    again: null, // the job that the form repeats, once it was opened
  };

  async connectedCallback() {
    this.hidden = true;
    const { may } = await readCurrentUser();
    this.#state.mayProcess = may.includes("process");
    this.#draw();
  }

  /** The project's name as it is; what is being typed stays. */
  set name(/** @type {string} */ name) {
    this.#state.name = name;
    this.#draw();
  }

  #draw() {
    const { name, mayProcess, again } = this.#state;
    this.hidden = !mayProcess;
    if (!mayProcess) return;
    render(
      html`<details class="again" @toggle=${() => this.#form()}>
          <summary>${t("run-again")}</summary>
          ${again ? html`<new-job .again=${again}></new-job>` : nothing}
        </details>
        <details>
          <summary>${t("rename-or-delete")}</summary>
          <form @submit=${(/** @type {SubmitEvent} */ event) => this.#rename(event)}>
            <label
              ><span>${t("name")}</span
              ><input name="name" maxlength="100" required autocomplete="off" .value=${name}
            /></label>
            <div class="buttons">
              <button>${t("rename")}</button
              ><button type="button" @click=${() => this.#askToDelete()}>
                ${t("delete-open")}
              </button>
            </div>
          </form>
        </details>
        ${messagePlace()}`,
      this,
    );
  }

  get #message() {
    return within(this, ":scope > .error");
  }

  get #name() {
    return within(this, "input[name=name]", HTMLInputElement);
  }

  /** Opens the form that runs this project with other settings. */
  runAgain() {
    const again = within(this, ".again", HTMLDetailsElement);
    again.open = true;
    again.scrollIntoView({ block: "start" });
    within(again, "summary").focus({ preventScroll: true });
  }

  async #form() {
    if (this.#state.again) return;
    const views = await attempt(this.#message, () => listJobsOf(this.#id));
    if (!views) return;
    const none = { project: this.#id, inputs: { recordings: [], settings: [] } };
    this.#state.again = views[0]?.job ?? none;
    this.#draw();
  }

  async #rename(/** @type {SubmitEvent} */ event) {
    event.preventDefault();
    const project = await attempt(this.#message, () => renameProject(this.#id, this.#name.value));
    if (project) this.dispatchEvent(new CustomEvent("renamed", { detail: project }));
  }

  #askToDelete() {
    const go = async () => {
      dialog.close();
      if (await attempt(this.#message, () => deleteProject(this.#id))) location.assign(at("/"));
    };
    const dialog = openDialog(
      t("delete-ask", { name: this.#name.value || this.#id }),
      html`<p>${t("delete-restorable")}</p>
        <div class="buttons">
          ${closeButton(t("keep"))}<button type="button" class="danger" @click=${go}>
            ${t("delete")}
          </button>
        </div>`,
    );
  }
}

/** <job-log>: the log of a job as it grows; read only while it is open. */
export class JobLog extends HTMLElement {
  #state = { job: "", text: "", next: 0, busy: false };

  set job(/** @type {string} */ job) {
    if (job === this.#state.job) return;
    Object.assign(this.#state, { job, text: "", next: 0 });
    this.hidden = false;
    this.#draw();
  }

  #draw() {
    const { job, text } = this.#state;
    render(
      html`<details @toggle=${() => this.read()}>
        <summary>${t("log")}</summary>
        <pre tabindex="0" aria-label=${t("log")}>${text}</pre>
        <a download href=${logUrl(job)}>${t("log-download")}</a>
      </details>`,
      this,
    );
  }

  /** Reads what was appended since. */
  async read() {
    const state = this.#state;
    if (!state.job || state.busy || !within(this, "details", HTMLDetailsElement).open) return;
    state.busy = true;
    try {
      for (let more = true; more;) more = this.#append(await readLog(state.job, state.next));
    } finally {
      state.busy = false;
    }
  }

  /** Shows a piece of the log, and its end if that was in view; whether there may be more. */
  #append(/** @type {{text: string, next: number}} */ { text, next }) {
    const pre = within(this, "pre");
    const atEnd = pre.scrollHeight - pre.scrollTop - pre.clientHeight < 40;
    this.#state.text = (this.#state.text + text).slice(-MAX_LETTERS);
    this.#state.next = next;
    this.#draw();
    if (atEnd) pre.scrollTop = pre.scrollHeight;
    return text !== "";
  }
}

customElements.define("project-tools", ProjectTools);
customElements.define("job-log", JobLog);
