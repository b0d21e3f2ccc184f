// Notes pinned to places of the map: the section of the panel, and what people do there.

import { idHere } from "../shared/address.js";
import {
  addNote,
  changeNote,
  notesUrl,
  photoUrl,
  readNotes,
  removeNote,
  removePhoto,
  setPhoto,
} from "../shared/api.js";
import { asError, byId, html, nothing, once, targetOf, within } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { decimal, t } from "../shared/texts.js";
import { FIELD_OF_VIEW, axesOf, eyeOf } from "./camera.js";
import { notePins, notesListed, page } from "./page.js";
import { smallPhoto } from "./photo.js";

/**
 * @import {HitPoint, MapNote, NoteView} from "../shared/http_types"
 * @import {Act} from "./bar.js"
 * @import {Camera, Screen} from "./camera.js"
 * @typedef {object} NoteDraft
 * @property {string} id "" = a new one
 * @property {number} revision
 * @property {number[]} p [m]
 * @property {string} text
 * @property {NoteView | null} view where its author looks from
 * @property {boolean} [typed] whether a person has changed its text
 */

const id = idHere();
const MOST_CHARACTERS = 500;

/**
 * What is done with notes.
 * @param {() => void} draw the page
 * @param {() => {camera: Camera, screen: Screen}} seen what the page shows
 */
export function notesOf(draw, seen) {
  const { notes } = page;
  addEventListener("beforeunload", (event) => {
    if (notes.draft?.typed) event.preventDefault(); // the browser asks
  });

  async function read() {
    notes.all = (await readNotes(id)).notes;
    draw();
  }

  /** Does it and reads the notes again, also after a refusal: it may be for another's change. */
  async function attempt(/** @type {() => Promise<unknown>} */ change) {
    try {
      await change();
      notes.problem = null;
    } catch (error) {
      notes.problem = error;
    }
    await read().catch((error) => (notes.problem = error));
    draw();
  }

  const focus = () => byId("panel").querySelector("textarea")?.focus();

  return {
    read,
    /** Begins a note where one clicked. */
    place(/** @type {HitPoint} */ { p_map }) {
      notes.draft = { id: "", revision: 0, p: p_map, text: "", view: viewOf(seen()) };
      Object.assign(page, { panel: true });
      draw();
      focus();
    },
    edit(/** @type {MapNote} */ { id: note, revision, p_map, text }) {
      notes.draft = { id: note, revision, p: p_map, text, view: null };
      draw();
      focus();
    },
    cancel() {
      Object.assign(notes, { draft: null, problem: null });
      draw();
    },
    keep: once((/** @type {string} */ text, /** @type {File | undefined} */ file) =>
      attempt(async () => {
        const { draft } = notes;
        if (!draft) return;
        draft.text = text; // it stays if the server refuses it
        const [x, y, z] = draft.p;
        const base64 = file ? await smallPhoto(file) : "";
        const camera = draft.view;
        const note = draft.id
          ? await changeNote(id, draft.id, { revision: draft.revision, text })
          : await addNote(id, { p_map: [x, y, z], text, key: page.index?.key ?? "", camera });
        Object.assign(draft, { id: note.id, revision: note.revision }); // if the photo is refused
        if (base64) await setPhoto(id, note.id, { revision: note.revision, base64 });
        notes.draft = null;
      }),
    ),
    mark: (/** @type {MapNote} */ { id: note, revision, status }) =>
      attempt(() =>
        changeNote(id, note, { revision, status: status === "open" ? "done" : "open" }),
      ),
    removePhoto: (/** @type {MapNote} */ { id: note, revision }) =>
      attempt(() => removePhoto(id, note, revision)),
    remove: (/** @type {MapNote} */ note) => attempt(() => removeNote(id, note.id)),
    filter(/** @type {string} */ status) {
      notes.filter = status;
      draw();
    },
  };
}

/** A camera as a note keeps it. @returns {NoteView} */
function viewOf(/** @type {{camera: Camera, screen: Screen}} */ { camera, screen }) {
  const { up, ahead } = axesOf(camera);
  return {
    eye_m: eyeOf(camera),
    ahead,
    up,
    parallel: camera.parallel,
    height_m: 2 * camera.distance * Math.tan(FIELD_OF_VIEW / 2),
    aspect: Math.min(100, Math.max(0.01, screen.width / screen.height)),
  };
}

/** The section of the panel. */
export function notesSection(/** @type {Act} */ act) {
  const { mayProcess: may } = page;
  const { all, draft, filter } = page.notes;
  const open = all.filter(({ status }) => status === "open").length;
  const listed = notesListed();
  return html`<section aria-labelledby="notes-title" class="notes">
    <h2 id="notes-title">${t("notes-open", { count: open })}</h2>
    ${draft ? form(draft, act) : nothing} ${problem()}
    ${
      all.length
        ? html`<label
              ><span>${t("show")}</span
              ><select @change=${(/** @type {Event} */ e) => act.notes.filter(targetOf(e).value)}>
                <option value="" ?selected=${!filter}>
                  ${t("all-count", { count: all.length })}
                </option>
                <option value="open" ?selected=${filter === "open"}>
                  ${t("open-count", { count: open })}
                </option>
                <option value="done" ?selected=${filter === "done"}>
                  ${t("done-count", { count: all.length - open })}
                </option>
              </select></label
            >
            <ol class="rows">
              ${listed.map((note) => row(note, act))}
            </ol>`
        : html`<p class="quiet">${t(may ? "no-notes-press" : "no-notes")}</p>`
    }
    <div class="buttons">
      ${
        may
          ? html`<button type="button" @click=${() => act.tool("note")}>${t("new-note")}</button>`
          : nothing
      }
      ${
        all.length
          ? html`<a class="button" href=${notesUrl(id, "geojson")} download
                >${t("download-geojson")}</a
              ><a class="button" href=${notesUrl(id, "bcf")} download>${t("download-bcf")}</a>`
          : nothing
      }
    </div>
  </section>`;
}

function problem() {
  const { problem: error } = page.notes;
  return error ? html`<p class="error" role="alert">${asError(error).message}</p>` : nothing;
}

/**
 * @param {NoteDraft} draft
 * @param {Act} act
 */
function form(draft, act) {
  const { id: note, p, text } = draft;
  const type = (/** @type {Event} */ event) =>
    Object.assign(draft, { text: targetOf(event).value, typed: true });
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const { value } = within(targetOf(event), "textarea", HTMLTextAreaElement);
    const { files } = within(targetOf(event), "input", HTMLInputElement);
    if (value.trim()) act.notes.keep(value.trim(), files?.[0]);
  };
  return html`<form @submit=${submit}>
    <label
      ><span
        >${note ? t("note") : t("note-at", { place: p.map((x) => decimal(x, 2)).join(" ") })}</span
      ><textarea
        rows="3"
        maxlength=${MOST_CHARACTERS}
        required
        .value=${text}
        @input=${type}
      ></textarea>
    </label>
    <label
      ><span>${t("photo-optional")}</span><input type="file" accept="image/jpeg,image/png"
    /></label>
    <div class="buttons">
      <button>${t("keep-note")}</button
      ><button type="button" @click=${() => act.notes.cancel()}>${t("cancel")}</button>
    </div>
  </form>`;
}

/**
 * @param {MapNote} note
 * @param {Act} act
 */
function row(note, act) {
  const { id: name, text, status, who, changed_by, changed, key } = note;
  const pin = notePins().find((one) => one.name === name);
  const { mayProcess: may } = page;
  const last = changed_by === who ? "" : `; ${changed_by}`;
  const history = `${who}${last}, ${when(changed)}`;
  const earlier = key === page.index?.key ? "" : ` · ${t("earlier-map")}`;
  return html`<li class=${status}>
    <button
      type="button"
      class="place"
      aria-pressed=${String(page.chosen?.kind === "note" && page.chosen.name === name)}
      @click=${() => pin && act.choosePin(pin)}
    >
      ${text}
    </button>
    ${
      note.photo
        ? html`<a class="photo" href=${photoUrl(id, note)} target="_blank" rel="noopener"
            ><img src=${photoUrl(id, note)} loading="lazy" alt=${t("photo-of", { text })}
          /></a>`
        : nothing
    }
    <small>${t(status === "done" ? "is-done" : "is-open")} · ${history}${earlier}</small>
    ${
      may
        ? html`<span class="buttons"
            ><button
              type="button"
              aria-label="${doneText(status)}: ${text}"
              @click=${() => act.notes.mark(note)}
            >
              ${doneText(status)}</button
            ><button
              type="button"
              aria-label="${t("edit")}: ${text}"
              @click=${() => act.notes.edit(note)}
            >
              ${t("edit")}</button
            >${
              note.photo
                ? html`<button
                    type="button"
                    aria-label=${t("remove-photo-of", { text })}
                    @click=${() => act.notes.removePhoto(note)}
                  >
                    ${t("remove-photo")}
                  </button>`
                : nothing
            }<button
              type="button"
              aria-label="${t("remove")}: ${text}"
              @click=${() => act.notes.remove(note)}
            >
              ${t("remove")}
            </button></span
          >`
        : nothing
    }
  </li>`;
}

const doneText = (/** @type {string} */ status) =>
  status === "open" ? t("mark-done") : t("reopen");
