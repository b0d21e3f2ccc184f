// <upload-box>: drop or choose a file or folder, send it, show progress.
// Event "recording" has the path on the server once everything is there.

import { listUploads, removeUpload } from "../shared/api.js";
import {
  attempt,
  html,
  messagePlace,
  nothing,
  render,
  repeat,
  say,
  showError,
  succeeds,
  targetOf,
  within,
} from "../shared/dom.js";
import { bytes, seconds, when } from "../shared/format.js";
import { t } from "../shared/texts.js";
import { ofDrop, ofInput } from "../slices/picking.js";
import { Sending, sorted } from "./resumable_upload.js";

/**
 * @import {UploadView} from "../shared/http_types"
 * @import {Picked} from "../slices/picking.js"
 * @import {SendingState} from "./resumable_upload.js"
 */

/** @type {Record<SendingState, string>} */
const STATES = {
  waiting: t("upload-waiting"),
  sending: t("upload-sending"),
  trying: t("upload-trying"),
  paused: t("upload-paused"),
  failed: t("upload-failed"),
  done: t("upload-done"),
  removed: "",
};
/** @type {SendingState[]} */
const AT_REST = ["paused", "failed", "done", "removed"];

export class UploadBox extends HTMLElement {
  #state = {
    /** @type {Sending | null} */
    sending: null,
    /** @type {UploadView[]} */
    open: [], // unfinished uploads, also those begun before this page was opened
    over: false, // whether files are dragged over it
  };
  #leaving = (/** @type {Event} */ event) => event.preventDefault();

  connectedCallback() {
    this.#draw();
    this.#listOpen();
  }

  get #message() {
    return within(this, ":scope > .error");
  }

  #draw() {
    const { sending, open, over } = this.#state;
    const idle = !sending || ["failed", "removed", "done"].includes(sending.state);
    const drag = (/** @type {DragEvent} */ event) => this.#over(event, true);
    const leave = (/** @type {DragEvent} */ event) => this.#over(event, false);
    const drop = (/** @type {DragEvent} */ event) => this.#drop(event);
    const take = (/** @type {Event} */ event) => this.#take(ofInput(targetOf(event)));
    const pick = (/** @type {string} */ selector) => () => {
      const input = within(this, selector, HTMLInputElement);
      input.value = ""; // so that the same file can be chosen again
      input.click();
    };
    render(
      html`<div
          class="drop ${over ? "over" : ""}"
          ?hidden=${!idle}
          @dragover=${drag}
          @dragleave=${leave}
          @drop=${drop}
        >
          <p>${t("upload-drop")}</p>
          <div class="buttons">
            <button type="button" @click=${pick(".one")}>${t("upload-file")}</button
            ><button type="button" @click=${pick(".folder")}>${t("upload-folder")}</button>
          </div>
        </div>
        <input class="one" type="file" hidden @change=${take} />
        <input class="folder" type="file" hidden webkitdirectory @change=${take} />
        <div class="upload-now" ?hidden=${!sending || sending.state === "removed"}>
          ${sending ? this.#progress(sending) : nothing}
        </div>
        <ul class="uploads" aria-label=${t("uploads-unfinished")} ?hidden=${open.length === 0}>
          ${repeat(
            open,
            ({ id }) => id,
            (one) => this.#row(one),
          )}
        </ul>
        ${messagePlace()}`,
      this,
    );
  }

  #progress(/** @type {Sending} */ sending) {
    const { state, name, files, sent, total } = sending;
    const label = files.length > 1 ? t("upload-files", { name, count: files.length }) : name;
    return html`<p class="upload-title"><strong>${label}</strong> ${STATES[state]}</p>
      <progress
        max="1"
        aria-label=${t("upload")}
        .value=${state === "done" || !total ? 1 : sent / total}
      ></progress>
      <p class="job-words" role="status"></p>
      <div class="buttons">${this.#buttons(sending)}</div>`;
  }

  #buttons(/** @type {Sending} */ sending) {
    const button = (
      /** @type {string} */ text,
      /** @type {() => unknown} */ action,
      /** @type {SendingState[]} */ states,
    ) =>
      states.includes(sending.state)
        ? html`<button type="button" @click=${() => attempt(this.#message, action)}>
            ${text}
          </button>`
        : nothing;
    return [
      button(t("upload-pause"), () => sending.pause(), ["sending", "trying"]),
      button(t("upload-continue"), () => sending.start(), ["paused", "failed"]),
      button(t("remove"), () => sending.remove(), ["paused", "failed", "trying", "done"]),
    ];
  }

  /**
   * @param {DragEvent} event
   * @param {boolean} over
   */
  #over(event, over) {
    event.preventDefault();
    this.#state.over = over;
    this.#draw();
  }

  async #drop(/** @type {DragEvent} */ event) {
    this.#over(event, false);
    const picked = await attempt(this.#message, () => ofDrop(event.dataTransfer));
    if (picked) this.#take(picked);
  }

  #take(/** @type {Picked[]} */ picked) {
    const { name, files, leftOut } = sorted(picked);
    say(this.#message, leftOut ? t("upload-hidden", { count: String(leftOut) }) : "");
    if (files.length === 0) return say(this.#message, t("upload-empty"));
    this.#state.sending?.pause();
    const sending = new Sending({ name, files });
    this.#state.sending = sending;
    sending.addEventListener("change", () => this.#changed(sending));
    this.dispatchEvent(new CustomEvent("chosen", { detail: name }));
    sending.start();
  }

  #changed(/** @type {Sending} */ sending) {
    if (sending !== this.#state.sending) return;
    const { state, text, error, recording } = sending;
    this.#draw();
    const words = within(this, ".job-words");
    if (state === "failed") showError(words, error);
    else say(words, text || figures(sending));
    if (["sending", "trying"].includes(state)) addEventListener("beforeunload", this.#leaving);
    else removeEventListener("beforeunload", this.#leaving);
    if (AT_REST.includes(state)) this.#listOpen();
    if (state === "done") this.dispatchEvent(new CustomEvent("recording", { detail: recording }));
    if (state === "removed") this.dispatchEvent(new CustomEvent("removed"));
  }

  async #listOpen() {
    const uploads = (await attempt(this.#message, listUploads)) ?? [];
    const { sending } = this.#state;
    const mine = sending && !["removed", "done"].includes(sending.state) ? sending.name : null;
    this.#state.open = uploads.filter((one) => !one.finished && one.name !== mine);
    this.#draw();
  }

  #row(/** @type {UploadView} */ { id, name, received, bytes: total, expires }) {
    const remove = async () => {
      if (await succeeds(this.#message, () => removeUpload(id))) this.#listOpen();
    };
    const again = name.includes(".") ? "upload-same-file" : "upload-same-folder";
    const values = { received: bytes(received), total: bytes(total), until: when(expires) };
    return html`<li>
      <div><strong>${name}</strong><small> ${t(again, values)}</small></div>
      <button type="button" aria-label=${t("upload-remove-of", { name })} @click=${remove}>
        ${t("remove")}
      </button>
    </li>`;
  }
}

/** How much was sent, and how fast. */
function figures(/** @type {Sending} */ { state, sent, total, rate, eta }) {
  if (state === "done") return bytes(total);
  const parts = [t("upload-sent", { sent: bytes(sent), total: bytes(total) })];
  if (state === "sending" && eta !== null)
    parts.push(`${bytes(rate)}/s`, t("time-left", { time: seconds(eta) }));
  return parts.join(" · ");
}

customElements.define("upload-box", UploadBox);
