// Requests to the server: notes on a map, and saved views of it.

import { at } from "../address.js";
import { name, request } from "../http.js";

/** @import {NewMapView, NewNote, NoteChange} from "../http_types" */

export const readNotes = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/notes", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewNote} note
 */
export const addNote = (project_id, note) =>
  request("POST /api/projects/{project_id}/notes", { path: { project_id }, body: note });
/**
 * @param {string} project_id
 * @param {string} note_id
 * @param {NoteChange} change
 */
export const changeNote = (project_id, note_id, change) =>
  request("PATCH /api/projects/{project_id}/notes/{note_id}", {
    path: { project_id, note_id },
    body: change,
  });
/**
 * @param {string} project_id
 * @param {string} note_id
 */
export const removeNote = (project_id, note_id) =>
  request("DELETE /api/projects/{project_id}/notes/{note_id}", { path: { project_id, note_id } });
export const notesUrl = (/** @type {string} */ id) => at(`/api/projects/${name(id)}/notes.geojson`);

export const readMapViews = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/views", { path: { project_id } });
/**
 * @param {string} project_id
 * @param {NewMapView} view
 */
export const saveMapView = (project_id, view) =>
  request("POST /api/projects/{project_id}/views", { path: { project_id }, body: view });
/**
 * @param {string} project_id
 * @param {string} view_id
 */
export const removeMapView = (project_id, view_id) =>
  request("DELETE /api/projects/{project_id}/views/{view_id}", { path: { project_id, view_id } });
