// <page-head>: the bar at the top of every page, with links to the other pages of a project.

import { at, pathHere } from "./address.js";
import { liveUrl, projectUrl, readCapture, readCurrentUser, signOut } from "./api.js";
import { make } from "./dom.js";

const PAGES = [
  ["", "Map"],
  ["review/", "Review"],
  ["slices/", "Slices"],
];

export class PageHead extends HTMLElement {
  #name = make("b");
  #link = make("span", { className: "link-state", role: "status" });
  #account = make("span", { className: "account" });

  connectedCallback() {
    const [, first, id, page = ""] = pathHere().split("/");
    const inProject = first === "projects" && id;
    this.className = "bar";
    this.setAttribute("role", "banner");
    this.replaceChildren(
      make("a", { className: "brand", href: at("/") }, "recon4"),
      ...(inProject ? [this.#way(), this.#tabs(decodeURIComponent(id), page)] : []),
      this.#link,
      this.#account,
    );
    if (inProject) this.name = decodeURIComponent(id);
    readCurrentUser().then(
      (me) => this.#greet(me),
      (error) => (this.#link.textContent = error.message),
    );
  }

  async #greet(me) {
    this.#show(me, me.may.includes("capture"));
    if (!me.may.includes("capture")) this.#show(me, (await readCapture()) !== null);
  }

  /** Who is signed in, and what only some may open. */
  #show({ name, role, may, login }, live) {
    const link = (href, text) => make("a", { href }, text);
    this.#account.replaceChildren(
      ...(live ? [link(liveUrl, "Live")] : []),
      link(at("/rigs"), "Rigs"),
      ...(may.includes("process")
        ? [link(at("/storage"), "Storage"), link(at("/api"), "API")]
        : []),
      link(at("/docs/"), "Help"),
      ...(may.includes("administer") ? [link(at("/people"), "People")] : []),
      ...(login
        ? [
            make(
              "a",
              { className: "who", href: at("/account"), ariaLabel: `Account of ${name}, ${role}` },
              make("b", {}, name),
              make("span", { className: "role" }, role),
            ),
            make("button", { type: "button", onclick: () => this.#leave() }, "Sign out"),
          ]
        : []),
    );
  }

  async #leave() {
    try {
      await signOut();
      location.assign(at("/login"));
    } catch (error) {
      this.#link.textContent = error.message;
    }
  }

  /** The project's name. */
  set name(text) {
    this.#name.textContent = text;
  }

  /** Shows whether the server answers. */
  set linked(yes) {
    this.#link.textContent = yes ? "" : "Connection lost, trying again";
  }

  #way() {
    return make(
      "nav",
      { ariaLabel: "Where you are", className: "way" },
      make("a", { href: at("/") }, "Projects"),
      make("span", { ariaHidden: "true" }, "/"),
      this.#name,
    );
  }

  #tabs(id, here) {
    const tab = ([path, text]) =>
      make(
        "a",
        {
          href: projectUrl(id) + path,
          ...(path === (here && `${here}/`) ? { ariaCurrent: "page" } : {}),
        },
        text,
      );
    return make("nav", { ariaLabel: "Pages of the project", className: "tabs" }, ...PAGES.map(tab));
  }
}

customElements.define("page-head", PageHead);
