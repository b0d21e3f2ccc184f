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
import { attempt, byId, fill, make, succeeds } from "../shared/dom.js";
import { stateOf, when } from "../shared/format.js";
import { headline } from "../shared/figures.js";
import "./job_status.js";
import "./new_job.js";
import "../shared/page_head.js";

const MANY = 12;
const cards = new Map();
const jobs = new Map();
let projects = [];
let asked = null;

function card(id) {
  if (!cards.has(id)) {
    const facts = make("div", { className: "facts" });
    const status = make("job-status");
    cards.set(id, { root: make("li", { className: "card" }, facts, status), facts, status });
  }
  return cards.get(id);
}

function draw(id, project = projects.find((one) => one.id === id)) {
  const view = jobs.get(id);
  const { root, facts, status } = card(id);
  const open = view && view.job.state !== "succeeded";
  const thumbnail = project?.has_map
    ? make("img", {
        src: thumbnailUrl(id, project.updated),
        alt: "",
        loading: "lazy",
        width: 320,
        height: 180,
      })
    : make("div", { className: "no-thumbnail", ariaHidden: "true" }, "No map yet");
  const text = project
    ? [...headline(project), when(project.updated)]
    : [view ? view.job.inputs.recordings.map((path) => path.split("/").at(-1)).join(", ") : ""];
  fill(
    facts,
    make(
      "a",
      { href: projectUrl(id), className: "cover" },
      thumbnail,
      make("strong", {}, project?.name ?? (view?.job.inputs.title || id)),
    ),
    open ? null : badge(stateOf(project, view)),
    project?.finished ? approvalMark(project.approval) : null,
    project && project.name !== id ? make("p", { className: "quiet" }, id) : null,
    make("p", { className: "quiet" }, text.join(" · ")),
    project?.problem ? make("p", { className: "error" }, `Damaged: ${project.problem}`) : null,
  );
  status.hidden = !open;
  if (view) status.view = view;
  return root;
}

function drawAll() {
  const known = new Set(projects.map((one) => one.id));
  const waiting = [...jobs.keys()].filter((id) => !known.has(id) && !jobs.get(id).job.finished);
  const wanted = byId("find", HTMLInputElement).value.trim().toLowerCase();
  const fits = (project) => `${project.name} ${project.id}`.toLowerCase().includes(wanted);
  const roots = [
    ...waiting.map((id) => draw(id)),
    ...projects.filter(fits).map((one) => draw(one.id, one)),
  ];
  const list = byId("projects");
  if (roots.some((root, k) => list.children[k] !== root) || list.children.length !== roots.length)
    list.replaceChildren(...roots);
  byId("empty").hidden = projects.length + waiting.length > 0;
  byId("none").hidden = roots.length > 0 || !wanted;
  byId("find").closest("label").hidden = projects.length <= MANY;
}

async function reload() {
  projects = (await attempt(byId("message"), listProjects)) ?? projects;
  drawAll();
}

/** Several jobs may change at once: one request is enough. */
function reloadSoon() {
  asked ??= setTimeout(() => {
    asked = null;
    reload();
  }, 100);
}

async function showTrash() {
  const message = byId("trash-message"); // reading the projects again clears the other one
  const deleted = (await attempt(message, listTrash)) ?? [];
  const act = (action) => async () => {
    if (!(await succeeds(message, action))) return;
    await showTrash();
    reloadSoon();
  };
  const row = ({ id, kind, project, goes }) =>
    make(
      "li",
      {},
      make(
        "div",
        {},
        make("strong", {}, kind === "recording" ? `Recording ${project}` : project),
        make("small", {}, ` is deleted permanently on ${when(goes)}`),
      ),
      make(
        "button",
        {
          type: "button",
          onclick: act(() => restoreProject(id)),
          ariaLabel: `Restore ${project}`,
        },
        "Restore",
      ),
      make(
        "button",
        {
          type: "button",
          onclick: act(() => removeProject(id)),
          ariaLabel: `Delete ${project} permanently`,
        },
        "Delete now",
      ),
    );
  byId("trash").hidden = deleted.length === 0;
  byId("trash")
    .querySelector("ul")
    .replaceChildren(...deleted.map(row));
}

async function begin() {
  const { may } = await readCurrentUser();
  const processes = may.includes("process");
  byId("new").hidden = byId("to-new").hidden = !processes;
  document.querySelector("main").classList.toggle("alone", !processes);
  const server = await attempt(byId("message"), readServer);
  byId("notices").replaceChildren(
    ...(server?.notices ?? []).map((text) => make("p", { className: "notice" }, `▲ ${text}`)),
  );
  if (processes) await showTrash();
}

watchJobs(
  (view) => {
    const id = view.job.project;
    const before = jobs.get(id);
    jobs.set(id, view);
    if (before?.job.state !== view.job.state) reloadSoon();
    else draw(id);
  },
  (linked) => {
    document.querySelector("page-head").linked = linked;
  },
);
byId("find").addEventListener("input", drawAll);
begin();
reload();
