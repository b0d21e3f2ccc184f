// References: add, align, remove; the table of slices against one (V Table 3.2).

import {
  alignReference,
  browse,
  compareCsvUrl,
  compareSlices,
  removeReference,
} from "../shared/api.js";
import { attempt, html, nothing, render, repeat, targetOf, within } from "../shared/dom.js";
import { bytes, count } from "../shared/format.js";
import { t } from "../shared/texts.js";
import { Sending, sorted } from "../projects/resumable_upload.js";
import { openAlignment } from "./align.js";
import { choice } from "./columns.js";
import { comparison, METHODS } from "./comparison.js";
import { ofInput } from "./picking.js";
import { ReferenceReader } from "./reading.js";
import { planeOf, moved } from "./state.js";

/**
 * @import {Comparison, FolderEntry, ListedReference, SliceFacts} from "../shared/http_types"
 * @import {Panel, SlicesPage} from "./findings.js"
 * @import {SliceState} from "./state.js"
 * @typedef {object} ReferenceState
 * @property {ListedReference[]} references
 * @property {string} path of the file to add
 * @property {FolderEntry[] | null} entries of the open folder; null = none is open
 * @property {string} folder
 * @property {Sending | null} sending
 * @property {string} which slices are compared
 * @property {SliceState["method"]} method
 * @property {{found: Comparison, url: string} | null} compared
 */

const KINDS = ".ply,.pcd,.las,.laz,.e57,.ptx,.xyz,.txt,.csv,.obj,.stl";
/** @type {Array<[string, string]>} */
const WHICH = [
  ["usual", t("usual-slices")],
  ["this", t("this-slice")],
  ["repeated", t("this-repeated")],
];
const METHOD_CHOICES = /** @type {Array<[string, string]>} */ (
  Object.entries(METHODS).map(([key, text]) => [key, t("distances", { method: text })])
);

/**
 * Fills the panel of references.
 * @param {HTMLElement} host
 * @param {SlicesPage} page
 * @returns {Panel}
 */
export function referencePanel(host, { id, change, state: slice, reload }) {
  /** @type {ReferenceState} */
  const state = {
    references: [],
    path: "",
    entries: null,
    folder: "",
    sending: null,
    which: "usual",
    method: "plane",
    compared: null,
  };
  const message = () => within(host, ".problem");
  const set = (/** @type {Partial<ReferenceState>} */ changes) => {
    Object.assign(state, changes);
    draw();
  };
  const reader = new ReferenceReader(id, { draw: () => draw(), message, added });

  /**
   * A button that cannot be used again before its action is done.
   * @param {string} text
   * @param {() => unknown} action
   * @param {boolean} [busy] with another
   */
  const button = (text, action, busy = false) => {
    const act = async (/** @type {Event} */ event) => {
      const pressed = /** @type {HTMLButtonElement} */ (event.currentTarget);
      pressed.disabled = true;
      await attempt(message(), action);
      pressed.disabled = false;
    };
    return html`<button type="button" ?disabled=${busy} @click=${act}>${text}</button>`;
  };

  /** Sends the file like a recording (it goes on after a break), then uses it. */
  async function upload(/** @type {HTMLInputElement} */ input) {
    const sending = new Sending(sorted(ofInput(input)));
    input.value = ""; // the same file may be chosen again
    sending.addEventListener("change", draw);
    set({ sending });
    try {
      await sending.start();
      if (sending.state === "failed") {
        const reason = sending.error instanceof Error ? sending.error.message : t("it-failed");
        throw new Error(t("choose-again", { reason }));
      }
      if (sending.state !== "done") return;
      set({ path: sending.recording });
      await reader.read(sending.recording);
    } finally {
      set({ sending: null });
    }
  }

  async function added(/** @type {ListedReference} */ reference) {
    set({ path: "" });
    await reload();
    change({ ref: reference.id, color: "distance", lo: null, hi: null }, { keep: true });
  }

  const openFolder = async (/** @type {string} */ folder) =>
    set({ folder, entries: await browse(folder) });

  async function align(
    /** @type {ListedReference} */ one,
    /** @type {"icp" | "undo" | "none"} */ how,
  ) {
    await alignReference(id, one.id, { how });
    await realigned();
  }

  async function realigned() {
    set({ compared: null }); // of the alignment before
    await reload();
    change({}, { keep: true });
  }

  async function remove(/** @type {ListedReference} */ one) {
    await removeReference(id, one.id);
    if (slice().ref === one.id) change({ ref: "", color: "height" }, { keep: true });
    await reload();
  }

  function planes() {
    const now = slice();
    if (state.which === "usual") return [];
    if (state.which === "this") return [planeOf(now)];
    return Array.from({ length: now.count }, (_, k) => planeOf(moved(now, k * now.spacing)));
  }

  async function compare() {
    const { method } = state;
    const { ref: reference, source } = slice();
    if (!reference) throw new Error(t("choose-reference"));
    const ask = { reference, method, planes: planes(), source };
    change({ method }, { keep: true });
    const found = await compareSlices(id, ask);
    set({ compared: { found, url: compareCsvUrl(id, ask) } });
  }

  function row(/** @type {ListedReference} */ one) {
    const size = one.points
      ? t("points-many", { count: count(one.points) })
      : t("triangles", { count: count(one.triangles) });
    const show = () =>
      change({ ref: one.id, color: "distance", lo: null, hi: null }, { keep: true });
    return html`<div class="reference-row">
      <strong>${one.name}</strong
      ><span class="quiet"> ${t("size-alignment", { size, alignment: one.alignment })}</span>
      ${one.notes.length ? html`<small class="quiet">${one.notes.join(" ")}</small>` : nothing}
      ${
        one.fit
          ? html`<span class=${one.fits === false ? "bad" : "quiet"}>${one.fit}</span>`
          : nothing
      }
      <span class="buttons"
        >${button(t("show"), show)}${button(t("align-icp"), () => align(one, "icp"))}${button(
          t("align-pairs"),
          () => openAlignment(id, one, realigned),
        )}${one.can_undo ? button(t("undo-alignment"), () => align(one, "undo")) : nothing}${button(
          t("no-alignment"),
          () => align(one, "none"),
        )}${button(t("remove"), () => remove(one))}</span
      >
    </div>`;
  }

  function draw() {
    const { references, path, sending, which, method, compared } = state;
    const busy = sending !== null;
    const pick = (/** @type {Event} */ event) => {
      const input = targetOf(event);
      attempt(message(), () => upload(input));
    };
    const choose = () => within(host, "[type=file]").click();
    const type = (/** @type {Event} */ event) => (state.path = targetOf(event).value);
    const setMethod = (/** @type {string} */ one) =>
      set({ method: /** @type {SliceState["method"]} */ (one) });
    render(
      html`<div>
          ${repeat(
            references,
            (one) => one.id,
            (one) => row(one),
          )}
        </div>
        <div class="row">
          <button type="button" ?disabled=${busy} @click=${choose}>${t("upload-file")}</button
          ><input
            type="file"
            hidden
            accept=${KINDS}
            aria-label=${t("reference-file")}
            @change=${pick}
          /><input
            placeholder=${t("path-here")}
            aria-label=${t("path-of-reference")}
            autocomplete="off"
            spellcheck="false"
            .value=${path}
            @input=${type}
          />${button(t("browse"), () => openFolder(""))}${reader.fields}${button(
            t("add-reference"),
            () => reader.read(state.path),
            busy,
          )}
        </div>
        ${sending ? progress(sending) : nothing} ${folderList()}
        <div>${reader.element}</div>
        <p class="quiet">${t("reference-formats")}</p>
        <div class="row">
          ${choice(t("slices-to-compare"), WHICH, which, (one) => set({ which: one }))}
          ${choice(t("method-of-distances"), METHOD_CHOICES, method, setMethod)}
          ${button(t("compare"), compare)}
        </div>
        <p class="error problem" role="alert"></p>
        <div>${compared ? comparison(compared.found, compared.url) : nothing}</div>`,
      host,
    );
  }

  function progress(/** @type {Sending} */ sending) {
    const { name, sent, total, text, state: at } = sending;
    const stop = () => attempt(message(), () => sending.remove());
    const words =
      at === "done"
        ? t("being-read", { name })
        : text || t("sent-of", { name, sent: bytes(sent), total: bytes(total) });
    return html`<div class="row">
      <span role="status">${words}</span
      ><progress
        max="1"
        aria-label=${t("upload-of-reference")}
        .value=${total ? sent / total : 1}
      ></progress
      ><button type="button" @click=${stop}>${t("stop")}</button>
    </div>`;
  }

  /** The entries of the open folder: folders open, a file is chosen. */
  function folderList() {
    const { entries, folder } = state;
    if (!entries) return nothing;
    const open = (/** @type {string} */ to) => () => attempt(message(), () => openFolder(to));
    const up = folder.split("/").slice(0, -1).join("/");
    return html`<div class="folder">
      ${
        folder ? html`<button type="button" @click=${open(up)}>${t("folder-up")}</button>` : nothing
      }
      ${entries.map((entry) =>
        entry.folder
          ? html`<button type="button" @click=${open(entry.path)}>
              <span>${entry.name}/</span>
            </button>`
          : html`<button type="button" @click=${() => set({ path: entry.path, entries: null })}>
              <span>${entry.name}</span><small>${bytes(entry.bytes)}</small>
            </button>`,
      )}
    </div>`;
  }

  draw();
  return { facts: (/** @type {SliceFacts} */ { references }) => set({ references }) };
}
