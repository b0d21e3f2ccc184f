// <page-head>: the bar at the top of every page, with links to the other pages of a project.

import { at, pathHere } from "./address.js";
import {
  GUEST_ENDED,
  isGuest,
  liveUrl,
  mapUrl,
  projectUrl,
  readCapture,
  readCurrentUser,
  reportUrl,
  signOut,
} from "./api.js";
import { asError, html, nothing, render, targetOf, within } from "./dom.js";
import "./language_choice.js";
import { t } from "./texts.js";

/**
 * @import {Me, Permission} from "./http_types"
 * @typedef {object} HeadState
 * @property {string} name of the project; empty outside of one
 * @property {string} problem with the link to the server
 * @property {boolean} live whether there is a capture to look at
 * @property {Me | null} me
 * @property {boolean} open whether the menu is, where there is no room for its links
 */

/**
 * Links to pages, as these pages say: permission, path, text. The paths of pages of one project
 * begin at the project, without a slash.
 * @type {Array<[Permission, string, string]>}
 */
const LINKS = JSON.parse(document.getElementById("links")?.textContent ?? "[]");
/** Begins the name of a guest, as the server has it in every language. */
const GUEST_NAME = "guest: ";

export class PageHead extends HTMLElement {
  /** @type {HeadState} */
  #state = { name: "", problem: "", live: false, me: null, open: false };

  connectedCallback() {
    this.className = "bar";
    this.setAttribute("role", "banner");
    const { id } = placeOf(pathHere());
    this.#draw({ name: id });
    this.#closeAside();
    this.#greet().catch((error) => this.#draw({ problem: asError(error).message }));
  }

  async #greet() {
    const me = await readCurrentUser();
    if (isGuest(me)) return this.#draw({ me });
    const captures = me.may.includes("capture");
    this.#draw({ me, live: captures });
    if (!captures) this.#draw({ live: (await readCapture()) !== null });
  }

  /** A press elsewhere and Esc close the menu. */
  #closeAside() {
    addEventListener("pointerdown", (event) => {
      const inside = targetOf(event).closest?.(".menu, .account");
      if (!inside && this.#state.open) this.#draw({ open: false });
    });
    this.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.#state.open) return;
      event.stopPropagation();
      this.#draw({ open: false });
      within(this, ".menu").focus();
    });
  }

  /** The project's name. */
  set name(/** @type {string} */ name) {
    this.#draw({ name });
  }

  /** Shows whether the server answers. */
  set linked(/** @type {boolean} */ yes) {
    this.#draw({ problem: yes ? "" : t("head-lost") });
  }

  async #leave() {
    try {
      const { me } = this.#state;
      await signOut();
      location.assign(me && isGuest(me) ? GUEST_ENDED : at("/login"));
    } catch (error) {
      this.#draw({ problem: asError(error).message });
    }
  }

  #draw(/** @type {Partial<HeadState>} */ changes) {
    const { name, problem, me, live, open } = Object.assign(this.#state, changes);
    const { id, page } = placeOf(pathHere());
    const guest = me !== null && isGuest(me);
    render(
      html`<a class="brand" href=${guest ? mapUrl(id) : at("/")}>recon4</a>
        ${id ? [way(name, guest), tabs(id, page, pagesOf(id, me))] : nothing}
        <span class="link-state" role="status">${problem}</span>
        <button
          type="button"
          class="menu"
          aria-expanded=${String(open)}
          aria-controls="head-menu"
          @click=${() => this.#draw({ open: !open })}
        >
          ${t("head-menu")}
        </button>
        <span class=${open ? "account open" : "account"} id="head-menu"
          ><language-choice></language-choice
          >${me ? [guest ? nothing : links(me, live), this.#person(me)] : nothing}</span
        >`,
      this,
    );
  }

  #person(/** @type {Me} */ { name, role, login }) {
    if (!login) return nothing;
    return html`${
        role === "guest"
          ? html`<span class="who"
              >${t("role-guest")}: <b>${name.slice(GUEST_NAME.length)}</b></span
            >`
          : html`<a
              class="who"
              href=${at("/account")}
              aria-label=${t("head-account", { name, role: t(`role-${role}`) })}
              ><b>${name}</b> <span class="role">${t(`role-${role}`)}</span></a
            >`
      }<button type="button" @click=${() => this.#leave()}>${t("head-sign-out")}</button>`;
  }
}

/** The project that a path is about and its page there; empty if it is about none. */
function placeOf(/** @type {string} */ path) {
  const [, first, id = "", page = ""] = path.split("/");
  return first === "projects" ? { id: decodeURIComponent(id), page } : { id: "", page: "" };
}

/**
 * @param {string} name
 * @param {boolean} guest
 */
const way = (name, guest) =>
  guest
    ? html`<span class="way"><b>${name}</b></span>`
    : html`<nav aria-label=${t("head-where")} class="way">
        <a href=${at("/")}>${t("head-projects")}</a><span aria-hidden="true">/</span><b>${name}</b>
      </nav>`;

/**
 * The pages of a project that a person may open; guests, who have no page of its files, get the
 * report, too.
 * @param {string} id
 * @param {Me | null} me
 * @returns {Array<[string, string]>}
 */
function pagesOf(id, me) {
  /** @type {Array<[string, string]>} */
  const pages = LINKS.filter(([needs, path]) => !path.startsWith("/") && mayOpen(needs, me)).map(
    ([, path, text]) => [projectUrl(id) + path, text],
  );
  return me && isGuest(me) ? [...pages, [reportUrl(id), t("head-report")]] : pages;
}

/**
 * @param {Permission} needs
 * @param {Me | null} me null = not known yet
 */
const mayOpen = (needs, me) => me === null || me.may.includes(needs);

/**
 * @param {string} id
 * @param {string} page
 * @param {Array<[string, string]>} pages
 */
function tabs(id, page, pages) {
  const here = projectUrl(id) + (page && `${page}/`);
  return html`<nav aria-label=${t("head-pages")} class="tabs">
    ${pages.map(
      ([href, text]) =>
        html`<a href=${href} aria-current=${href === here ? "page" : nothing}>${text}</a>`,
    )}
  </nav>`;
}

/**
 * Links to what a person may open.
 * @param {Me} me
 * @param {boolean} live
 */
function links({ may }, live) {
  return LINKS.filter(([needs, path]) => path.startsWith("/") && may.includes(needs))
    .map(([, path, text]) => ({ href: at(path), text }))
    .filter(({ href }) => live || href !== liveUrl)
    .map(({ href, text }) => html`<a href=${href}>${text}</a>`);
}

customElements.define("page-head", PageHead);
