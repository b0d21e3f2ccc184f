// <upload-box>: drop or choose a file or folder, send it, show progress.
// Event "recording" has the path on the server once everything is there.

import { listUploads, removeUpload } from "../shared/api.js";
import { attempt, fill, make, showError, succeeds } from "../shared/dom.js";
import { bytes, count, seconds, when } from "../shared/format.js";
import { ofDrop, ofInput } from "../slices/picking.js";
import { Sending, sorted } from "./resumable_upload.js";

const STATES = {
  waiting: "Begins",
  sending: "Sending",
  trying: "Interrupted",
  paused: "Paused",
  failed: "Stopped",
  done: "On the server",
};

export class UploadBox extends HTMLElement {
  #sending = null;
  #file = make("input", {
    type: "file",
    hidden: true,
    onchange: () => this.#take(ofInput(this.#file)),
  });
  #folder = make("input", {
    type: "file",
    hidden: true,
    webkitdirectory: true,
    onchange: () => this.#take(ofInput(this.#folder)),
  });
  #zone = make(
    "div",
    { className: "drop" },
    make("p", {}, "Drop a file or folder here"),
    make(
      "div",
      { className: "buttons" },
      make("button", { type: "button", onclick: () => this.#pick(this.#file) }, "File…"),
      make("button", { type: "button", onclick: () => this.#pick(this.#folder) }, "Folder…"),
    ),
  );
  #bar = make("progress", { max: 1, ariaLabel: "Upload" });
  #title = make("p", { className: "upload-title" });
  #text = make("p", { className: "job-words", role: "status" });
  #buttons = make("div", { className: "buttons" });
  #now = make(
    "div",
    { className: "upload-now", hidden: true },
    this.#title,
    this.#bar,
    this.#text,
    this.#buttons,
  );
  #open = make("ul", { className: "uploads", ariaLabel: "Unfinished uploads" });
  #message = make("p", { className: "error", role: "alert" });
  #leaving = (event) => event.preventDefault();

  connectedCallback() {
    this.replaceChildren(
      this.#zone,
      this.#file,
      this.#folder,
      this.#now,
      this.#open,
      this.#message,
    );
    this.#zone.addEventListener("dragover", (event) => this.#over(event, true));
    this.#zone.addEventListener("dragleave", (event) => this.#over(event, false));
    this.#zone.addEventListener("drop", (event) => this.#drop(event));
    this.#listOpen();
  }

  #pick(input) {
    input.value = ""; // so that the same file can be chosen again
    input.click();
  }

  #over(event, on) {
    event.preventDefault();
    this.#zone.classList.toggle("over", on);
  }

  async #drop(event) {
    this.#over(event, false);
    const picked = await attempt(this.#message, () => ofDrop(event.dataTransfer));
    if (picked) this.#take(picked);
  }

  #take(picked) {
    const { name, files, leftOut } = sorted(picked);
    this.#message.textContent = leftOut ? `${leftOut} hidden files are skipped` : "";
    if (files.length === 0) {
      this.#message.textContent = "It contains no file";
      return;
    }
    this.#sending?.pause();
    this.#sending = new Sending({ name, files });
    this.#sending.addEventListener("change", (event) => this.#draw(event.target));
    this.dispatchEvent(new CustomEvent("chosen", { detail: name }));
    this.#sending.start();
  }

  #draw(sending) {
    if (sending !== this.#sending) return;
    const { state, name, files, sent, total, text } = sending;
    this.#now.hidden = state === "removed";
    this.#zone.hidden = !["failed", "removed", "done"].includes(state);
    const label = files.length > 1 ? `${name}, ${count(files.length)} files` : name;
    fill(this.#title, make("strong", {}, label), ` ${STATES[state] ?? ""}`);
    this.#bar.value = total ? (state === "done" ? 1 : sent / total) : 1;
    if (state === "failed") showError(this.#text, sending.error);
    else this.#text.textContent = text || this.#figures(sending);
    this.#offer(state);
    const busy = ["sending", "trying"].includes(state);
    if (busy) addEventListener("beforeunload", this.#leaving);
    else removeEventListener("beforeunload", this.#leaving);
    if (["paused", "failed", "done", "removed"].includes(state)) this.#listOpen();
    if (state === "done")
      this.dispatchEvent(new CustomEvent("recording", { detail: sending.recording }));
    if (state === "removed") this.dispatchEvent(new CustomEvent("removed"));
  }

  #figures({ state, sent, total, rate, eta }) {
    if (state === "done") return bytes(total);
    const parts = [`${bytes(sent)} of ${bytes(total)}`];
    if (state === "sending" && rate > 0) parts.push(`${bytes(rate)}/s`, `${seconds(eta)} left`);
    return parts.join(" · ");
  }

  #offer(state) {
    if (this.#buttons.dataset.state === state) return;
    this.#buttons.dataset.state = state;
    const button = (text, action) =>
      make("button", { type: "button", onclick: () => attempt(this.#message, action) }, text);
    const pause = button("Pause", () => this.#sending.pause());
    const resume = button("Continue", () => this.#sending.start());
    const remove = button("Remove", () => this.#sending.remove());
    this.#buttons.replaceChildren(
      ...(["sending", "trying"].includes(state) ? [pause] : []),
      ...(["paused", "failed"].includes(state) ? [resume] : []),
      ...(["paused", "failed", "trying", "done"].includes(state) ? [remove] : []),
    );
  }

  /** Lists unfinished uploads, also those begun before this page was opened. */
  async #listOpen() {
    const uploads = (await attempt(this.#message, listUploads)) ?? [];
    const mine =
      this.#sending && !["removed", "done"].includes(this.#sending.state)
        ? this.#sending.name
        : null;
    const rows = uploads.filter((one) => !one.finished && one.name !== mine);
    this.#open.hidden = rows.length === 0;
    this.#open.replaceChildren(...rows.map((one) => this.#row(one)));
  }

  #row({ id, name, received, bytes: total, expires }) {
    const remove = async () => {
      if (await succeeds(this.#message, () => removeUpload(id))) this.#listOpen();
    };
    return make(
      "li",
      {},
      make(
        "div",
        {},
        make("strong", {}, name),
        make(
          "small",
          {},
          ` ${bytes(received)} of ${bytes(total)} received. Select the same ` +
            `${name.includes(".") ? "file" : "folder"} again to continue, until ${when(expires)}`,
        ),
      ),
      make(
        "button",
        { type: "button", ariaLabel: `Remove the upload of ${name}`, onclick: remove },
        "Remove",
      ),
    );
  }
}

customElements.define("upload-box", UploadBox);
