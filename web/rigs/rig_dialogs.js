// The dialogs of the rig page: a name for a copy, and where an imported file goes.

import { addRigVersion, createRig } from "../shared/api.js";
import { attempt, fields, make } from "../shared/dom.js";

const NAME = { pattern: "[A-Za-z0-9][A-Za-z0-9._\\-]{0,63}", required: true };
const MAX_BYTES = 128 * 1024;

/** A name for a folder, from a file name or another name. */
export const slug = (text) =>
  text
    .replace(/(-v\d+)?\.toml$/i, "")
    .replace(/[^A-Za-z0-9._-]+/g, "-")
    .replace(/^[^A-Za-z0-9]+/, "")
    .slice(0, 64);

const nameInput = (value) =>
  make("input", {
    name: "id",
    value,
    autocomplete: "off",
    spellcheck: false,
    title: "Letters, digits, dot, dash and underscore",
    ...NAME,
  });

/** Opens a dialog with a form; `action(form)` gives the saved rig, which `done` receives. */
function open(dialog, { title, content, button, action, done }) {
  const message = make("p", { className: "error", role: "alert" });
  const submit = async (event) => {
    event.preventDefault();
    const saved = await attempt(message, () => action(fields(event.target)));
    if (!saved) return;
    dialog.close();
    done(saved);
  };
  dialog.replaceChildren(
    make("h2", { id: "dialog-title" }, title),
    make(
      "form",
      { onsubmit: submit },
      ...content,
      message,
      make(
        "div",
        { className: "buttons" },
        make("button", { type: "button", onclick: () => dialog.close() }, "Cancel"),
        make("button", { className: "primary" }, button),
      ),
    ),
  );
  dialog.showModal();
}

const noteField = () =>
  make(
    "label",
    {},
    make("span", {}, "Note"),
    make("input", { name: "note", maxLength: 500, autocomplete: "off" }),
  );

export function askDuplicate(dialog, id, done) {
  open(dialog, {
    title: `Duplicate ${id}`,
    content: [
      make("label", {}, make("span", {}, "Name of the new rig"), nameInput(slug(`${id}-copy`))),
      noteField(),
    ],
    button: "Duplicate",
    action: ({ id: input, note }) =>
      createRig({ id: input.value, copy_of: id, note: note.value.trim() }),
    done,
  });
}

/** Asks where a rig file goes: a new rig, or the next version of one of `own`. */
export async function askImport(dialog, { file, own, done }) {
  const toml = file.size <= MAX_BYTES ? await file.text() : "";
  const input = nameInput(slug(file.name));
  const label = make("label", {}, make("span", {}, "Name of the new rig"), input);
  const into = make(
    "select",
    { name: "into" },
    make("option", { value: "" }, "A new rig"),
    ...own.map((id) => make("option", { value: id }, `A new version of ${id}`)),
  );
  into.addEventListener("change", () => {
    label.hidden = input.disabled = into.value !== "";
  });
  open(dialog, {
    title: `Import ${file.name}`,
    content: [
      ...(own.length ? [make("label", {}, make("span", {}, "Import as"), into)] : []),
      label,
      noteField(),
    ],
    button: "Import",
    action: ({ note }) => {
      if (!toml) throw new Error(`A rig file has 1 to ${MAX_BYTES} bytes, this one ${file.size}`);
      const version = { toml, note: note.value.trim() };
      return into.value
        ? addRigVersion(into.value, version)
        : createRig({ id: input.value, ...version });
    },
    done,
  });
}
