// Requests to the server: comparisons of a map with another one.

import { at } from "../address.js";
import { name, readBytes, request } from "../http.js";

/** @import {NewComparison} from "../http_types" */

export const listComparisons = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/comparisons", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewComparison} body
 */
export const orderComparison = (project_id, body) =>
  request("POST /api/projects/{project_id}/comparisons", { path: { project_id }, body });
/**
 * @param {string} project_id
 * @param {string} comparison_id
 */
export const cancelComparison = (project_id, comparison_id) =>
  request("POST /api/projects/{project_id}/comparisons/{comparison_id}/cancel", {
    path: { project_id, comparison_id },
  });

/**
 * @param {string} project_id
 * @param {string} comparison_id
 */
const made = (project_id, comparison_id) =>
  at(`/api/projects/${name(project_id)}/comparisons/${name(comparison_id)}`);

/**
 * The core points of a comparison, as the server describes them.
 * @param {string} project_id
 * @param {string} comparison_id
 */
export const readCorePoints = (project_id, comparison_id) =>
  readBytes(`${made(project_id, comparison_id)}/points`);
/**
 * Its core points as a file.
 * @param {string} project_id
 * @param {string} comparison_id
 */
export const comparisonUrl = (project_id, comparison_id) =>
  `${made(project_id, comparison_id)}/file`;
