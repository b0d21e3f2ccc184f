// Requests to the server: projects, jobs and what takes space.

import { at } from "../address.js";
import { name, request } from "../http.js";

/** @import {Freeable, NewJob, ProjectCard, ProjectChanges} from "../http_types" */

const known = { first: /** @type {Promise<ProjectCard[]> | null} */ (null) };

export const listProjects = () => request("GET /api/projects");
/** The projects when this page was opened, requested once by all of its parts. */
export const firstProjects = () => (known.first ??= listProjects());
export const readProject = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}", { path: { project_id } });
export const readChoices = () => request("GET /api/choices");
export const browse = (/** @type {string} */ folder) =>
  request("GET /api/recordings", { query: { folder } });
export const addJob = (/** @type {NewJob} */ job) => request("POST /api/jobs", { body: job });
export const cancelJob = (/** @type {string} */ job_id) =>
  request("POST /api/jobs/{job_id}/cancel", { path: { job_id } });
export const retryJob = (/** @type {string} */ job_id) =>
  request("POST /api/jobs/{job_id}/retry", { path: { job_id } });
/**
 * @param {string} job_id
 * @param {number} offset
 */
export const readLog = (job_id, offset) =>
  request("GET /api/jobs/{job_id}/log/since", { path: { job_id }, query: { offset } });
export const logUrl = (/** @type {string} */ id) => at(`/api/jobs/${name(id)}/log/file`);
export const readJob = (/** @type {string} */ job_id) =>
  request("GET /api/jobs/{job_id}", { path: { job_id } });
export const listJobsOf = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/jobs", { path: { project_id } });
export const lookAt = (/** @type {string} */ path) => request("GET /api/look", { query: { path } });
export const readSettings = (/** @type {string} */ preset) =>
  request("GET /api/settings", { query: { of: preset } });
/**
 * @param {string} preset
 * @param {string[]} settings
 */
export const checkSettings = (preset, settings) =>
  request("POST /api/settings/check", { body: { preset, settings } });
/**
 * @param {string} project_id
 * @param {ProjectChanges} changes
 */
export const changeProject = (project_id, changes) =>
  request("PATCH /api/projects/{project_id}", { path: { project_id }, body: changes });
/**
 * @param {string} project_id
 * @param {string} title
 */
export const renameProject = (project_id, title) => changeProject(project_id, { name: title });
export const listSpaces = () => request("GET /api/storage/projects");
/**
 * @param {string} project_id
 * @param {Freeable[]} what
 */
export const freeSpace = (project_id, what) =>
  request("POST /api/projects/{project_id}/free", { path: { project_id }, body: { what } });
export const deleteProject = (/** @type {string} */ project_id) =>
  request("DELETE /api/projects/{project_id}", { path: { project_id } });
export const listTrash = () => request("GET /api/trash");
export const restoreProject = (/** @type {string} */ deleted_id) =>
  request("POST /api/trash/{deleted_id}/restore", { path: { deleted_id } });
export const removeProject = (/** @type {string} */ deleted_id) =>
  request("DELETE /api/trash/{deleted_id}", { path: { deleted_id } });
export const readStorage = () => request("GET /api/storage");
export const readProjectStorage = (/** @type {string} */ project_id) =>
  request("GET /api/projects/{project_id}/storage", { path: { project_id } });
export const deleteRecording = (/** @type {string} */ name) =>
  request("DELETE /api/recordings/{name}", { path: { name } });
export const readServer = () => request("GET /api/server");
export const readOpenApi = async () => (await fetch(at("/openapi.json"))).json();

// -- addresses

export const projectUrl = (/** @type {string} */ id) => at(`/projects/${name(id)}/`);
/**
 * The page of a project with a stretch of its walk shown in the viewer.
 * @param {string} id
 * @param {string} stretch
 */
export const stretchUrl = (id, stretch) => `${projectUrl(id)}#${stretch}`;
export const slicesUrl = (/** @type {string} */ id) => `${projectUrl(id)}slices/`;
/** What the code of a finding means. */
export const findingHelpUrl = (/** @type {string} */ kind) =>
  at(`/docs/reference/findings.html#${name(kind.toLowerCase())}`);
export const viewerUrl = (/** @type {string} */ id) => at(`/projects/${name(id)}/viewer/`);
export const reportUrl = (/** @type {string} */ id) => at(`/api/projects/${name(id)}/report`);
export const clientReportUrl = (/** @type {string} */ id) =>
  at(`/api/projects/${name(id)}/client.html`);
export const reportPdfUrl = (/** @type {string} */ id) =>
  at(`/api/projects/${name(id)}/report.pdf`);
/**
 * @param {string} id
 * @param {string} ending
 */
export const findingsUrl = (id, ending) => at(`/api/projects/${name(id)}/findings.${ending}`);
/**
 * @param {string} id
 * @param {string} version
 */
export const thumbnailUrl = (id, version) =>
  at(`/api/projects/${name(id)}/thumbnail?v=${name(version)}`);
/**
 * @param {string} id
 * @param {string} file
 */
export const fileUrl = (id, file) => at(`/api/projects/${name(id)}/files/${name(file)}`);
