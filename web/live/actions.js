// Buttons and dialogs of the operator's page: start, mark, pause, stop, make the map.

import { keep, kept } from "../shared/address.js";
import { projectUrl, readCaptureChoices, startCapture, steerCapture } from "../shared/api.js";
import { attempt, byId, fields, html, nothing, render, say, within } from "../shared/dom.js";
import { hasText, t } from "../shared/texts.js";
import { keptMarks, sendKept, sendOrKeep } from "./kept_marks.js";

/**
 * @import {NewCapture, RigChoice} from "../shared/http_types"
 * @import {Template} from "../shared/dom.js"
 * @import {Message} from "./messages"
 * @typedef {Record<string, HTMLInputElement>} Fields
 * @typedef {object} ActionState what the buttons depend on
 * @property {string} state of the capture
 * @property {string} project
 * @property {boolean | null} mayCapture null = not known yet
 * @property {boolean} linked
 * @property {() => Message["loop"]} loop
 */

const LAST = "recon4.live.last";
/** When the Mark button was pressed, and in which capture; the operator walks on while typing. */
const touched = { ms: 0, project: "" };

/**
 * A dialog with a form; it closes when `act(fields)` succeeds.
 * @param {string} id
 * @param {(given: Fields) => Promise<unknown>} act
 */
function dialog(id, act) {
  const element = byId(id, HTMLDialogElement);
  const form = formOf(id);
  const message = within(element, ".error");
  form.querySelector(".cancel")?.addEventListener("click", () => element.close());
  form.addEventListener("submit", async (event) => {
    const submitter = /** @type {HTMLButtonElement | null} */ (event.submitter);
    if (submitter?.value === "cancel") return;
    event.preventDefault();
    const text = submitter?.textContent ?? "";
    if (submitter) [submitter.disabled, submitter.textContent] = [true, t("one-moment")];
    const done = await attempt(message, () => act(fields(form)));
    if (submitter) [submitter.disabled, submitter.textContent] = [false, text];
    if (done !== undefined) element.close();
  });
  return () => {
    say(message, "");
    if (!element.open) element.showModal();
  };
}

const formOf = (/** @type {string} */ id) => within(byId(id), "form", HTMLFormElement);

const showStart = dialog("begin", ({ rig, preset, place }) => {
  keep(LAST, JSON.stringify({ rig: rig.value, preset: preset.value }));
  return startCapture({ rig: rig.value, preset: preset.value, place: place.value });
});
const showMark = dialog("note", ({ text }) => add("point", text.value, touched.ms));
const showName = dialog("naming", ({ text }) => add("place", text.value, Date.now()));
const showEnd = dialog("ending", () => steerCapture("stop"));

/**
 * The last choices on this phone.
 * @returns {Partial<Pick<NewCapture, "rig" | "preset">>}
 */
const lastChosen = () => JSON.parse(kept(LAST) ?? "{}");

/**
 * Fills a select and restores the last choice.
 * @param {HTMLInputElement} control
 * @param {Template[]} options
 * @param {string | undefined} last
 */
function offer(control, options, last) {
  render(options, control);
  const select = /** @type {HTMLSelectElement} */ (/** @type {unknown} */ (control));
  const usable = [...select.options].filter((option) => !option.disabled);
  select.value = (usable.find((option) => option.value === last) ?? usable[0])?.value ?? "";
}

async function begin() {
  const { rig, preset, place } = fields(formOf("begin"));
  const choices = await attempt(byId("message"), readCaptureChoices);
  if (!choices) return;
  const rigOption = (/** @type {RigChoice} */ { rig: value, name, sensors, problem }) =>
    html`<option value=${value} ?disabled=${problem !== ""}>
      ${name}: ${problem || sensors.join(", ")}
    </option>`;
  offer(rig, choices.rigs.map(rigOption), lastChosen().rig);
  offer(
    preset,
    choices.presets.map(
      (name) =>
        html`<option value=${name}>
          ${name}: ${hasText(`preset-${name}`) ? t(`preset-${name}`) : choices.preset_texts[name]}
        </option>`,
    ),
    lastChosen().preset,
  );
  const now = new Date(Date.now() - 60_000 * new Date().getTimezoneOffset()).toISOString();
  place.value = t("walk-name", { time: now.slice(0, 16).replace("T", " ") });
  showStart();
}

/**
 * Adds a mark, or keeps it until there is a link.
 * @param {"point" | "place"} what
 * @param {string} text
 * @param {number} at_ms
 */
async function add(what, text, at_ms) {
  const sent = await sendOrKeep({ project: touched.project, what, text, at_ms });
  if (!sent) say(byId("message"), t("marks-kept", { count: keptMarks().length }));
  return sent;
}

function sayWhatIsKept(/** @type {Awaited<ReturnType<typeof sendKept>>} */ { left, refused }) {
  const texts = refused.map(({ text }) => text || t("mark")).join(", ");
  if (refused.length) say(byId("message"), t("marks-refused", { count: refused.length, texts }));
  else if (!left) say(byId("message"), "");
}

export function mark() {
  if (!byId("note", HTMLDialogElement).open) touched.ms = Date.now();
  formOf("note").reset();
  showMark();
}

export const nameThePlace = () => (byId("more", HTMLDialogElement).close(), showName());

function stop(/** @type {string} */ text) {
  byId("ending-words").textContent = text;
  showEnd();
}

async function makeMap() {
  const view = await attempt(byId("message"), () => steerCapture("process"));
  if (view && "job" in view) location.assign(projectUrl(view.job.project));
}

/** Shows the buttons of a state; none to a user without the permission. */
export function drawActions(
  /** @type {ActionState} */ { state, project, mayCapture, linked, loop },
) {
  touched.project = project;
  const open = ["recording", "paused"].includes(state);
  if (linked && mayCapture && open && keptMarks().length) sendKept(project).then(sayWhatIsKept);
  const button = (
    /** @type {string} */ text,
    /** @type {string} */ className,
    /** @type {() => unknown} */ act,
    enabled = linked,
  ) =>
    html`<button type="button" class=${className} @click=${act} ?disabled=${!enabled}>
      ${text}
    </button>`;
  const steer = (/** @type {"pause" | "resume"} */ what) => () =>
    attempt(byId("message"), () => steerCapture(what));
  const atStart = () => t(loop()?.closed ? "loop-is-closed" : "loop-is-open");
  const end = button(t("stop"), "stop", () => stop(atStart()));
  /** @type {Record<string, () => Template>} */
  const rows = {
    none: () => html`${button(t("start"), "primary", begin)}`,
    recording: () =>
      html`${button(t("mark"), "", mark, true)}${button(t("pause"), "", steer("pause"))}${end}`,
    paused: () => html`${button(t("resume"), "primary", steer("resume"))}${end}`,
    ready: () =>
      html`<a class="button" href=${projectUrl(project)}>${t("project")}</a>
        ${button(t("make-map"), "primary", makeMap)}${button(t("new"), "", begin)}`,
  };
  render(mayCapture ? (rows[state]?.() ?? nothing) : nothing, byId("actions"));
}
