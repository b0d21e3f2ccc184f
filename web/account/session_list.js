// <session-list>: sessions with a button to end each.

import { attempt, html, messagePlace, render, repeat, succeeds, within } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { t } from "../shared/texts.js";

/** @import {SessionView} from "../shared/http_types" */

const moment = (/** @type {number} */ time_s) => when(new Date(time_s * 1000).toISOString());

/** The browser and system in a user agent, as far as people care. */
export function device(/** @type {string} */ agent) {
  const browser = ["Edg", "Firefox", "Chrome", "Safari"].find((one) => agent.includes(`${one}/`));
  const system = ["Android", "iPhone", "iPad", "Windows", "Mac OS", "Linux"].find((one) =>
    agent.includes(one),
  );
  return browser && system
    ? t("device", { browser: browser === "Edg" ? "Edge" : browser, system })
    : agent.slice(0, 40) || t("device-unknown");
}

/** @typedef {{read: () => Promise<SessionView[]>, end: (id: string) => Promise<unknown>}} Source */

const TITLES = [
  t("person"),
  t("session-device"),
  t("from-address"),
  t("session-began"),
  t("session-seen"),
  t("action"),
];

export class SessionList extends HTMLElement {
  /** @type {Source | null} */
  #source = null;

  connectedCallback() {
    render(
      html`${messagePlace()}
        <table class="rows">
          <thead>
            <tr>
              ${TITLES.map((text) => html`<th scope="col">${text}</th>`)}
            </tr>
          </thead>
          <tbody></tbody>
        </table>`,
      this,
    );
  }

  get #message() {
    return within(this, ".error");
  }

  /** Where the sessions come from, and how one is ended. */
  set source(/** @type {Source} */ source) {
    this.#source = source;
    this.reload();
  }

  async reload() {
    const views = await attempt(this.#message, () => this.#source?.read());
    if (!views) return;
    render(
      repeat(
        views,
        ({ session }) => session.id,
        (view) => this.#row(view),
      ),
      within(this, "tbody"),
    );
  }

  /** What uses the session: a browser, or a program with a token. */
  #device(/** @type {SessionView["session"]} */ { access_token: label, agent, until_s }) {
    if (!label) return device(agent);
    return t("session-token", { label, when: until_s ? moment(until_s) : "" });
  }

  #row(/** @type {SessionView} */ { session, current }) {
    const end = html`<button
      type="button"
      aria-label=${t("session-end-of", { who: session.person, device: this.#device(session) })}
      @click=${() => this.#end(session.id)}
    >
      ${t("session-end")}
    </button>`;
    return html`<tr>
      <th scope="row">${session.person}</th>
      <td title=${session.agent} data-label=${t("session-device")}>${this.#device(session)}</td>
      <td data-label=${t("from-address")}>${session.address}</td>
      <td data-label=${t("session-began")}><time>${moment(session.began_s)}</time></td>
      <td data-label=${t("session-seen")}><time>${moment(session.seen_s)}</time></td>
      <td>
        <div class="actions">
          ${current ? html`<span class="here">✓ ${t("session-this")}</span>` : end}
        </div>
      </td>
    </tr>`;
  }

  async #end(/** @type {string} */ id) {
    if (await succeeds(this.#message, () => this.#source?.end(id))) await this.reload();
  }
}

customElements.define("session-list", SessionList);
