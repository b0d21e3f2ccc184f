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

/** @import {Account, Changes, Entry, Role} from "../shared/http_types" */

const ROLES = {
  viewer: "Viewer: looks and measures",
  operator: "Operator: records and processes",
  reviewer: "Reviewer: processes, decides, approves",
  admin: "Admin: everything",
};
/** @type {Record<string, string>} */
const OUTCOMES = { done: "✓ Done", refused: "✕ Refused", failed: "✕ Failed" };
const ROLE_NAMES = Object.keys(ROLES);
const state = {
  /** @type {Entry[]} */
  entries: [], // of the audit log, the newest first
};

function person(/** @type {Account} */ { name, role, disabled, created }) {
  const choose = (/** @type {Event} */ event) =>
    change(name, { role: /** @type {Role} */ (targetOf(event).value) });
  const choice = html`<select aria-label="Role of ${name}" @change=${choose}>
    ${ROLE_NAMES.map((one) => html`<option .selected=${one === role}>${one}</option>`)}
  </select>`;
  const lock = html`<button
    type="button"
    aria-label="${disabled ? "Enable" : "Disable"} ${name}"
    @click=${() => change(name, { disabled: !disabled })}
  >
    ${disabled ? "Enable" : "Disable"}
  </button>`;
  return html`<tr>
    <th scope="row">${name}</th>
    <td data-label="Role">${choice}</td>
    <td data-label="State" class=${disabled ? "bad" : "good"}>
      ${disabled ? "✕ Disabled" : "✓ May sign in"}
    </td>
    <td data-label="Since"><time>${when(created)}</time></td>
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
    <td data-label="Who">${who}</td>
    <td data-label="From">${address}</td>
    <td data-label="What">
      <span><b>${action}</b>${" "}<code>${object}</code></span>
    </td>
    <td data-label="Outcome" class=${outcome === "done" ? "" : "bad"}>
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
    ? html`<b class="bad"
        >✕ Entry ${broken} does not match the hash of the one before: the log was altered</b
      >`
    : html`<b class="good">✓ ${entries} entries, hash chain intact</b>`;
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
