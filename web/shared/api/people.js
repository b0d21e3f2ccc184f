// Requests to the server: people, sessions and trusted keys.

import { forgetKept } from "../address.js";
import { become, request } from "../http.js";

/** @import {Changes, NewAccessToken, NewKey, NewPerson, NewWebhook} from "../http_types" */
/** @import {WorkerChoice} from "../http_types" */

/**
 * @param {string} who
 * @param {string} password
 */
export const signIn = (who, password) =>
  become(request("POST /api/login", { body: { name: who, password } }));
/**
 * @param {string} token
 * @param {string} who
 * @param {string} password
 */
export const setUp = (token, who, password) =>
  become(request("POST /api/setup", { body: { token, name: who, password } }));
export const signInAgain = (/** @type {string} */ password) =>
  become(request("POST /api/login/again", { body: { password } }));
export async function signOut() {
  await request("POST /api/logout");
  forgetKept();
}
/**
 * @param {string} old
 * @param {string} fresh
 */
export const changePassword = (old, fresh) =>
  become(request("POST /api/me/password", { body: { old, new: fresh } }));
export const listMySessions = () => request("GET /api/me/sessions");
export const endMySession = (/** @type {string} */ session_id) =>
  request("DELETE /api/me/sessions/{session_id}", { path: { session_id } });
export const makeAccessToken = (/** @type {NewAccessToken} */ token) =>
  request("POST /api/me/tokens", { body: token });
export const listPeople = () => request("GET /api/people");
export const addPerson = (/** @type {NewPerson} */ person) =>
  request("POST /api/people", { body: person });
/**
 * @param {string} who
 * @param {Changes} changes
 */
export const changePerson = (who, changes) =>
  request("PATCH /api/people/{name}", { path: { name: who }, body: changes });
export const listSessions = () => request("GET /api/sessions");
export const endSession = (/** @type {string} */ session_id) =>
  request("DELETE /api/sessions/{session_id}", { path: { session_id } });
export const readAudit = (/** @type {number | undefined} */ before) =>
  request("GET /api/audit", { query: { most: 25, before } });
export const listTrustedKeys = () => request("GET /api/keys");
export const addTrustedKey = (/** @type {NewKey} */ key) =>
  request("POST /api/keys", { body: key });
export const removeTrustedKey = (/** @type {string} */ fingerprint) =>
  request("DELETE /api/keys/{fingerprint}", { path: { fingerprint } });
export const readWorkers = () => request("GET /api/workers");
export const chooseWorkers = (/** @type {WorkerChoice} */ choice) =>
  request("PUT /api/workers", { body: choice });
export const testWorkers = () => request("POST /api/workers/test");
export const listWebhooks = () => request("GET /api/webhooks");
export const addWebhook = (/** @type {NewWebhook} */ webhook) =>
  request("POST /api/webhooks", { body: webhook });
export const removeWebhook = (/** @type {string} */ webhook_id) =>
  request("DELETE /api/webhooks/{webhook_id}", { path: { webhook_id } });
export const testWebhook = (/** @type {string} */ webhook_id) =>
  request("POST /api/webhooks/{webhook_id}/test", { path: { webhook_id } });
