// <class-corrections>: give the points in a volume another class: count, apply, undo.

import { USUAL, alikeFields, boxesOf, volumeOf } from "./alike.js";
import {
  correctClasses,
  countCorrection,
  findAlike,
  readCorrections,
  remakeMap,
  withdrawCorrection,
} from "./api.js";
import { classText } from "./class_words.js";
import { attempt, html, messagePlace, nothing, render, targetOf, within } from "./dom.js";
import { count, when } from "./format.js";
import { t } from "./texts.js";

/**
 * @import {CorrectionCount, CorrectionSpec, CorrectionView, CorrectionsView} from "./http_types"
 * @typedef {CorrectionSpec["volume"]} Volume
 * @typedef {object} Given what a page says of its map and of the chosen volume
 * @property {string} project
 * @property {string} map key of the map that is shown
 * @property {Volume | null} volume
 * @property {string} hint how to choose a volume
 * @property {number[] | null} [place] of a thing, to choose all like it [m]
 */

const DELIVERED = ""; // all points that the map delivers
const EVERY = "*"; // and those that it leaves out
export class ClassCorrections extends HTMLElement {
  #given = /** @type {Given | null} */ (null);
  #written = ""; // what was given last
  #view = /** @type {CorrectionsView | null} */ (null);
  #found = /** @type {import("./alike.js").Found | null} */ (null); // all things like one
  #counted = /** @type {CorrectionCount | null} */ (null);
  #choice = { to: "building", only: DELIVERED, why: "" };
  #busy = "";
  #remade = false;

  /** What is corrected; another map or volume forgets what was counted. */
  set given(/** @type {Given} */ given) {
    const written = JSON.stringify(given);
    if (written === this.#written) return;
    const isNew = given.map !== this.#given?.map;
    const isThing = String(given.place ?? "") !== String(this.#given?.place ?? "");
    Object.assign(this, { role: "group" });
    this.#given = given;
    this.#written = written;
    this.#counted = null;
    if (isNew || isThing) this.#found = null;
    this.#draw();
    if (isThing && given.place) this.#find();
    if (isNew) this.#work("", async () => this.#show(await readCorrections(given.project)));
  }

  #show(/** @type {CorrectionsView} */ view) {
    this.#view = view;
    this.#counted = null;
  }

  /**
   * @param {string} busy shown meanwhile
   * @param {() => Promise<unknown>} work
   */
  async #work(busy, work) {
    this.#busy = busy;
    this.#draw();
    await attempt(within(this, ".error"), work);
    this.#busy = "";
    this.#draw();
  }

  /** Of which classes the points are that get another one. */
  #only() {
    const { to, only } = this.#choice;
    const every = this.#view?.classes ?? [];
    return only === EVERY ? every.filter((one) => one !== to) : only ? [only] : [];
  }

  /** What is asked for; null = nothing is chosen. @returns {CorrectionSpec | null} */
  #spec() {
    const [given, found] = [this.#given, this.#found];
    const volume = found ? volumeOf(found) : (given?.volume ?? null);
    if (!given || !volume) return null;
    const only = found ? [found.view.only] : this.#only();
    return { volume, to: this.#choice.to, only, map: given.map };
  }

  /** Looks for all things like the picked one. */
  #find() {
    const given = this.#given;
    if (!given?.place) return;
    const [x, y, z] = given.place;
    const { to } = this.#choice;
    this.#work(t("alike-finding"), async () => {
      const spec = { place_m: /** @type {[number, number, number]} */ ([x, y, z]), to };
      const view = await findAlike(given.project, { ...spec, only: this.#only(), map: given.map });
      if (this.#given?.place === given.place && this.#choice.to === to)
        this.#mean({ view, limit: USUAL, off: new Set() });
    });
  }

  /** Other things are meant. */
  #mean(/** @type {import("./alike.js").Found | null} */ found) {
    this.#found = found;
    this.#counted = null;
    this.#draw();
    this.dispatchEvent(new CustomEvent("alike", { detail: boxesOf(found) }));
  }

  #count() {
    const [given, spec] = [this.#given, this.#spec()];
    if (!given || !spec) return;
    const asked = this.#written + JSON.stringify(spec);
    this.#work(t("correct-counting"), async () => {
      const counted = await countCorrection(given.project, spec);
      if (this.#written + JSON.stringify(this.#spec()) === asked) this.#counted = counted;
    });
  }

  #apply() {
    const [given, counted, spec] = [this.#given, this.#counted, this.#spec()];
    if (!given || !spec || !counted) return;
    const { why } = this.#choice;
    this.#work(t("correct-noting"), async () => {
      this.#show(await correctClasses(given.project, { ...spec, why, seen_seq: counted.seq }));
      this.#remade = false;
      this.#choice = { ...this.#choice, why: "" };
      this.dispatchEvent(new Event("applied"));
    });
  }

  #undo(/** @type {string} */ id) {
    const given = this.#given;
    if (!given) return;
    this.#work(t("correct-undoing"), async () => {
      this.#show(await withdrawCorrection(given.project, id));
      this.#remade = false;
    });
  }

  #remake() {
    const given = this.#given;
    if (!given) return;
    this.#work(t("correct-starting"), async () => {
      await remakeMap(given.project);
      this.#remade = true;
    });
  }

  #choose(/** @type {Partial<{to: string, only: string}>} */ next) {
    this.#choice = { ...this.#choice, ...next };
    this.#counted = null;
    this.#draw();
    const stays = !("only" in next) && this.#found && this.#found.view.only !== this.#choice.to;
    if (this.#given?.place && !stays) this.#find();
  }

  // -- what is drawn

  #draw() {
    const [given, view] = [this.#given, this.#view];
    render(
      html`${given && view ? this.#form(given, view) : nothing} ${messagePlace()}
        <p class="quiet" role="status">${this.#busy || this.#countText()}</p>
        ${view ? this.#list(view) : nothing}`,
      this,
    );
  }

  #form(/** @type {Given} */ { hint }, /** @type {CorrectionsView} */ view) {
    if (!view.may_correct) return html`<p class="quiet">${t("correct-who")}</p>`;
    const { to, only, why } = this.#choice;
    const idle = this.#busy === "";
    const found = this.#found;
    const volume = this.#spec() !== null;
    const able = this.#counted !== null && this.#counted.refused === "";
    const of = /** @type {Array<[string, string]>} */ ([
      [DELIVERED, t("correct-delivered")],
      [EVERY, t("correct-every")],
      ...view.classes.map((title) => [title, t("correct-only", { class: classText(title) })]),
    ]);
    return html`<div class="correction-fields">
        ${select(
          t("correct-new"),
          view.classes.map((title) => [title, classText(title)]),
          to,
          (value) => this.#choose({ to: value }),
        )}
        ${select(t("correct-of"), of, only, (value) => this.#choose({ only: value }))}
        <label
          ><span>${t("correct-why")}</span
          ><input
            maxlength="500"
            .value=${why}
            @input=${(/** @type {Event} */ event) => (this.#choice.why = targetOf(event).value)}
        /></label>
      </div>
      ${
        found
          ? alikeFields(found, {
              change: (next) => this.#mean({ ...found, ...next }),
              look: (p) => this.dispatchEvent(new CustomEvent("look", { detail: p })),
              forget: () => this.dispatchEvent(new Event("forget")),
            })
          : volume
            ? nothing
            : html`<p class="quiet">${hint}</p>`
      }
      <div class="buttons">
        <button type="button" ?disabled=${!volume || !idle} @click=${() => this.#count()}>
          ${t("correct-count")}
        </button>
        <button type="button" ?disabled=${!able || !idle} @click=${() => this.#apply()}>
          ${t("correct-apply")}
        </button>
      </div>`;
  }

  /** What was counted, in words. */
  #countText() {
    const counted = this.#counted;
    if (!counted) return "";
    if (counted.refused) return t("correct-nothing", { why: counted.refused });
    const now = Object.entries(counted.now).sort(([, a], [, b]) => b - a);
    const parts = now.map(([title, n]) => {
      const word = classText(title);
      return now.length > 1 ? `${word} ${count(n)}` : word;
    });
    return t("correct-counted", { points: counted.points, now: parts.join(", ") });
  }

  #list(/** @type {CorrectionsView} */ view) {
    const { corrections, withdrawn, may_correct, may_process } = view;
    const waiting = corrections.filter((one) => !one.in_map).length;
    const changed = waiting + withdrawn.length;
    const texts = [
      waiting ? t("correct-waiting", { count: String(waiting) }) : "",
      withdrawn.length ? t("correct-withdrawn", { count: String(withdrawn.length) }) : "",
    ].filter(Boolean);
    const row = (/** @type {CorrectionView} */ one) =>
      html`<li>
        <span
          ><b>${t("correct-row", { points: one.points, class: classText(one.to) })}</b>${
            one.only.length === 1
              ? html` (${t("correct-only", { class: classText(one.only[0]) })})`
              : nothing
          }${one.in_map ? nothing : html` <em>${t("correct-not-yet")}</em>`}<small
            >${one.who}, ${when(one.time)}${one.why ? `: ${one.why}` : ""}</small
          ></span
        >${
          may_correct
            ? html`<button
                type="button"
                aria-label=${t("correct-undo-of", {
                  class: classText(one.to),
                  who: one.who,
                  when: when(one.time),
                })}
                ?disabled=${this.#busy !== ""}
                @click=${() => this.#undo(one.id)}
              >
                ${t("correct-undo")}
              </button>`
            : nothing
        }
      </li>`;
    return html`${
      corrections.length
        ? html`<ol class="corrections">
            ${corrections.map(row)}
          </ol>`
        : nothing
    }
    ${
      this.#remade
        ? html`<p>${t("correct-remade")} <a href="../">${t("correct-progress")}</a>.</p>`
        : changed
          ? html`<p>${texts.join("; ")}.</p>
              ${
                may_process
                  ? html`<div class="buttons">
                      <button
                        type="button"
                        ?disabled=${this.#busy !== ""}
                        @click=${() => this.#remake()}
                      >
                        ${t("correct-remake")}
                      </button>
                    </div>`
                  : nothing
              }`
          : nothing
    }`;
  }
}

/**
 * @param {string} label
 * @param {Array<string[]>} options value and text
 * @param {string} chosen
 * @param {(value: string) => void} choose
 */
const select = (label, options, chosen, choose) =>
  html`<label
    ><span>${label}</span
    ><select @change=${(/** @type {Event} */ event) => choose(targetOf(event).value)}>
      ${options.map(
        ([value, text]) =>
          html`<option value=${value} ?selected=${value === chosen}>${text}</option>`,
      )}
    </select></label
  >`;

customElements.define("class-corrections", ClassCorrections);
