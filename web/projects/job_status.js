// <job-status>: state, progress, reason and buttons of one job.

import { cancelJob, readCurrentUser, retryJob } from "../shared/api.js";
import { badge } from "../shared/badge.js";
import { attempt, html, messagePlace, nothing, remedyLink, render, within } from "../shared/dom.js";
import { runProgressText, progressText } from "../shared/format.js";
import { t } from "../shared/texts.js";
import { stepText } from "./steps.js";

/** @import {JobView} from "../shared/http_types" */

export class JobStatus extends HTMLElement {
  /** @type {{view: JobView | null, mayProcess: boolean}} */
  #state = { view: null, mayProcess: false };

  connectedCallback() {
    readCurrentUser().then(
      ({ may }) => {
        this.#state.mayProcess = may.includes("process");
        this.#draw();
      },
      () => {}, // the head of the page says why
    );
  }

  set view(/** @type {JobView} */ view) {
    this.#state.view = view;
    this.#draw();
  }

  #draw() {
    const { view } = this.#state;
    if (!view) return;
    const { job, status } = view;
    const running = job.state === "running";
    const waits = job.state === "queued" ? t("job-waits") : job.note;
    const text = running ? runProgressText(view) : waits;
    const what = running ? status.what : "";
    const counted = status.total > 0 || status.done > 0;
    const part = what && counted ? progressText(view) : "";
    render(
      html`<div class="job-line">
          ${badge(job.state)}${what ? html`<strong>${stepText(what)}</strong>` : nothing}
        </div>
        <progress
          max="1"
          aria-label=${t("progress-whole")}
          .value=${view.run_progress}
          ?hidden=${!running}
        ></progress>
        <p class="job-words" role="status" ?hidden=${!text}>${text}</p>
        <p class="job-words" ?hidden=${!part}>${part}</p>
        <div class="buttons">${this.#buttons(view)}</div>
        ${messagePlace()}`,
      this,
    );
  }

  #buttons(/** @type {JobView} */ { job, resumable, remedy }) {
    if (!this.#state.mayProcess) return nothing;
    const button = (/** @type {string} */ text, /** @type {() => unknown} */ action) =>
      html`<button type="button" @click=${() => attempt(within(this, ".error"), action)}>
        ${text}
      </button>`;
    const open = job.state === "queued" || job.state === "running";
    const tools = document.querySelector("project-tools"); // on its own page
    return [
      open ? button(t("cancel"), () => cancelJob(job.id)) : nothing,
      resumable ? button(t("resume-job"), () => retryJob(job.id)) : nothing,
      !open && tools ? button(t("other-settings"), () => tools.runAgain()) : nothing,
      remedy ? remedyLink(remedy) : nothing,
    ];
  }
}

customElements.define("job-status", JobStatus);
