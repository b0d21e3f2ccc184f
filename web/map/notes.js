// Notes pinned to places of the map: the section of the panel, and what people do there.

import { idHere } from "../shared/address.js";
import { addNote, changeNote, notesUrl, readNotes, removeNote } from "../shared/api.js";
import { asError, byId, html, nothing, targetOf, within } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { notePins, notesListed, page } from "./page.js";

/**
 * @import {HitPoint, MapNote} from "../shared/http_types"
 * @import {Act} from "./bar.js"
 * @typedef {{id: string, revision: number, p: number[], text: string}} NoteDraft id "" = a new one
 */

const id = idHere();
const MOST_CHARACTERS = 500;

/**
 * What is done with notes.
 * @param {() => void} draw the page
 */
export function notesOf(draw) {
  const { notes } = page;

  async function read() {
    const { may_change, notes: all } = await readNotes(id);
    Object.assign(notes, { all, may: may_change });
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
      notes.draft = { id: "", revision: 0, p: p_map, text: "" };
      Object.assign(page, { panel: true });
      draw();
      focus();
    },
    edit(/** @type {MapNote} */ { id: note, revision, p_map, text }) {
      notes.draft = { id: note, revision, p: p_map, text };
      draw();
      focus();
    },
    cancel() {
      Object.assign(notes, { draft: null, problem: null });
      draw();
    },
    keep: (/** @type {string} */ text) =>
      attempt(async () => {
        const { draft } = notes;
        if (!draft) return;
        draft.text = text; // it stays if the server refuses it
        const [x, y, z] = draft.p;
        if (draft.id) await changeNote(id, draft.id, { revision: draft.revision, text });
        else await addNote(id, { p_map: [x, y, z], text, key: page.index?.key ?? "" });
        notes.draft = null;
      }),
    mark: (/** @type {MapNote} */ { id: note, revision, status }) =>
      attempt(() =>
        changeNote(id, note, { revision, status: status === "open" ? "done" : "open" }),
      ),
    remove: (/** @type {MapNote} */ note) => attempt(() => removeNote(id, note.id)),
    filter(/** @type {string} */ status) {
      notes.filter = status;
      draw();
    },
  };
}

/** The section of the panel. */
export function notesSection(/** @type {Act} */ act) {
  const { all, may, draft, filter } = page.notes;
  const open = all.filter(({ status }) => status === "open").length;
  const listed = notesListed();
  return html`<section aria-labelledby="notes-title" class="notes">
    <h2 id="notes-title">Notes (${open} open)</h2>
    ${draft ? form(draft, act) : nothing} ${problem()}
    ${
      all.length
        ? html`<label
              ><span>Show</span
              ><select @change=${(/** @type {Event} */ e) => act.notes.filter(targetOf(e).value)}>
                <option value="" ?selected=${!filter}>All (${all.length})</option>
                <option value="open" ?selected=${filter === "open"}>Open (${open})</option>
                <option value="done" ?selected=${filter === "done"}>
                  Done (${all.length - open})
                </option>
              </select></label
            >
            <ol class="rows">
              ${listed.map((note) => row(note, act))}
            </ol>`
        : html`<p class="quiet">None yet${may ? ": press N and click a place." : "."}</p>`
    }
    <div class="buttons">
      ${
        may
          ? html`<button type="button" @click=${() => act.tool("note")}>New note</button>`
          : nothing
      }
      ${
        all.length
          ? html`<a class="button" href=${notesUrl(id)} download>Download GeoJSON</a>`
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
function form({ id: note, p, text }, act) {
  const submit = (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const { value } = within(targetOf(event), "textarea", HTMLTextAreaElement);
    if (value.trim()) act.notes.keep(value.trim());
  };
  return html`<form @submit=${submit}>
    <label
      ><span>${note ? "Note" : `Note at ${p.map((x) => x.toFixed(2)).join(" ")} m`}</span
      ><textarea rows="3" maxlength=${MOST_CHARACTERS} required .value=${text}></textarea>
    </label>
    <div class="buttons">
      <button>Keep the note</button
      ><button type="button" @click=${() => act.notes.cancel()}>Cancel</button>
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
  const { may } = page.notes;
  const last = changed_by === who ? "" : `; ${changed_by}`;
  const history = `${who}${last}, ${when(changed)}`;
  const earlier = key === page.index?.key ? "" : " · placed in an earlier map";
  return html`<li class=${status}>
    <button
      type="button"
      class="place"
      aria-pressed=${String(page.chosen?.kind === "note" && page.chosen.name === name)}
      @click=${() => pin && act.choosePin(pin)}
    >
      ${text}
    </button>
    <small>${status === "done" ? "✓ Done" : "Open"} · ${history}${earlier}</small>
    ${
      may
        ? html`<span class="buttons"
            ><button
              type="button"
              aria-label="${doneText(status)}: ${text}"
              @click=${() => act.notes.mark(note)}
            >
              ${doneText(status)}</button
            ><button type="button" aria-label="Edit: ${text}" @click=${() => act.notes.edit(note)}>
              Edit</button
            ><button
              type="button"
              aria-label="Remove: ${text}"
              @click=${() => act.notes.remove(note)}
            >
              Remove
            </button></span
          >`
        : nothing
    }
  </li>`;
}

const doneText = (/** @type {string} */ status) => (status === "open" ? "Mark as done" : "Reopen");
