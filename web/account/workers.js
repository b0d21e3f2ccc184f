// For admins: who makes parts of jobs, besides the threads of this computer.

import { chooseWorkers, readWorkers, testWorkers } from "../shared/api.js";
import { attempt, byId, fields, html, onSubmit, render, say } from "../shared/dom.js";
import { withPassword } from "./recent_login.js";
import { t } from "../shared/texts.js";

/** @import {WorkerChoiceView} from "../shared/http_types" */

/** Shows a choice in the form. */
function fill(/** @type {WorkerChoiceView} */ chosen) {
  const { count, scheduler, dashboard } = fields(byId("workers", HTMLFormElement));
  count.value = String(chosen.count);
  scheduler.value = chosen.scheduler;
  dashboard.value = chosen.dashboard;
  for (const field of [count, scheduler, dashboard]) field.disabled = false;
  const there = t(chosen.has_certificates ? "certificates-there" : "certificates-missing");
  render(html`${there} <code>${chosen.folder}</code>`, byId("workers-certificates"));
}

async function test() {
  const button = byId("test-workers", HTMLButtonElement);
  button.disabled = true;
  say(byId("workers-found"), t("workers-tested"));
  const found = await attempt(byId("workers-message"), testWorkers);
  button.disabled = false;
  say(byId("workers-found"), found ? `${found.ok ? "✓" : "✕"} ${found.text}` : "");
}

/** Fills the section; `onChange` is called after each change. */
export async function showWorkers(/** @type {() => void} */ onChange) {
  const form = byId("workers", HTMLFormElement);
  onSubmit(form, async (event) => {
    event.preventDefault();
    const { count, scheduler, dashboard } = fields(form);
    const choice = {
      count: Number(count.value),
      scheduler: scheduler.value.trim(),
      dashboard: dashboard.value.trim(),
    };
    const save = () => withPassword(() => chooseWorkers(choice));
    const chosen = await attempt(byId("workers-message"), save);
    if (!chosen) return;
    fill(chosen);
    say(byId("workers-found"), t("workers-saved"));
    onChange();
  });
  byId("test-workers").addEventListener("click", test);
  const chosen = await attempt(byId("workers-message"), readWorkers);
  if (chosen) fill(chosen);
}
