// Requests to the server: searches of a whole map for survey targets.

import { request } from "../http.js";

export const listSearches = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/slices/control/targets", { path: { project_id } });
export const orderSearch = (/** @type {string} */ project_id) =>
  request("POST /api/projects/{project_id}/slices/control/targets", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {string} search_id
 */
export const readSearch = (project_id, search_id) =>
  request("GET /api/projects/{project_id}/slices/control/targets/{search_id}", {
    path: { project_id, search_id },
  });
/**
 * @param {string} project_id
 * @param {string} search_id
 */
export const cancelSearch = (project_id, search_id) =>
  request("POST /api/projects/{project_id}/slices/control/targets/{search_id}/cancel", {
    path: { project_id, search_id },
  });
/**
 * @param {string} project_id
 * @param {string} search_id
 * @param {string} crs
 */
export const readFound = (project_id, search_id, crs) =>
  request("GET /api/projects/{project_id}/slices/control/targets/{search_id}/found", {
    path: { project_id, search_id },
    query: { crs },
  });
