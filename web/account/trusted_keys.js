// For admins: the keys whose signatures count on this server.

import { addTrustedKey, listTrustedKeys, removeTrustedKey } from "../shared/api.js";
import {
  attempt,
  byId,
  fields,
  html,
  nothing,
  onSubmit,
  render,
  repeat,
  succeeds,
} from "../shared/dom.js";
import { when } from "../shared/format.js";
import { withPassword } from "./recent_login.js";

/** @import {KeyView} from "../shared/http_types" */

const listeners = { changed: () => {} };

/**
 * @param {KeyView} key
 * @param {boolean} signs
 */
function row(key, signs) {
  const counts = !key.removed;
  const removal =
    counts && !signs
      ? html`<button
          type="button"
          aria-label="Remove the key of ${key.name}"
          @click=${() => remove(key.fingerprint)}
        >
          Remove
        </button>`
      : nothing;
  return html`<tr>
    <th scope="row">${key.name}</th>
    <td data-label="Key">
      <div>
        <code>${key.fingerprint}</code>
        <details>
          <summary>Public key</summary>
          <code>${key.public_key}</code>
        </details>
      </div>
    </td>
    <td data-label="State" class=${counts ? "good" : "bad"}>
      ${counts ? "✓ Counts" : `✕ Removed ${when(key.removed)} by ${key.removed_by}`}
    </td>
    <td data-label="Since">
      ${key.own ? `${when(key.added)}, made here` : `${when(key.added)}, by ${key.by}`}
    </td>
    <td><div class="actions">${removal}</div></td>
  </tr>`;
}

async function remove(/** @type {string} */ fingerprint) {
  const removed = () => withPassword(() => removeTrustedKey(fingerprint));
  if (!(await succeeds(byId("keys-message"), removed))) return;
  await reload();
  listeners.changed();
}

async function reload() {
  const keys = await attempt(byId("keys-message"), listTrustedKeys);
  if (!keys) return;
  const own = keys.filter((key) => key.own && !key.removed);
  const newest = own.toSorted((a, b) => a.added.localeCompare(b.added)).at(-1);
  render(
    repeat(
      keys,
      (key) => key.fingerprint,
      (key) => row(key, key === newest),
    ),
    byId("keys"),
  );
  byId("no-keys").hidden = keys.length > 0;
}

/** Fills the section; `onChange` is called after each change. */
export async function showTrustedKeys(/** @type {() => void} */ onChange) {
  listeners.changed = onChange;
  const form = byId("add-key", HTMLFormElement);
  onSubmit(form, async (event) => {
    event.preventDefault();
    const { whose, public_key } = fields(form);
    const fresh = { name: whose.value, public_key: public_key.value.trim() };
    const added = () => withPassword(() => addTrustedKey(fresh));
    if (!(await attempt(byId("add-key-message"), added))) return;
    form.reset();
    await reload();
    listeners.changed();
  });
  await reload();
}
