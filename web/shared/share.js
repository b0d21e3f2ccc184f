// The dialog "Share…": makes guest links to a project, lists and revokes them.

import { guestUrl, listGuestLinks, makeGuestLink, revokeGuestLink } from "./api.js";
import { closeButton, openDialog } from "./dialog.js";
import {
  asError,
  copied,
  fields,
  html,
  nothing,
  once,
  remedyLink,
  render,
  repeat,
  targetOf,
  within,
} from "./dom.js";
import { when } from "./format.js";
import { t } from "./texts.js";

/** @import {GuestLink} from "./http_types" */

const DAYS = [1, 7, 30, 90, 365];
const USUAL_DAYS = 30;

/**
 * Opens the dialog.
 * @param {string} id of the project
 * @param {() => string} query of the view that a new link shows first; "" = the whole map
 */
export async function openShare(id, query = () => "") {
  const state = {
    links: /** @type {GuestLink[] | null} */ (null),
    login: true,
    made: "", // address of the new link
    before: new Set(), // links that were there before it
    copied: false,
    problem: /** @type {unknown} */ (null),
  };
  const dialog = openDialog(t("share-title"), html`<div></div>`);
  dialog.classList.add("share");
  const place = within(dialog, "div");

  async function read() {
    const { login, links } = await listGuestLinks(id);
    Object.assign(state, { login, links });
  }

  async function attempt(/** @type {() => Promise<unknown>} */ action) {
    state.problem = null;
    try {
      await action();
      await read();
    } catch (error) {
      state.problem = error;
    }
    draw();
  }

  const make = once((/** @type {HTMLFormElement} */ form) =>
    attempt(async () => {
      const { label, days } = fields(form);
      const link = { label: label.value.trim(), days: Number(days.value) };
      const before = new Set(state.links?.map((one) => one.id));
      const { token } = await makeGuestLink(id, link);
      Object.assign(state, { made: guestUrl(token, query()), before, copied: false });
      form.reset();
    }),
  );

  /** Whether the new link has not been revoked. */
  const madeWorks = () =>
    state.made && state.links?.some((one) => one.works && !state.before.has(one.id));

  async function copy() {
    state.copied = await copied(state.made);
    if (!state.copied) within(dialog, ".made input", HTMLInputElement).select();
    draw();
  }

  function draw() {
    const { links, login, problem } = state;
    render(
      html`<p class="quiet">${t("share-what")}</p>
        ${login ? form() : html`<p>${t("share-no-login")}</p>`} ${madeWorks() ? made() : nothing}
        <p class="error" role="alert">${problem ? problemText(problem) : nothing}</p>
        <h3>${t("share-links", { open: openText(links) })}</h3>
        <ul class="links">
          ${repeat(links ?? [], (link) => link.id, row)}
        </ul>
        ${links?.length === 0 ? html`<p class="quiet">${t("share-none")}</p>` : nothing}
        <div class="buttons">${closeButton(t("close"))}</div>`,
      place,
    );
  }

  const form = () =>
    html`<form
      @submit=${(/** @type {SubmitEvent} */ event) => {
        event.preventDefault();
        make(/** @type {HTMLFormElement} */ (targetOf(event).closest("form")));
      }}
    >
      <label
        ><span>${t("share-for")}</span
        ><input
          name="label"
          maxlength="64"
          required
          autocomplete="off"
          placeholder=${t("share-client")}
      /></label>
      <label
        ><span>${t("share-works-for")}</span
        ><select name="days">
          ${DAYS.map(
            (days) =>
              html`<option value=${days} ?selected=${days === USUAL_DAYS}>
                ${t("share-days", { days })}
              </option>`,
          )}
        </select></label
      >
      <button class="primary">${t("share-make")}</button>
    </form>`;

  const made = () =>
    html`<div class="made" role="status">
      <label><span>${t("share-made")}</span><input readonly .value=${state.made} /></label>
      <button type="button" @click=${copy}>${state.copied ? t("copied") : t("copy")}</button>
    </div>`;

  const row = (/** @type {GuestLink} */ link) =>
    html`<li class=${link.works ? "" : "ended"}>
      <p><strong>${link.label}</strong> ${stateText(link)}</p>
      <p class="quiet">${historyText(link)}</p>
      ${
        link.works
          ? html`<button
              type="button"
              aria-label=${t("share-revoke-of", { whom: link.label })}
              @click=${() => attempt(() => revokeGuestLink(id, link.id))}
            >
              ${t("share-revoke")}
            </button>`
          : nothing
      }
    </li>`;

  draw();
  await attempt(async () => {});
}

function problemText(/** @type {unknown} */ problem) {
  const { message, remedy } = asError(problem);
  return html`${message}${remedy ? html` ${remedyLink(remedy)}` : nothing}`;
}

const at = (/** @type {number} */ seconds) => when(new Date(1000 * seconds).toISOString());

/** Whether a link works, and until when. */
function stateText(/** @type {GuestLink} */ { works, revoked_s, revoked_by, until_s }) {
  if (revoked_s) return t("share-revoked", { when: at(revoked_s), who: revoked_by });
  if (works) return t("share-works", { when: at(until_s) });
  if (1000 * until_s < Date.now()) return t("share-expired", { when: at(until_s) });
  return t("share-may-not");
}

const historyText = (/** @type {GuestLink} */ { by, created_s, opened, opened_s }) =>
  t("share-made-by", { who: by, when: at(created_s) }) +
  (opened_s ? t("share-opened", { opened, when: at(opened_s) }) : t("share-not-opened"));

/** How many links work. */
const openText = (/** @type {GuestLink[] | null} */ links) =>
  links ? String(links.filter(({ works }) => works).length) : "…";
