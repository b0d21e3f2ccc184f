// Requests to the server: files that are made of a map.

import { at } from "../address.js";
import { name, request } from "../http.js";

/** @import {NewExport} from "../http_types" */

export const listExports = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/exports", { path: { project_id } });
export const readExportChoices = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/exports/choices", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewExport} body
 */
export const estimateExport = (project_id, body) =>
  request("POST /api/projects/{project_id}/exports/estimate", { path: { project_id }, body });
/**
 * @param {string} project_id
 * @param {NewExport} body
 */
export const orderExport = (project_id, body) =>
  request("POST /api/projects/{project_id}/exports", { path: { project_id }, body });
/**
 * @param {string} project_id
 * @param {string} export_id
 */
export const cancelExport = (project_id, export_id) =>
  request("POST /api/projects/{project_id}/exports/{export_id}/cancel", {
    path: { project_id, export_id },
  });
/**
 * @param {string} project_id
 * @param {string} export_id
 */
export const checkDelivery = (project_id, export_id) =>
  request("GET /api/projects/{project_id}/exports/{export_id}/check", {
    path: { project_id, export_id },
  });
/**
 * @param {string} project_id
 * @param {string} export_id
 */
export const removeExport = (project_id, export_id) =>
  request("DELETE /api/projects/{project_id}/exports/{export_id}/file", {
    path: { project_id, export_id },
  });
/**
 * @param {string} project_id
 * @param {string} export_id
 */
export const exportUrl = (project_id, export_id) =>
  at(`/api/projects/${name(project_id)}/exports/${name(export_id)}/file`);
