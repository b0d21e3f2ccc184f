// The list of projects, with the jobs that run.

import {
  listProjects,
  listTrash,
  thumbnailUrl,
  projectUrl,
  readCurrentUser,
  readServer,
  removeProject,
  restoreProject,
  watchJobs,
} from "../shared/api.js";
import { approvalMark } from "../shared/approval_lines.js";
import { badge } from "../shared/badge.js";
import {
  attempt,
  byId,
  html,
  nothing,
  only,
  render,
  repeat,
  succeeds,
  within,
} from "../shared/dom.js";
import { stateOf, when } from "../shared/format.js";
import { headline } from "../shared/figures.js";
import "./job_status.js";
import "./new_job.js";
import "../shared/page_head.js";

/** @import {Deleted, JobView, ProjectCard} from "../shared/http_types" */

const MANY = 12;
const RELOAD_AFTER_MS = 100;

/** What the page shows. */
const state = {
  /** @type {ProjectCard[]} */
  projects: [],
  /** @type {Map<string, JobView>} */
  jobs: new Map(), // the newest job of each project
  reloads: false, // soon
  draws: false, // before the next frame
};

/**
 * The card of a project; undefined = there is only its first job so far.
 * @param {string} id
 * @param {ProjectCard | undefined} project
 */
function card(id, project) {
  const view = state.jobs.get(id);
  const open = view && view.job.state !== "succeeded";
  return html`<li class="card">
    <div class="facts">
      <a href=${projectUrl(id)} class="cover"
        >${thumbnail(project)}<strong>${project?.name ?? (view?.job.inputs.title || id)}</strong></a
      >
      ${open ? nothing : badge(stateOf(project, view))}
      ${project?.finished ? approvalMark(project.approval) : nothing}
      ${project && project.name !== id ? html`<p class="quiet">${id}</p>` : nothing}
      <p class="quiet">${factsOf(project, view)}</p>
      ${project?.problem ? html`<p class="error">Damaged: ${project.problem}</p>` : nothing}
    </div>
    ${open ? html`<job-status .view=${view}></job-status>` : nothing}
  </li>`;
}

const thumbnail = (/** @type {ProjectCard | undefined} */ project) =>
  project?.has_map
    ? html`<img
        src=${thumbnailUrl(project.id, project.updated)}
        alt=""
        loading="lazy"
        width="320"
        height="180"
      />`
    : html`<div class="no-thumbnail" aria-hidden="true">No map yet</div>`;

/**
 * In one line what is known of a project, or of the job that makes it.
 * @param {ProjectCard | undefined} project
 * @param {JobView | undefined} view
 */
function factsOf(project, view) {
  if (project) return [...headline(project), when(project.updated)].join(" · ");
  return (view?.job.inputs.recordings ?? []).map((path) => path.split("/").at(-1)).join(", ");
}

function draw() {
  state.draws = false;
  const { projects, jobs } = state;
  const known = new Set(projects.map((one) => one.id));
  const waiting = [...jobs].filter(([id, { job }]) => !known.has(id) && !job.finished);
  const wanted = byId("find", HTMLInputElement).value.trim().toLowerCase();
  const shown = projects.filter(({ name, id }) => `${name} ${id}`.toLowerCase().includes(wanted));
  /** @type {Array<[string, ProjectCard | undefined]>} */
  const cards = [
    ...waiting.map(([id]) => /** @type {[string, undefined]} */ ([id, undefined])),
    ...shown.map((project) => /** @type {[string, ProjectCard]} */ ([project.id, project])),
  ];
  render(
    repeat(
      cards,
      ([id]) => id,
      ([id, project]) => card(id, project),
    ),
    byId("projects"),
  );
  byId("empty").hidden = projects.length + waiting.length > 0;
  byId("none").hidden = waiting.length + shown.length > 0 || !wanted;
  within(document, "label.find").hidden = projects.length <= MANY;
}

/** Several jobs may change at once: they are drawn together. */
function drawSoon() {
  if (state.draws) return;
  state.draws = true;
  requestAnimationFrame(draw);
}

async function reload() {
  state.reloads = false;
  state.projects = (await attempt(byId("message"), listProjects)) ?? state.projects;
  draw();
}

/** Several jobs may change at once: one request is enough. */
function reloadSoon() {
  if (state.reloads) return;
  state.reloads = true;
  setTimeout(reload, RELOAD_AFTER_MS);
}

async function showTrash() {
  const message = byId("trash-message"); // reading the projects again clears the other one
  const deleted = (await attempt(message, listTrash)) ?? [];
  const act = (/** @type {() => unknown} */ action) => async () => {
    if (!(await succeeds(message, action))) return;
    await showTrash();
    reloadSoon();
  };
  const row = (/** @type {Deleted} */ { id, kind, project, goes }) =>
    html`<li>
      <div>
        <strong>${kind === "recording" ? `Recording ${project}` : project}</strong
        ><small> is deleted permanently on ${when(goes)}</small>
      </div>
      <button type="button" aria-label="Restore ${project}" @click=${act(() => restoreProject(id))}>
        Restore
      </button>
      <button
        type="button"
        aria-label="Delete ${project} permanently"
        @click=${act(() => removeProject(id))}
      >
        Delete now
      </button>
    </li>`;
  byId("trash").hidden = deleted.length === 0;
  render(
    repeat(deleted, (one) => one.id, row),
    within(byId("trash"), "ul"),
  );
}

async function begin() {
  const { may } = await readCurrentUser();
  const processes = may.includes("process");
  byId("new").hidden = byId("to-new").hidden = !processes;
  within(document, "main").classList.toggle("alone", !processes);
  const server = await attempt(byId("message"), readServer);
  render(
    (server?.notices ?? []).map((text) => html`<p class="notice">▲ ${text}</p>`),
    byId("notices"),
  );
  if (processes) await showTrash();
}

watchJobs(
  (view) => {
    const id = view.job.project;
    const before = state.jobs.get(id);
    state.jobs.set(id, view);
    if (before?.job.state !== view.job.state) reloadSoon();
    else drawSoon();
  },
  (linked) => {
    only("page-head").linked = linked;
  },
);
byId("find").addEventListener("input", draw);
begin();
reload();
