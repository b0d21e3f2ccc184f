// Addresses of this server. It may be at a path of its host (https://example.org/recon4/), so no
// other module writes an address that begins with a slash, or reads where it is from `location`.

/**
 * The path of a server from the address of this module: "/", or as "/recon4/". The key of the
 * content of all modules may stand before them.
 */
export const baseOf = (/** @type {string} */ module) =>
  new URL(/\/web\/[0-9a-f]{16}\/shared\/[^/]*$/.test(module) ? "../../../" : "../../", module)
    .pathname;

const BASE = baseOf(import.meta.url);

/** The address of a path of this server: at("/api/me"). */
export const at = (/** @type {string} */ path) => BASE + path.slice(1);

/** The path of this page as the server knows it: "/projects/office/". */
export const pathHere = () => `/${location.pathname.slice(BASE.length)}`;

/** The project or rig of this page: /projects/ID/…, /rigs/ID/; empty if it names none. */
export const idHere = () => decodeURIComponent(pathHere().split("/")[2] ?? "");

/** The whole address, to copy or to leave for: a path alone may name another host ("//…"). */
export const wholeUrl = (/** @type {string} */ path) => location.origin + at(path);

export const socketUrl = (/** @type {string} */ path) => wholeUrl(path).replace(/^http/, "ws");

/** The same path if it is one of this server, else that of the first page. */
export function pathInside(/** @type {string} */ path) {
  const url = new URL(path, location.origin);
  return path.startsWith("/") && url.origin === location.origin ? url.pathname : "/";
}

/** Takes the fragment, a one-time link, out of the address: it stays in no history. */
export const forgetFragment = () => history.replaceState(null, "", location.pathname);

// -- what this browser keeps: other servers of the host keep theirs in the same storage

const keyOf = (/** @type {string} */ name) => BASE.slice(1) + name;

export const kept = (/** @type {string} */ name) => localStorage.getItem(keyOf(name));
/**
 * @param {string} name
 * @param {string} text
 */
export const keep = (name, text) => localStorage.setItem(keyOf(name), text);

/** The state in which the map of a project was last left in this tab, as the query of its page. */
export const leftMap = (/** @type {string} */ id) =>
  sessionStorage.getItem(keyOf(`map ${id}`)) ?? "";
/**
 * @param {string} id
 * @param {string} query
 */
export const leaveMap = (id, query) => sessionStorage.setItem(keyOf(`map ${id}`), query);

const YEAR_S = 31_536_000;

/**
 * Keeps a choice where the server reads it with each page, too.
 * @param {string} name
 * @param {string} text
 */
export function keepForServer(name, text) {
  const safe = location.protocol === "https:" ? "; secure" : "";
  document.cookie = `${name}=${text}; path=${BASE}; max-age=${YEAR_S}; samesite=lax${safe}`;
}

const BY_VIEWER = "viser-user:"; // viser keeps what the viewer chose by names without our path

const BY_DOCS = `${BASE}docs/`; // the documentation keeps its colors by the whole path

/** Forgets all of it, for the next person at this browser. */
export function forgetKept() {
  const ours = Object.keys(localStorage).filter((key) =>
    [keyOf(""), BY_VIEWER, BY_DOCS].some((begin) => key.startsWith(begin)),
  );
  for (const key of ours) localStorage.removeItem(key);
}
