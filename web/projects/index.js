// The list of projects, with the jobs that run.

import {
  firstProjects,
  listProjects,
  listSpaces,
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
  targetOf,
  within,
} from "../shared/dom.js";
import { stateOf, when } from "../shared/format.js";
import { headline } from "../shared/figures.js";
import "./job_status.js";
import "./new_job.js";
import { organize, spaceText } from "./organize.js";
import { ORDERS, chosen, searchOf, tagCounts, twinsOf, wantedIn } from "./project_list.js";
import "../shared/page_head.js";
import { t } from "../shared/texts.js";

/**
 * @import {Deleted, JobView, ProjectCard, ProjectSpace} from "../shared/http_types"
 * @import {Order} from "./project_list.js"
 */

const MANY = 3;
const STEP = 48; // cards that are drawn at a time: of a thousand, few are looked at
const RELOAD_AFTER_MS = 100;

/** What the page shows. */
const state = {
  /** @type {ProjectCard[]} */
  projects: [],
  /** @type {Map<string, JobView>} */
  jobs: new Map(), // the newest job of each project
  /** @type {Map<string, ProjectCard[]>} */
  twins: new Map(), // other projects of the same recording
  /** @type {Map<string, ProjectSpace>} */
  spaces: new Map(), // empty for those who may not free any
  wanted: wantedIn(location.search),
  most: STEP, // cards
  processes: false, // whether this person may organize
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
      ${project ? placeOf(project) : nothing}
      ${project?.problem ? html`<p class="error">${damageOf(project)}</p>` : nothing}
    </div>
    ${open ? html`<job-status .view=${view}></job-status>` : nothing}
  </li>`;
}

const damageOf = (/** @type {ProjectCard} */ { problem }) => t("damaged", { problem });

/** Tags, archive, space and other projects of the same recording. */
function placeOf(/** @type {ProjectCard} */ project) {
  const { id, name, tags, archived } = project;
  const space = state.spaces.get(id);
  const twins = state.twins.get(id);
  const others = (twins ?? []).map((one) => one.name).join(", ");
  return html`${
    tags.length || archived
      ? html`<p class="tags">
          ${archived ? html`<span class="tag">${t("archived")}</span>` : nothing}
          ${tags.map(
            (tag) =>
              html`<button type="button" class="tag" @click=${() => show(`tag:${tag}`)}>
                ${tag}
              </button>`,
          )}
        </p>`
      : nothing
  }
  ${twins ? html`<p class="quiet">${t("same-recording", { others })}</p>` : nothing}
  ${
    state.processes
      ? html`<p class="organizing">
          <span class="quiet">${space ? spaceText(space) : nothing}</span>
          <button
            type="button"
            aria-label=${t("organize-of", { name })}
            @click=${() => ask(project)}
          >
            ${t("organize")}
          </button>
        </p>`
      : nothing
  }`;
}

function ask(/** @type {ProjectCard} */ project) {
  const tags = tagCounts(state.projects).map(([tag]) => tag);
  organize(project, state.spaces.get(project.id), tags, () => Promise.all([reload(), weigh()]));
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
    : html`<div class="no-thumbnail" aria-hidden="true">${t("no-map-yet")}</div>`;

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
  const { projects, jobs, wanted, twins, spaces } = state;
  const known = new Set(projects.map((one) => one.id));
  const waiting = [...jobs].filter(([id, { job }]) => !known.has(id) && !job.finished);
  const found = chosen(projects, wanted, { twins, spaces });
  const shown = found.slice(0, state.most);
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
  byId("none").hidden = cards.length > 0 || !projects.length;
  byId("more").hidden = shown.length === found.length;
  byId("more").textContent = t("show-more", { count: String(found.length - shown.length) });
  drawTools();
}

function drawTools() {
  const { projects, wanted, twins } = state;
  const archived = projects.filter((one) => one.archived).length;
  const tags = tagCounts(projects);
  const asked = wanted.text || wanted.show || archived || tags.length || twins.size;
  byId("tools").hidden = projects.length <= MANY && !asked;
  /** @type {Array<[string, string]>} */
  const choices = [
    ["", t("show-all", { count: String(projects.length - archived) })],
    ...tags.map(([tag, n]) => /** @type {[string, string]} */ ([`tag:${tag}`, `${tag} (${n})`])),
    ["twins", t("show-twins", { count: String(twins.size) })],
    ["archived", t("show-archived", { count: String(archived) })],
  ];
  if (!choices.some(([value]) => value === wanted.show))
    choices.push([wanted.show, wanted.show.replace(/^tag:/, "")]);
  const option = (/** @type {[string, string]} */ [value, text], /** @type {string} */ now) =>
    html`<option value=${value} .selected=${value === now}>${text}</option>`;
  render(
    choices.map((one) => option(one, wanted.show)),
    byId("show"),
  );
  render(
    Object.entries(ORDERS).map((one) => option(one, wanted.order)),
    byId("order"),
  );
}

/** Draws what the tools ask for, from the top; the address of the page asks for the same. */
function want(/** @type {Partial<typeof state.wanted>} */ changes) {
  Object.assign(state.wanted, changes);
  state.most = STEP;
  history.replaceState(null, "", `${location.pathname}${searchOf(state.wanted)}`);
  draw();
}

const show = (/** @type {string} */ value) => want({ show: value });

function showMore() {
  state.most += STEP;
  draw();
}

/** Several jobs may change at once: they are drawn together. */
function drawSoon() {
  if (state.draws) return;
  state.draws = true;
  requestAnimationFrame(draw);
}

async function reload(read = listProjects) {
  state.reloads = false;
  state.projects = (await attempt(byId("message"), read)) ?? state.projects;
  state.twins = twinsOf(state.projects);
  draw();
}

/** Reads the sizes, which take longer than the list. */
async function weigh() {
  const spaces = await attempt(byId("message"), listSpaces);
  if (!spaces) return;
  state.spaces = new Map(spaces.map((one) => [one.id, one]));
  draw();
}

/** Several jobs may change at once: one request is enough. */
function reloadSoon() {
  if (state.reloads) return;
  state.reloads = true;
  setTimeout(() => reload(), RELOAD_AFTER_MS);
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
        <strong>${kind === "recording" ? t("trash-recording", { project }) : project}</strong
        ><small> ${t("trash-goes", { when: when(goes) })}</small>
      </div>
      <button
        type="button"
        aria-label=${t("restore-of", { project })}
        @click=${act(() => restoreProject(id))}
      >
        ${t("restore-it")}
      </button>
      <button
        type="button"
        aria-label=${t("delete-now-of", { project })}
        @click=${act(() => removeProject(id))}
      >
        ${t("delete-now")}
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
  const processes = (state.processes = may.includes("process"));
  byId("new").hidden = byId("to-new").hidden = !processes;
  within(document, "main").classList.toggle("alone", !processes);
  const server = await attempt(byId("message"), readServer);
  render(
    (server?.notices ?? []).map((text) => html`<p class="notice">▲ ${text}</p>`),
    byId("notices"),
  );
  if (!processes) return;
  await showTrash();
  await weigh();
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
byId("find", HTMLInputElement).value = state.wanted.text;
byId("find").addEventListener("input", (event) => want({ text: targetOf(event).value.trim() }));
byId("order").addEventListener("change", (event) =>
  want({ order: /** @type {Order} */ (targetOf(event).value) }),
);
byId("show").addEventListener("change", (event) => show(targetOf(event).value));
byId("tools").addEventListener("submit", (event) => event.preventDefault());
byId("more").addEventListener("click", showMore);
new IntersectionObserver(
  (entries) => entries.some((one) => one.isIntersecting) && showMore(),
  { rootMargin: "600px" }, // before a person sees the end
).observe(byId("more"));
reload(firstProjects);
begin();
