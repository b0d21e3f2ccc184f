// The list of projects, with the jobs that run.

import { listProjects, pictureUrl, projectUrl, watchJobs } from "./api.js";
import { attempt, fill, make } from "./dom.js";
import { bytes, stateOf, when } from "./format.js";
import { headline } from "./figures.js";
import { badge } from "./job_status.js";
import "./new_job.js";
import "./page_head.js";

const byId = (id) => document.getElementById(id);
const cards = new Map();
const jobs = new Map();
let projects = [];

function card(id) {
  if (!cards.has(id)) {
    const facts = make("div", { className: "facts" });
    const status = make("job-status");
    cards.set(id, { root: make("li", { className: "card" }, facts, status), facts, status });
  }
  return cards.get(id);
}

function draw(id) {
  const project = projects.find((one) => one.id === id);
  const view = jobs.get(id);
  const { root, facts, status } = card(id);
  const open = view && view.job.state !== "succeeded";
  const picture = project?.pictured
    ? make("img", { src: pictureUrl(id, project.updated), alt: "", loading: "lazy", width: 320, height: 180 })
    : make("div", { className: "no-picture", ariaHidden: "true" }, "No map yet");
  const words = project
    ? [...headline(project.summary), bytes(project.bytes), when(project.updated)]
    : [view ? view.job.inputs.recordings.join(", ") : ""];
  fill(
    facts,
    make(
      "a", { href: projectUrl(id), className: "cover" },
      picture,
      make("strong", {}, project?.name ?? id),
    ),
    open ? null : badge(stateOf(project, view)),
    make("p", { className: "quiet" }, words.join(" · ")),
  );
  status.hidden = !open;
  if (view) status.view = view;
  return root;
}

function drawAll() {
  const waiting = [...jobs.keys()].filter((id) => !projects.some((one) => one.id === id) && !jobs.get(id).job.finished);
  const order = [...waiting, ...projects.map((one) => one.id)];
  const roots = order.map(draw);
  const list = byId("projects");
  if (roots.some((root, k) => list.children[k] !== root) || list.children.length !== roots.length) list.replaceChildren(...roots);
  byId("empty").hidden = order.length > 0;
}

async function reload() {
  projects = (await attempt(byId("message"), listProjects)) ?? projects;
  drawAll();
}

watchJobs(
  (view) => {
    const id = view.job.project;
    const before = jobs.get(id);
    jobs.set(id, view);
    if (before?.job.state !== view.job.state) reload();
    else draw(id);
  },
  (linked) => {
    document.querySelector("page-head").linked = linked;
  },
);
reload();
