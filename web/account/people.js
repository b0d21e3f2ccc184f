// For admins: accounts, all sessions, the audit log.

import {
  addPerson,
  changePerson,
  endSession,
  listPeople,
  listSessions,
  readAudit,
  readCurrentUser,
} from "../shared/api.js";
import {
  attempt,
  byId,
  fields,
  html,
  only,
  onSubmit,
  render,
  repeat,
  succeeds,
  targetOf,
} from "../shared/dom.js";
import { when } from "../shared/format.js";
import "../shared/page_head.js";
import "./session_list.js";
import { withPassword } from "./recent_login.js";
import { showTrustedKeys } from "./trusted_keys.js";
import { showWebhooks } from "./webhooks.js";
import { showWorkers } from "./workers.js";
import { t, wordOf } from "../shared/texts.js";

/** @import {Account, Changes, Entry, Role} from "../shared/http_types" */

const ROLES = {
  viewer: t("role-is-viewer"),
  operator: t("role-is-operator"),
  reviewer: t("role-is-reviewer"),
  admin: t("role-is-admin"),
};
/** @type {Record<string, string>} */
const OUTCOMES = {
  done: `✓ ${t("outcome-done")}`,
  refused: `✕ ${t("outcome-refused")}`,
  failed: `✕ ${t("outcome-failed")}`,
};
const ROLE_NAMES = Object.keys(ROLES);
const state = {
  /** @type {Entry[]} */
  entries: [], // of the audit log, the newest first
};

function person(/** @type {Account} */ { name, role, disabled, created }) {
  const choose = (/** @type {Event} */ event) =>
    change(name, { role: /** @type {Role} */ (targetOf(event).value) });
  const choice = html`<select aria-label=${t("role-of", { name })} @change=${choose}>
    ${ROLE_NAMES.map(
      (one) => html`<option value=${one} .selected=${one === role}>${t(`role-${one}`)}</option>`,
    )}
  </select>`;
  const lock = html`<button
    type="button"
    aria-label=${t(disabled ? "enable-of" : "disable-of", { name })}
    @click=${() => change(name, { disabled: !disabled })}
  >
    ${disabled ? t("enable") : t("disable")}
  </button>`;
  return html`<tr>
    <th scope="row">${name}</th>
    <td data-label=${t("role")}>${choice}</td>
    <td data-label=${t("state")} class=${disabled ? "bad" : "good"}>
      ${disabled ? `✕ ${t("is-disabled")}` : `✓ ${t("may-sign-in")}`}
    </td>
    <td data-label=${t("since")}><time>${when(created)}</time></td>
    <td><div class="actions">${lock}</div></td>
  </tr>`;
}

/**
 * @param {string} name
 * @param {Changes} changes
 */
async function change(name, changes) {
  if (await succeeds(byId("message"), () => withPassword(() => changePerson(name, changes))))
    await reload();
}

async function reload() {
  const people = await attempt(byId("message"), listPeople);
  if (people)
    render(
      repeat(people, ({ name }) => name, person),
      byId("people"),
    );
  byId("nobody").hidden = !people || people.length > 0;
  sessions.reload();
  await readLog();
}

function entry(/** @type {Entry} */ { time, person: who, address, action, object, outcome }) {
  return html`<tr>
    <th scope="row"><time datetime=${time}>${when(time)}</time></th>
    <td data-label=${t("who")}>${who}</td>
    <td data-label=${t("from-address")}>${address}</td>
    <td data-label=${t("what")}>
      <span><b>${wordOf("audit", action)}</b>${" "}<code>${object}</code></span>
    </td>
    <td data-label=${t("outcome")} class=${outcome === "done" ? "" : "bad"}>
      ${OUTCOMES[outcome] ?? outcome}
    </td>
  </tr>`;
}

/** Reads the audit log: the newest entries, or those before an entry in addition. */
async function readLog(/** @type {number | undefined} */ before = undefined) {
  const log = await attempt(byId("audit-message"), () => readAudit(before));
  if (!log) return;
  state.entries = before ? [...state.entries, ...log.entries] : log.entries;
  render(
    repeat(state.entries, ({ number }) => number, entry),
    byId("audit"),
  );
  const oldest = state.entries.at(-1)?.number;
  byId("older").hidden = !oldest || oldest === 1;
  const { entries, broken_at: broken, newest } = log.chain;
  const mark = broken
    ? html`<b class="bad">✕ ${t("chain-broken", { entry: String(broken) })}</b>`
    : html`<b class="good">✓ ${t("chain-intact", { entries })}</b>`;
  render(html`${mark}<code>${newest}</code>`, byId("chain"));
}

const sessions = only("session-list");
const form = byId("add", HTMLFormElement);
render(
  Object.entries(ROLES).map(([value, text]) => html`<option value=${value}>${text}</option>`),
  fields(form).role,
);
onSubmit(form, async (event) => {
  event.preventDefault();
  const { who, role, password } = fields(form);
  const fresh = {
    name: who.value,
    role: /** @type {Role} */ (role.value),
    password: password.value,
  };
  if (!(await attempt(byId("add-message"), () => withPassword(() => addPerson(fresh))))) return;
  form.reset();
  await reload();
});
byId("older").addEventListener("click", () => readLog(state.entries.at(-1)?.number));
sessions.source = { read: listSessions, end: endSession };
byId("without").hidden = (await attempt(byId("message"), readCurrentUser))?.login ?? true;
await reload();
await showTrustedKeys(() => readLog());
await showWebhooks(() => readLog());
await showWorkers(() => readLog());
