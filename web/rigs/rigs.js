// The rig page: the list, one rig as a drawing and as numbers, its versions, editing.

import { idHere } from "../shared/address.js";
import {
  addRigVersion,
  checkRig,
  listRigs,
  listSensorModels,
  readCurrentUser,
  readRig,
  rigFileUrl,
  rigUrl,
} from "../shared/api.js";
import { asError, attempt, byId, detailOf, html, nothing, only, render } from "../shared/dom.js";
import { when } from "../shared/format.js";
import "../shared/page_head.js";
import { askDuplicate, askImport } from "./rig_dialogs.js";
import "./rig_form.js";
import { changesOf } from "./rig_math.js";
import { angleHint, numbersTable, useList, versionList } from "./rig_table.js";
import "./rig_view.js";
import { t } from "../shared/texts.js";

/**
 * @import {Content} from "../shared/dom.js"
 * @import {RigCard, RigView, SensorModel} from "../shared/http_types"
 * @import {Rig} from "./rig_math.js"
 * @typedef {RigView & {content: Rig}} ShownRig
 */

const CHECK_AFTER_MS = 250;
const drawing = only("rig-view");
const form = only("rig-form");
const message = byId("message");
const file = byId("file", HTMLInputElement);

/** What the page shows. */
const state = {
  /** @type {SensorModel[]} */
  models: [],
  /** @type {RigCard[]} */
  rigs: [],
  /** @type {ShownRig | null} */
  rig: null, // the shown version
  /** @type {Rig | null} */
  before: null, // content of the version before it
  mayChange: false,
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  check: undefined, // that waits
  checks: 0, // number of the newest check
};

const elevations = () =>
  Object.fromEntries(state.models.map((one) => [one.model, one.elevation_deg]));

function drawList() {
  const entry = (/** @type {RigCard} */ { id, shipped, version, problem, sensors }) =>
    html`<li>
      <a href=${rigUrl(id)} aria-current=${id === state.rig?.id ? "page" : nothing}
        ><b>${id}</b
        ><small
          >${shipped ? t("shipped-brief") : t("version-brief", { version: String(version) })}</small
        ><small>${problem || sensors.join(", ")}</small></a
      >
    </li>`;
  render(state.rigs.map(entry), byId("list"));
}

function drawRig() {
  const { rig } = state;
  if (!rig) return;
  const { id, shipped, version, content, versions } = rig;
  document.title = `${id} · ${t("rigs-page")}`;
  byId("title").textContent = content.name === id ? id : `${id}: ${content.name}`;
  const values = { version: String(version), newest: String(newestOf(rig)) };
  const about = versions.find((one) => one.number === version);
  byId("facts").textContent = shipped
    ? t("shipped")
    : [t("version-of", values), about?.who, about?.when && when(about.when)]
        .filter(Boolean)
        .join(", ");
  form.hidden = true;
  byId("numbers").hidden = false;
  drawing.show(content, elevations(), id);
  render(numbersTable(content), byId("numbers"));
  byId("hint").textContent = angleHint(content);
  drawActions(rig);
  drawAbout(rig);
}

const newestOf = (/** @type {RigView} */ { version, versions }) => versions[0]?.number ?? version;

function drawActions(/** @type {ShownRig} */ rig) {
  const { id, shipped, version } = rig;
  const changes = state.mayChange && form.hidden;
  render(
    html`${
        changes && !shipped
          ? html`<button type="button" @click=${() => edit(rig)}>${t("edit")}</button>`
          : nothing
      }
      ${
        changes
          ? html`<button type="button" @click=${() => askDuplicate(id, leadTo)}>
              ${t("duplicate-open")}
            </button>`
          : nothing
      } <a class="button" href=${rigFileUrl(id, version)} download>${t("export-toml")}</a>`,
    byId("actions"),
  );
}

/**
 * @param {string} title
 * @param {Content} content
 */
const section = (title, content) =>
  html`<section>
    <h2>${title}</h2>
    ${content}
  </section>`;

function drawAbout(/** @type {ShownRig} */ { id, shipped, version, versions, content, uses }) {
  const { before } = state;
  const changes = before ? changesOf(before, content) : [];
  const lines = changes.length ? changes : [t("same-numbers")];
  const list = html`<ul id="changes">
    ${lines.map((text) => html`<li>${text}</li>`)}
  </ul>`;
  render(
    [
      before ? section(t("changed-since", { version: String(version - 1) }), list) : nothing,
      shipped ? nothing : section(t("versions"), versionList(id, versions, version, show)),
      section(t("used-by-projects"), useList(uses)),
    ],
    byId("about"),
  );
}

/** Shows a version of the rig of this page, the newest by default. */
async function show(/** @type {number | undefined} */ version = undefined) {
  const id = chosen();
  const found = await attempt(message, () => readRig(id, version));
  if (!found) return;
  const rig = /** @type {ShownRig} */ (found);
  const earlier = () => (rig.version > 1 ? readRig(id, rig.version - 1) : null);
  const before = /** @type {ShownRig | null | undefined} */ (await attempt(message, earlier));
  Object.assign(state, { rig, before: before?.content ?? null });
  drawRig();
  drawList();
}

/** The rig that the address names, else the first. */
const chosen = () => idHere() || (state.rigs[0]?.id ?? "");

function edit(/** @type {ShownRig} */ rig) {
  form.edit(
    rig.content,
    state.models.map((one) => one.model),
  );
  form.hidden = false;
  byId("numbers").hidden = true;
  drawActions(rig);
  check();
}

/** Asks the server what is wrong with the rig as it is in the form. */
async function check() {
  if (!form.isComplete) return;
  const number = ++state.checks;
  const found = await attempt(message, () => checkRig(form.content));
  if (found && number === state.checks) form.complain(found);
}

function onEdited() {
  drawing.show(form.content, elevations(), state.rig?.id ?? "");
  clearTimeout(state.check);
  state.check = setTimeout(check, CHECK_AFTER_MS);
}

async function save(/** @type {string} */ note) {
  const { rig } = state;
  if (!rig) return;
  form.error = null;
  try {
    await addRigVersion(rig.id, { content: form.content, note, after: newestOf(rig) });
  } catch (error) {
    const { problems = {} } = asError(error);
    if (Object.keys(problems).length) form.complain({ problems, warnings: [] });
    form.error = error;
    return;
  }
  await reload();
}

const leadTo = (/** @type {{id: string}} */ saved) => location.assign(rigUrl(saved.id));

async function reload() {
  state.rigs = (await attempt(message, listRigs)) ?? [];
  if (state.rigs.length) await show();
}

form.addEventListener("edited", onEdited);
form.addEventListener("saved", (event) => save(detailOf(event)));
form.addEventListener("cancelled", drawRig);
byId("import").addEventListener("click", () => file.click());
file.addEventListener("change", () => {
  const own = state.rigs.filter((one) => !one.shipped).map((one) => one.id);
  if (file.files?.length) askImport([...file.files], own, leadTo);
  file.value = "";
});

const me = await attempt(message, readCurrentUser);
state.mayChange = me?.may.includes("process") ?? false;
byId("import").hidden = !state.mayChange;
state.models = (await attempt(message, listSensorModels)) ?? [];
await reload();
