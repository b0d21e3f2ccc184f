// The dialogs of the rig page: a name for a copy, and where an imported file goes.

import { addRigVersion, createRig } from "../shared/api.js";
import { closeButton, openDialog } from "../shared/dialog.js";
import { attempt, fields, html, messagePlace, nothing, targetOf, within } from "../shared/dom.js";
import { slug } from "./rig_math.js";
import { t } from "../shared/texts.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @import {FileBeside, SavedRig} from "../shared/http_types"
 * @typedef {(saved: SavedRig) => void} Done
 */

const MAX_BYTES = 128 * 1024;

const nameField = (/** @type {string} */ name) =>
  html`<label
    ><span>${t("new-rig-name")}</span
    ><input
      name="id"
      value=${name}
      pattern="[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}"
      title=${t("name-letters")}
      autocomplete="off"
      spellcheck="false"
      required
  /></label>`;

const noteField = () =>
  html`<label
    ><span>${t("note")}</span><input name="note" maxlength="500" autocomplete="off"
  /></label>`;

/**
 * Opens a dialog with a form; `save` gives the saved rig, which `done` receives.
 * @param {string} title
 * @param {Content[]} content
 * @param {{button: string, done: Done,
 *   save: (given: Record<string, HTMLInputElement>) => Promise<SavedRig>}} how
 */
function open(title, content, { button, save, done }) {
  const submit = async (/** @type {SubmitEvent} */ event) => {
    event.preventDefault();
    const form = within(dialog, "form", HTMLFormElement);
    const saved = await attempt(within(dialog, ".error"), () => save(fields(form)));
    if (!saved) return;
    dialog.close();
    done(saved);
  };
  const dialog = openDialog(
    title,
    html`<form @submit=${submit}>
      ${content} ${messagePlace()}
      <div class="buttons">${closeButton()}<button class="primary">${button}</button></div>
    </form>`,
  );
}

/**
 * Asks for the name of a copy of a rig.
 * @param {string} id
 * @param {Done} done
 */
export function askDuplicate(id, done) {
  open(t("duplicate-of", { id }), [nameField(slug(`${id}-copy`)), noteField()], {
    button: t("duplicate"),
    save: ({ id: input, note }) =>
      createRig({ id: input.value, copy_of: id, note: note.value.trim() }),
    done,
  });
}

/**
 * A file that describes a LiDAR, as it is sent.
 * @param {File} file
 * @returns {Promise<FileBeside>}
 */
async function besideOf(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  const text = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return { name: file.name, content: btoa(text) };
}

/**
 * Asks where a rig file goes: a new rig, or the next version of one of `own`.
 * @param {File[]} files The rig file, and files that describe its LiDARs.
 * @param {string[]} own
 * @param {Done} done
 */
export function askImport(files, own, done) {
  const file = files.find((one) => /\.toml$/i.test(one.name)) ?? files[0];
  const others = files.filter((one) => one !== file);
  const choose = (/** @type {Event} */ event) => {
    const select = targetOf(event);
    const form = /** @type {HTMLFormElement} */ (select.closest("form"));
    const name = within(form, "[name=id]", HTMLInputElement);
    name.disabled = /** @type {HTMLElement} */ (name.closest("label")).hidden = select.value !== "";
  };
  const into = html`<label
    ><span>${t("import-as")}</span
    ><select name="into" @change=${choose}>
      <option value="">${t("a-new-rig")}</option>
      ${own.map((id) => html`<option value=${id}>${t("a-new-version", { id })}</option>`)}
    </select></label
  >`;
  const names = others.map((one) => one.name).join(", ");
  const beside = html`<p>${t("import-beside", { names })}</p>`;
  const content = [
    others.length ? beside : nothing,
    own.length ? into : nothing,
    nameField(slug(file.name)),
    noteField(),
  ];
  open(t("import-of", { name: file.name }), content, {
    button: t("import"),
    save: async ({ into: rig, id, note }) => {
      const wrong = files.find((one) => !one.size || one.size > MAX_BYTES);
      if (wrong) throw new Error(t("file-size", { most: MAX_BYTES, size: wrong.size }));
      const version = {
        toml: await file.text(),
        beside: await Promise.all(others.map(besideOf)),
        note: note.value.trim(),
      };
      return rig?.value
        ? addRigVersion(rig.value, version)
        : createRig({ id: id.value, ...version });
    },
    done,
  });
}
