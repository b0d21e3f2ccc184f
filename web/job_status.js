// <job-status>: state, progress, reason and buttons of one job.

import { cancelJob, retryJob } from "./api.js";
import { attempt, fill, make } from "./dom.js";
import { STATES, progressWords } from "./format.js";

export function badge(state) {
  const { mark, word } = STATES[state];
  return make("span", { className: `badge ${state}` }, make("span", { ariaHidden: "true" }, mark), ` ${word}`);
}

class JobStatus extends HTMLElement {
  #view;
  #line = make("div", { className: "job-line" });
  #bar = make("progress", { max: 1, ariaLabel: "Progress" });
  #words = make("p", { className: "job-words", role: "status" });
  #buttons = make("div", { className: "buttons" });
  #message = make("p", { className: "error", role: "alert" });

  connectedCallback() {
    this.replaceChildren(this.#line, this.#bar, this.#words, this.#buttons, this.#message);
  }

  set view(view) {
    const before = this.#view?.job;
    this.#view = view;
    const { job, status, fraction } = view;
    const running = job.state === "running";
    fill(this.#line, badge(job.state), running && status.what ? make("strong", {}, status.what) : null);
    this.#bar.hidden = !running;
    if (fraction === null) this.#bar.removeAttribute("value");
    else this.#bar.value = fraction;
    this.#words.textContent = running ? progressWords(view) : job.note;
    this.#words.hidden = !this.#words.textContent;
    if (before?.state !== job.state || before?.id !== job.id) this.#offer(job);
  }

  #offer(job) {
    const button = (words, action) =>
      make("button", { type: "button", onclick: () => attempt(this.#message, () => action(job.id)) }, words);
    const open = job.state === "queued" || job.state === "running";
    const again = job.state === "failed" || job.state === "cancelled";
    this.#buttons.replaceChildren(
      ...(open ? [button("Cancel", cancelJob)] : []),
      ...(again ? [button("Resume", retryJob)] : []),
    );
  }
}

customElements.define("job-status", JobStatus);
