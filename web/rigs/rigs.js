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
import { attempt, byId, make } from "../shared/dom.js";
import { when } from "../shared/format.js";
import "../shared/page_head.js";
import { askDuplicate, askImport } from "./rig_dialogs.js";
import "./rig_form.js";
import { changesOf } from "./rig_math.js";
import { angleHint, numbersTable, useList, versionList } from "./rig_table.js";
import "./rig_view.js";

const CHECK_AFTER_MS = 250;
const drawing = document.querySelector("rig-view");
const form = document.querySelector("rig-form");
const dialog = byId("dialog", HTMLDialogElement);
const message = byId("message");
const file = byId("file", HTMLInputElement);
let elevations = {};
let models = [];
let rigs = [];
let rig = null; // the shown version
let before = null; // content of the version before it
let mayChange = false;
let checking = 0;
let asked = 0; // number of the newest check

function drawList() {
  const entry = (one) =>
    make(
      "li",
      {},
      make(
        "a",
        { href: rigUrl(one.id), ...(one.id === rig?.id ? { ariaCurrent: "page" } : {}) },
        make("b", {}, one.id),
        make("small", {}, one.shipped ? "comes with recon4" : `version ${one.version}`),
        make("small", {}, one.problem || one.sensors.join(", ")),
      ),
    );
  byId("list").replaceChildren(...rigs.map(entry));
}

function drawRig() {
  const { id, shipped, version, content, versions } = rig;
  document.title = `${id} · Rigs · recon4`;
  byId("title").textContent = content.name === id ? id : `${id}: ${content.name}`;
  const about = versions.find((one) => one.number === version);
  byId("facts").textContent = shipped
    ? "Comes with recon4. Duplicate it to change it."
    : [`Version ${version} of ${versions[0].number}`, about?.who, about?.when && when(about.when)]
        .filter(Boolean)
        .join(", ");
  form.hidden = true;
  byId("numbers").hidden = false;
  drawing.show(content, elevations, id);
  byId("numbers").replaceChildren(numbersTable(content));
  byId("hint").textContent = angleHint(content);
  drawActions();
  drawAbout();
}

function drawActions() {
  const button = (text, onclick, more = {}) =>
    make("button", { type: "button", onclick, ...more }, text);
  byId("actions").replaceChildren(
    ...(mayChange && !rig.shipped && form.hidden ? [button("Edit", edit)] : []),
    ...(mayChange && form.hidden
      ? [button("Duplicate…", () => askDuplicate(dialog, rig.id, leadTo))]
      : []),
    make(
      "a",
      { className: "button", href: rigFileUrl(rig.id, rig.version), download: "" },
      "Export TOML",
    ),
  );
}

function drawAbout() {
  const section = (title, ...content) => make("section", {}, make("h2", {}, title), ...content);
  const changes = before ? changesOf(before, rig.content) : [];
  const lines = changes.length ? changes : ["The same numbers"];
  byId("about").replaceChildren(
    ...(before
      ? [
          section(
            `Changed since version ${rig.version - 1}`,
            make("ul", { id: "changes" }, ...lines.map((text) => make("li", {}, text))),
          ),
        ]
      : []),
    ...(rig.shipped
      ? []
      : [section("Versions", versionList(rig.id, rig.versions, rig.version, show))]),
    section("Projects that used it", useList(rig.uses)),
  );
}

/** Shows a version of the rig of this page, the newest by default. */
async function show(version) {
  const id = chosen();
  const found = await attempt(message, () => readRig(id, version));
  if (!found) return;
  rig = found;
  const earlier = rig.version > 1 ? () => readRig(id, rig.version - 1) : () => null;
  before = (await attempt(message, earlier))?.content ?? null;
  drawRig();
  drawList();
}

/** The rig that the address names, else the first. */
function chosen() {
  return idHere() || rigs[0].id;
}

function edit() {
  form.edit(rig.content, models);
  form.hidden = false;
  byId("numbers").hidden = true;
  drawActions();
  check();
}

/** Asks the server what is wrong with the rig as it is in the form. */
async function check() {
  if (!form.isComplete) return;
  const number = ++asked;
  const found = await attempt(message, () => checkRig(form.content));
  if (found && number === asked) form.complain(found);
}

function onEdited() {
  drawing.show(form.content, elevations, rig.id);
  clearTimeout(checking);
  checking = setTimeout(check, CHECK_AFTER_MS);
}

async function save(note) {
  form.error = null;
  try {
    const version = { content: form.content, note, after: rig.versions[0].number };
    await addRigVersion(rig.id, version);
  } catch (error) {
    if (Object.keys(error.problems ?? {}).length)
      form.complain({ problems: error.problems, warnings: [] });
    form.error = error;
    return;
  }
  await reload();
}

const leadTo = (saved) => location.assign(rigUrl(saved.id));

async function reload() {
  rigs = (await attempt(message, listRigs)) ?? [];
  if (rigs.length) await show();
}

form.addEventListener("edited", onEdited);
form.addEventListener("saved", (event) => save(/** @type {CustomEvent} */ (event).detail));
form.addEventListener("cancelled", drawRig);
byId("import").addEventListener("click", () => file.click());
file.addEventListener("change", () => {
  const own = rigs.filter((one) => !one.shipped).map((one) => one.id);
  if (file.files.length) askImport(dialog, { file: file.files[0], own, done: leadTo });
  file.value = "";
});

const me = await attempt(message, readCurrentUser);
mayChange = me?.may.includes("process") ?? false;
byId("import").hidden = !mayChange;
models = (await attempt(message, listSensorModels)) ?? [];
elevations = Object.fromEntries(models.map((one) => [one.model, one.elevation_deg]));
models = models.map((one) => one.model);
await reload();
