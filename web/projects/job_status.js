// <job-status>: state, progress, reason and buttons of one job.

import { cancelJob, readCurrentUser, retryJob } from "../shared/api.js";
import { badge } from "../shared/badge.js";
import { attempt, fill, make, remedyLink } from "../shared/dom.js";
import { runProgressText, progressText } from "../shared/format.js";

export class JobStatus extends HTMLElement {
  #view;
  #line = make("div", { className: "job-line" });
  #bar = make("progress", { max: 1, ariaLabel: "Progress of the whole run" });
  #text = make("p", { className: "job-words", role: "status" });
  #piece = make("p", { className: "job-words" });
  #buttons = make("div", { className: "buttons" });
  #message = make("p", { className: "error", role: "alert" });

  connectedCallback() {
    this.replaceChildren(
      this.#line,
      this.#bar,
      this.#text,
      this.#piece,
      this.#buttons,
      this.#message,
    );
  }

  set view(view) {
    const before = this.#view?.job;
    this.#view = view;
    const { job, status } = view;
    const running = job.state === "running";
    fill(
      this.#line,
      badge(job.state),
      running && status.what ? make("strong", {}, status.what) : null,
    );
    this.#bar.hidden = !running;
    this.#bar.value = view.run_progress;
    this.#text.textContent = running ? runProgressText(view) : job.note;
    this.#text.hidden = !this.#text.textContent;
    this.#piece.hidden = !running || !status.what;
    this.#piece.textContent = this.#piece.hidden ? "" : progressText(view);
    if (before?.state !== job.state || before?.id !== job.id) this.#offer(job);
  }

  async #offer(job) {
    const button = (text, action) =>
      make(
        "button",
        { type: "button", onclick: () => attempt(this.#message, () => action(job.id)) },
        text,
      );
    const open = job.state === "queued" || job.state === "running";
    const tools = /** @type {any} */ (document.querySelector("project-tools")); // on its own page
    const other = () => tools.runAgain();
    const { may } = await readCurrentUser();
    if (this.#view.job.state !== job.state || !may.includes("process")) return;
    this.#buttons.replaceChildren(
      ...(open ? [button("Cancel", cancelJob)] : []),
      ...(this.#view.resumable ? [button("Resume", retryJob)] : []),
      ...(!open && tools
        ? [make("button", { type: "button", onclick: other }, "Other settings…")]
        : []),
      ...(this.#view.remedy ? [remedyLink(this.#view.remedy)] : []),
    );
  }
}

customElements.define("job-status", JobStatus);
