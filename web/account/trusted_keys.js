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
import { t } from "../shared/texts.js";

/** @import {KeyView} from "../shared/http_types" */

const listeners = { changed: () => {} };

const removedText = (/** @type {KeyView} */ key) =>
  t("key-removed", { when: when(key.removed), who: key.removed_by });

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
          aria-label=${t("remove-key-of", { name: key.name })}
          @click=${() => remove(key.fingerprint)}
        >
          ${t("remove")}
        </button>`
      : nothing;
  return html`<tr>
    <th scope="row">${key.name}</th>
    <td data-label=${t("key")}>
      <div>
        <code>${key.fingerprint}</code>
        <details>
          <summary>${t("public-key")}</summary>
          <code>${key.public_key}</code>
        </details>
      </div>
    </td>
    <td data-label=${t("state")} class=${counts ? "good" : "bad"}>
      ${counts ? `✓ ${t("key-counts")}` : `✕ ${removedText(key)}`}
    </td>
    <td data-label=${t("since")}>
      ${
        key.own
          ? t("made-here", { when: when(key.added) })
          : t("added-by", { when: when(key.added), who: key.by })
      }
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
