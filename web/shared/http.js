// Requests to the server: a typed one for each operation, and tus for the bytes of uploads.

import { at, pathHere } from "./address.js";
import { t } from "./texts.js";

/** @import {Me} from "./http_types" */

export const NO_RESPONSE = t("no-response");

export class ApiError extends Error {
  /**
   * @param {number} status HTTP status, 0 if there was no response
   * @param {{error?: string, detail: string, problems?: Record<string, string>,
   *   candidates?: string[], remedy?: {text: string, page: string} | null}} problem
   */
  constructor(status, { error, detail, problems = {}, candidates = [], remedy = undefined }) {
    super(detail);
    this.name = error ?? "Invalid";
    this.status = status;
    this.problems = problems;
    this.candidates = candidates; // recordings in a folder that is none itself
    this.remedy = remedy; // the page where what the message advises is done
  }
}

/** @typedef {import("./http_types").Operations} Operations */
/**
 * What goes with a request, as far as the operation has it: path and query parameters, body.
 * @template {keyof Operations} K
 * @typedef {Omit<Operations[K], "response">} Parts
 */

/**
 * Requests an operation of the server and returns its record; every failure is an `ApiError`.
 * @template {keyof Operations} K
 * @param {K} operation
 * @param {{} extends Parts<K> ? [Parts<K>?] : [Parts<K>]} parts
 * @returns {Promise<Operations[K]["response"]>}
 */
export async function request(operation, ...parts) {
  const { path = {}, query = {}, body } = /** @type {any} */ (parts[0] ?? {});
  const [method, template] = operation.split(" ");
  const url = urlOf(template, path, query);
  /** @type {RequestInit & {headers: Record<string, string>}} */
  const options = { method, headers: await changeHeaders(method) };
  if (body !== undefined) {
    options.body = JSON.stringify(body);
    options.headers["Content-Type"] = "application/json";
  }
  let response;
  try {
    response = await fetch(url, options);
  } catch {
    throw new ApiError(0, {
      error: "Offline",
      detail: NO_RESPONSE,
    });
  }
  const json =
    response.status !== 204 && response.headers.get("Content-Type")?.startsWith("application/json");
  const content = json ? await response.json() : await response.text();
  if (response.ok) return content;
  const error = new ApiError(response.status, json ? content : { detail: content });
  if (error.name === "Unknown" && (await signedInAgain())) return request(operation, ...parts);
  if (error.name === "StaleToken") known.me = null;
  throw error;
}

export const name = encodeURIComponent;

/**
 * The URL of a path template, `{x}` filled from `path`; undefined parameters are left out.
 * @param {string} template
 * @param {Record<string, any>} path
 */
export function urlOf(template, path, query = {}) {
  const given = Object.entries(query).filter(([, value]) => value !== undefined);
  const search = given.map(([key, value]) => `${key}=${name(value)}`).join("&");
  const url = at(
    template.replace(/\{(\w+)\}/g, (/** @type {string} */ _, /** @type {string} */ key) =>
      name(path[key]),
    ),
  );
  return search ? `${url}?${search}` : url;
}

// -- who is signed in

/** What this page knows of the signed-in person; null = not requested yet. */
const known = {
  me: /** @type {Promise<import("./http_types").Me> | null} */ (null),
  asked: /** @type {Promise<boolean> | null} */ (null), // to sign in again
};

/** Who is signed in, requested once a page, or `again`. */
export const readCurrentUser = (again = false) =>
  again ? request("GET /api/me") : (known.me ??= request("GET /api/me"));

/** Whether somebody came by a guest link: many requests would be refused. */
export const isGuest = (/** @type {Me} */ { role }) => role === "guest";

/** Whether this browser is signed in already, not as a guest; for the login page. */
export async function isSignedIn() {
  const response = await fetch(at("/api/me"));
  return response.ok && !isGuest(await response.json());
}

export const LIVE_URL = at("/live");
/** Where a guest's visit ends. */
export const GUEST_ENDED = at("/guest?ended");
const BEFORE_LOGIN = [at("/login"), at("/pair"), at("/guest")];

/**
 * Headers of a request that changes something; exported for requests made elsewhere.
 * @returns {Promise<Record<string, string>>}
 */
export async function changeHeaders(method = "POST") {
  if (method === "GET" || BEFORE_LOGIN.includes(location.pathname)) return {};
  const { token } = await readCurrentUser();
  return token ? { "X-Recon4-Token": token } : {};
}

/** Whether one may go on: who was signed in does so on the page; others leave for the login. */
async function signedInAgain() {
  if (BEFORE_LOGIN.includes(location.pathname)) return false;
  const me = await known.me?.catch(() => null);
  const leave = (/** @type {string} */ address) => {
    location.assign(address);
    return false;
  };
  if (me && isGuest(me)) return leave(GUEST_ENDED); // a guest has no password
  // A phone may have no password; the pairing page offers both.
  if (location.pathname === LIVE_URL) return leave(at("/pair#again"));
  const login = at(`/login#next=${name(pathHere())}`);
  if (!me) return leave(login);
  known.asked ??= import("./login_again.js")
    .then(({ askLogin }) => askLogin(me.name))
    .catch(() => false) // the server has another version
    .then((again) => again || leave(login))
    .finally(() => (known.asked = null));
  return known.asked;
}

/** Keeps who is signed in from a response that contains it: the token has changed. */
export async function become(/** @type {Promise<Me>} */ response) {
  const me = await response;
  known.me = Promise.resolve(me);
  return me;
}

/** Asks for a file without reading it; an `ApiError` if the server refuses it. */
export async function canBeRead(/** @type {string} */ url) {
  const response = await responseOf(() => fetch(url));
  await response.body?.cancel();
}

/** Reads a binary response; an `ApiError` if the server refuses it. */
export const readBytes = async (/** @type {string} */ url) =>
  (await responseOf(() => fetch(url))).arrayBuffer();

/**
 * The response if the server does not refuse; asked for again when the person has signed in again.
 * @param {() => Promise<Response>} ask
 * @returns {Promise<Response>}
 */
async function responseOf(ask) {
  const response = await ask().catch((error) => {
    if (error.name === "AbortError") throw error;
    throw new ApiError(0, { error: "Offline", detail: NO_RESPONSE });
  });
  if (response.ok) return response;
  if (response.status === 401 && (await signedInAgain())) return responseOf(ask);
  throw await refusalOf(response);
}

/** The error of a response that is JSON, or the text of a proxy in between. */
async function refusalOf(/** @type {Response} */ response) {
  const text = await response.text();
  let problem = { detail: text || t("bad-response", { status: String(response.status) }) };
  try {
    problem = JSON.parse(text);
  } catch {
    // from a proxy in between, or the response to HEAD, which has no body
  }
  return new ApiError(response.status, problem);
}

// -- uploads

/**
 * Sends a request of tus 1.0, which is not JSON.
 * @param {string} method
 * @param {string} path
 * @param {RequestInit} options
 */
export const tus = (method, path, { headers = {}, body, signal } = {}) =>
  responseOf(async () => {
    /** @type {Record<string, any>} */
    const all = {
      "Tus-Resumable": "1.0.0",
      ...(method === "HEAD" ? {} : await changeHeaders(method)),
      ...headers,
    };
    return fetch(path, { method, headers: all, body, signal, cache: "no-store" });
  });
