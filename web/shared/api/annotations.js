// Requests to the server: notes on a map, and saved views of it.

import { at } from "../address.js";
import { name, request } from "../http.js";

/** @import {NewMapView, NewNote, NoteChange, NotePhoto} from "../http_types" */

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
/**
 * @param {string} project_id
 * @param {string} note_id
 * @param {NotePhoto} photo
 */
export const setPhoto = (project_id, note_id, photo) =>
  request("PUT /api/projects/{project_id}/notes/{note_id}/photo", {
    path: { project_id, note_id },
    body: photo,
  });
/**
 * @param {string} project_id
 * @param {string} note_id
 * @param {number} revision
 */
export const removePhoto = (project_id, note_id, revision) =>
  request("DELETE /api/projects/{project_id}/notes/{note_id}/photo", {
    path: { project_id, note_id },
    query: { revision },
  });
/**
 * The address of a photo; another photo has another one.
 * @param {string} id
 * @param {{id: string, photo: string}} note
 */
export const photoUrl = (id, { id: note, photo }) =>
  at(`/api/projects/${name(id)}/notes/${name(note)}/photo?v=${photo.slice(0, 12)}`);
/**
 * The notes as a file.
 * @param {string} id
 * @param {"geojson" | "bcf"} ending
 */
export const notesUrl = (id, ending) => at(`/api/projects/${name(id)}/notes.${ending}`);

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
