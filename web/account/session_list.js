// <session-list>: sessions with a button to end each.

import { attempt, make, succeeds } from "../shared/dom.js";
import { when } from "../shared/format.js";

const moment = (time_s) => when(new Date(time_s * 1000).toISOString());

/** The browser and system in a user agent, as far as people care. */
export function device(agent) {
  const browser = ["Edg", "Firefox", "Chrome", "Safari"].find((one) => agent.includes(`${one}/`));
  const system = ["Android", "iPhone", "iPad", "Windows", "Mac OS", "Linux"].find((one) =>
    agent.includes(one),
  );
  return browser && system
    ? `${browser === "Edg" ? "Edge" : browser} on ${system}`
    : agent.slice(0, 40) || "Unknown program";
}

export class SessionList extends HTMLElement {
  #source;
  #message = make("p", { className: "error", role: "alert" });
  #body = make("tbody");

  connectedCallback() {
    const titles = ["Person", "Device", "From", "Signed in", "Last seen", "Action"];
    const head = make("tr", {}, ...titles.map((text) => make("th", { scope: "col" }, text)));
    this.replaceChildren(
      this.#message,
      make("table", { className: "rows" }, make("thead", {}, head), this.#body),
    );
  }

  /** {read, end}: where the sessions come from, and how one is ended. */
  set source(source) {
    this.#source = source;
    this.reload();
  }

  async reload() {
    const views = await attempt(this.#message, this.#source.read);
    if (views) this.#body.replaceChildren(...views.map((view) => this.#row(view)));
  }

  #row({ session, current }) {
    const end = make(
      "button",
      {
        type: "button",
        ariaLabel: `End session of ${session.person}, ${device(session.agent)}`,
        onclick: () => this.#end(session.id),
      },
      "End",
    );
    return make(
      "tr",
      {},
      make("th", { scope: "row" }, session.person),
      make("td", { title: session.agent, "data-label": "Device" }, device(session.agent)),
      make("td", { "data-label": "From" }, session.address),
      make("td", { "data-label": "Signed in" }, make("time", {}, moment(session.began_s))),
      make("td", { "data-label": "Last seen" }, make("time", {}, moment(session.seen_s))),
      make(
        "td",
        {},
        make(
          "div",
          { className: "actions" },
          current ? make("span", { className: "here" }, "✓ This one") : end,
        ),
      ),
    );
  }

  async #end(id) {
    if (await succeeds(this.#message, () => this.#source.end(id))) await this.reload();
  }
}

customElements.define("session-list", SessionList);
