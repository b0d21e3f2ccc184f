// For admins: the keys whose signatures count on this server.

import { addTrustedKey, listTrustedKeys, removeTrustedKey } from "../shared/api.js";
import { attempt, byId, fields, make, onSubmit, succeeds } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { withPassword } from "./recent_login.js";

let changed = () => {};

function row(key, signs) {
  const counts = !key.removed;
  const removal =
    counts && !signs
      ? make(
          "button",
          {
            type: "button",
            ariaLabel: `Remove the key of ${key.name}`,
            onclick: () => remove(key.fingerprint),
          },
          "Remove",
        )
      : null;
  return make(
    "tr",
    {},
    make("th", { scope: "row" }, key.name),
    make(
      "td",
      { "data-label": "Key" },
      make(
        "div",
        {},
        make("code", {}, key.fingerprint),
        make("details", {}, make("summary", {}, "Public key"), make("code", {}, key.public_key)),
      ),
    ),
    make(
      "td",
      { "data-label": "State", className: counts ? "good" : "bad" },
      counts ? "✓ Counts" : `✕ Removed ${when(key.removed)} by ${key.removed_by}`,
    ),
    make(
      "td",
      { "data-label": "Since" },
      key.own ? `${when(key.added)}, made here` : `${when(key.added)}, by ${key.by}`,
    ),
    make("td", {}, make("div", { className: "actions" }, removal)),
  );
}

async function remove(fingerprint) {
  const removed = () => withPassword(() => removeTrustedKey(fingerprint));
  if (!(await succeeds(byId("keys-message"), removed))) return;
  await reload();
  changed();
}

async function reload() {
  const keys = await attempt(byId("keys-message"), listTrustedKeys);
  if (!keys) return;
  const own = keys.filter((key) => key.own && !key.removed);
  const newest = own.toSorted((a, b) => a.added.localeCompare(b.added)).at(-1);
  byId("keys").replaceChildren(...keys.map((key) => row(key, key === newest)));
  byId("no-keys").hidden = keys.length > 0;
}

/** Fills the section; `onChange` is called after each change. */
export async function showTrustedKeys(onChange) {
  changed = onChange;
  const form = byId("add-key", HTMLFormElement);
  onSubmit(form, async (event) => {
    event.preventDefault();
    const { whose, public_key } = fields(form);
    const fresh = { name: whose.value, public_key: public_key.value.trim() };
    const added = () => withPassword(() => addTrustedKey(fresh));
    if (!(await attempt(byId("add-key-message"), added))) return;
    form.reset();
    await reload();
    changed();
  });
  await reload();
}
