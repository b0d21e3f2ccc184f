// The panel of several people who review one map: who has the selected pair, what they say of it,
// and who is looking now.

import { look, readComments, readReviewers } from "../shared/api.js";
import { html, nothing, render, targetOf } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { t } from "../shared/texts.js";
import { keyOf } from "./captions.js";
import { Draft } from "./drafts.js";
import { NO_WORK, agreementText, lookersText } from "./team_captions.js";

/**
 * @import {CommentView, LookerView, NewWork, WorkView} from "../shared/http_types"
 * @typedef {(kind: NewWork["kind"], more?: {why?: string, assignee?: string}) => Promise<boolean>}
 *   Share resolves to whether it was done
 * @typedef {object} Shown the selected pair for the panel
 * @property {[number, number]} pair
 * @property {WorkView | undefined} work
 */

const PAGE = Math.random().toString(36).slice(2, 12).padEnd(8, "0");

export class Team {
  #id;
  #panel;
  #share;
  #comment;
  #state = {
    may: false,
    people: /** @type {string[]} */ ([]), // who may review
    lookers: /** @type {LookerView[]} */ ([]),
    shown: /** @type {Shown | null} */ (null),
    comments: /** @type {CommentView[]} */ ([]),
    commentsOf: "", // the pair and how many it had
  };

  /**
   * @param {string} id of the project
   * @param {HTMLElement} panel
   * @param {Share} share does something with the selected pair; refusals are shown by the page
   */
  constructor(id, panel, share) {
    this.#id = id;
    this.#panel = panel;
    this.#share = share;
    this.#comment = new Draft(() => panel.querySelector("input"));
  }

  /** Reads to whom pairs can be assigned, if this person may. */
  async begin(/** @type {boolean} */ may) {
    this.#state.may = may;
    this.#state.people = may ? await readReviewers(this.#id) : [];
    this.#draw();
  }

  /** The selected pair has changed, or what people do with it. */
  show(/** @type {Shown | null} */ shown) {
    const before = pairKey(this.#state.shown);
    this.#state.shown = shown;
    const key = shown ? `${pairKey(shown)} ${shown.work?.comments ?? 0}` : "";
    if (before !== pairKey(shown)) {
      this.#state.comments = [];
      this.look();
    }
    if (key !== this.#state.commentsOf) {
      this.#state.commentsOf = key;
      if (shown?.work?.comments) this.#readComments(shown.pair, key);
    }
    this.#draw();
    this.#comment.show(pairKey(shown));
  }

  /** Says what this page shows, and learns who else is here. */
  async look() {
    const pair = this.#state.shown?.pair;
    const now = { page: PAGE, frame_i: pair?.[0] ?? null, frame_j: pair?.[1] ?? null };
    const lookers = await look(this.#id, now).catch(() => null); // the head shows a lost link
    if (!lookers) return;
    this.#state.lookers = lookers;
    this.#draw();
  }

  /**
   * @param {[number, number]} pair
   * @param {string} key
   */
  async #readComments(pair, key) {
    const comments = await readComments(this.#id, pair).catch(() => []);
    if (this.#state.commentsOf !== key) return;
    this.#state.comments = comments;
    this.#draw();
  }

  #draw() {
    const { shown, lookers } = this.#state;
    render(
      html`<h2>${t("team")}</h2>
        <p class="quiet" role="status">${lookersText(lookers, shown?.pair)}</p>
        ${shown ? this.#work(shown.work ?? NO_WORK) : nothing}`,
      this.#panel,
    );
  }

  #work(/** @type {Omit<WorkView, "frame_i" | "frame_j">} */ work) {
    const { may, comments } = this.#state;
    const agreement = agreementText(work);
    const question = work.second_by
      ? this.#button(t("withdraw-question"), () => this.#share("waive"))
      : this.#button(t("ask-second"), () => this.#share("second"));
    return html`${
      agreement
        ? html`<p class="agreement ${work.waits ? "waits" : work.agreement}">${agreement}</p>`
        : nothing
    }
    ${
      work.skipped_by
        ? html`<p class="quiet">${t("left-for-later", { who: work.skipped_by })}</p>`
        : nothing
    }
    ${may ? this.#assignment(work.assignee) : assigned(work.assignee)}
    ${
      may
        ? html`<div class="buttons">
            ${this.#button(t("skip-for-later"), () => this.#share("skip"))}${question}
          </div>`
        : nothing
    }
    ${
      comments.length
        ? html`<ol class="comments">
            ${comments.map(
              ({ who, time, text }) =>
                html`<li><b>${who}</b> <small>${when(time)}</small><q>${text}</q></li>`,
            )}
          </ol>`
        : nothing
    }
    ${may ? this.#commentForm() : nothing}`;
  }

  /**
   * @param {string} text
   * @param {() => unknown} action
   */
  #button(text, action) {
    return html`<button type="button" @click=${action}>${text}</button>`;
  }

  #assignment(/** @type {string} */ assignee) {
    const { people } = this.#state;
    const names = assignee && !people.includes(assignee) ? [...people, assignee] : people;
    const choose = async (/** @type {Event} */ event) => {
      const select = targetOf(event);
      const done = await this.#share("assign", { assignee: select.value });
      if (!done) select.value = assignee;
    };
    return html`<label
      ><span>${t("assigned-to")}</span
      ><select @change=${choose}>
        <option value="" .selected=${!assignee}>${t("nobody")}</option>
        ${names.map(
          (name) => html`<option value=${name} .selected=${name === assignee}>${name}</option>`,
        )}
      </select></label
    >`;
  }

  #commentForm() {
    const submit = async (/** @type {SubmitEvent} */ event) => {
      event.preventDefault();
      const pair = pairKey(this.#state.shown);
      const why = this.#comment.take();
      if (why && !(await this.#share("comment", { why }))) this.#comment.giveBack(pair, why);
    };
    return html`<form class="comment" @submit=${submit}>
      <label
        ><span>${t("comment")}</span><input maxlength="500" required autocomplete="off"
      /></label>
      <button>${t("do-comment")}</button>
    </form>`;
  }
}

const pairKey = (/** @type {Shown | null} */ shown) => (shown ? keyOf(shown.pair) : "");

const assigned = (/** @type {string} */ assignee) =>
  assignee ? html`<p class="quiet">${t("assigned-to-person", { who: assignee })}</p>` : nothing;
