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
import { attempt, byId, fields, make, onSubmit, succeeds } from "../shared/dom.js";
import { when } from "../shared/format.js";
import "../shared/page_head.js";
import "./session_list.js";
import { withPassword } from "./recent_login.js";
import { showTrustedKeys } from "./trusted_keys.js";

const ROLES = {
  viewer: "Viewer: looks and measures",
  operator: "Operator: records and processes",
  reviewer: "Reviewer: processes, decides, approves",
  admin: "Admin: everything",
};
const OUTCOMES = { done: "✓ Done", refused: "✕ Refused", failed: "✕ Failed" };
let oldest;

function person({ name, role, disabled, created }) {
  const choice = make(
    "select",
    { ariaLabel: `Role of ${name}`, onchange: () => change(name, { role: choice.value }) },
    ...Object.keys(ROLES).map((one) => make("option", { value: one, selected: one === role }, one)),
  );
  const lock = make(
    "button",
    {
      type: "button",
      ariaLabel: `${disabled ? "Enable" : "Disable"} ${name}`,
      onclick: () => change(name, { disabled: !disabled }),
    },
    disabled ? "Enable" : "Disable",
  );
  return make(
    "tr",
    {},
    make("th", { scope: "row" }, name),
    make("td", { "data-label": "Role" }, choice),
    make(
      "td",
      { "data-label": "State", className: disabled ? "bad" : "good" },
      disabled ? "✕ Disabled" : "✓ May sign in",
    ),
    make("td", { "data-label": "Since" }, make("time", {}, when(created))),
    make("td", {}, make("div", { className: "actions" }, lock)),
  );
}

async function change(name, changes) {
  if (await succeeds(byId("message"), () => withPassword(() => changePerson(name, changes))))
    await reload();
}

async function reload() {
  const people = await attempt(byId("message"), listPeople);
  if (people) byId("people").replaceChildren(...people.map(person));
  byId("nobody").hidden = !people || people.length > 0;
  sessions.reload();
  await readLog();
}

function entry({ time, person: who, address, action, object, outcome }) {
  return make(
    "tr",
    {},
    make("th", { scope: "row" }, make("time", { dateTime: time }, when(time))),
    make("td", { "data-label": "Who" }, who),
    make("td", { "data-label": "From" }, address),
    make(
      "td",
      { "data-label": "What" },
      make("span", {}, make("b", {}, action), " ", make("code", {}, object)),
    ),
    make(
      "td",
      { "data-label": "Outcome", className: outcome === "done" ? "" : "bad" },
      OUTCOMES[outcome] ?? outcome,
    ),
  );
}

async function readLog(before) {
  const log = await attempt(byId("audit-message"), () => readAudit(before));
  if (!log) return;
  if (before) byId("audit").append(...log.entries.map(entry));
  else byId("audit").replaceChildren(...log.entries.map(entry));
  oldest = log.entries.at(-1)?.number ?? oldest;
  byId("older").hidden = !oldest || oldest === 1;
  const { entries, broken_at: broken, newest } = log.chain;
  byId("chain").replaceChildren(
    broken
      ? make(
          "b",
          { className: "bad" },
          `✕ Entry ${broken} does not match the hash of the one before: the log was altered`,
        )
      : make("b", { className: "good" }, `✓ ${entries} entries, hash chain intact`),
    make("code", {}, newest),
  );
}

const sessions = document.querySelector("session-list");
const form = byId("add", HTMLFormElement);
fields(form).role.append(
  ...Object.entries(ROLES).map(([value, text]) => make("option", { value }, text)),
);
onSubmit(form, async (event) => {
  event.preventDefault();
  const { who, role, password } = fields(form);
  const fresh = { name: who.value, role: role.value, password: password.value };
  if (!(await attempt(byId("add-message"), () => withPassword(() => addPerson(fresh))))) return;
  form.reset();
  await reload();
});
byId("older").addEventListener("click", () => readLog(oldest));
sessions.source = { read: listSessions, end: endSession };
byId("without").hidden = (await attempt(byId("message"), readCurrentUser))?.login ?? true;
await reload();
await showTrustedKeys(() => readLog());
