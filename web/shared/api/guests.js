// Requests to the server: guest links to a project.

import { wholeUrl } from "../address.js";
import { request } from "../http.js";

/** @import {NewGuestLink} from "../http_types" */

export const listGuestLinks = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/guests", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewGuestLink} link
 */
export const makeGuestLink = (project_id, link) =>
  request("POST /api/projects/{project_id}/guests", { path: { project_id }, body: link });
/**
 * @param {string} project_id
 * @param {string} link_id
 */
export const revokeGuestLink = (project_id, link_id) =>
  request("DELETE /api/projects/{project_id}/guests/{link_id}", { path: { project_id, link_id } });
export const openGuestLink = (/** @type {string} */ token) =>
  request("POST /api/guests/open", { body: { token } });
/**
 * The address to give away, with the view that it shows first; the token is in the fragment, which
 * browsers send nowhere.
 * @param {string} token
 * @param {string} query
 */
export const guestUrl = (token, query) => `${wholeUrl("/guest")}#${token}${query && `?${query}`}`;
