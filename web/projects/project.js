// One project: the map, the figures, the results, the job.

import { idHere } from "../shared/address.js";
import {
  ApiError,
  fileUrl,
  findingsUrl,
  listJobsOf,
  readProject,
  reportUrl,
  viewerUrl,
  watchJobs,
} from "../shared/api.js";
import { approvalLines, approvalMark } from "../shared/approval_lines.js";
import { badge } from "../shared/badge.js";
import { byId, fill, make, showError, targetOf } from "../shared/dom.js";
import { checked } from "../shared/download.js";
import { figures } from "../shared/figures.js";
import { bytes, seconds, stateOf, when } from "../shared/format.js";
import "./job_status.js";
import { FindingList } from "../shared/finding_list.js";
import { factsIn, firstText } from "../shared/verdict.js";
import "../shared/page_head.js";
import "./project_tools.js";
import "./rig_section.js";

const id = idHere();
const status = document.querySelector("job-status");
const log = document.querySelector("job-log");
const COMPARED_AGAIN_MS = 3000;
const STAGE_WORDS = { done: "✓ Done", reused: "✓ Reused", running: "▶ Running" };
let project = null;
let view = null;
let lacking = null;

function draw() {
  const name = project?.name ?? id;
  document.title = `${name} · recon4`;
  document.querySelector("page-head").name = name;
  byId("title").textContent = name;
  document.querySelector("project-tools").name = name;
  const facts = project
    ? [
        project.preset && `preset ${project.preset}`,
        project.rig && `rig ${project.rig}`,
        bytes(project.bytes),
        when(project.updated),
      ]
    : [];
  status.hidden = !view || view.job.state === "succeeded";
  fill(
    byId("state"),
    status.hidden ? badge(stateOf(project, view)) : null,
    project?.finished ? approvalMark(project.approval) : null,
    make("p", { className: "quiet" }, facts.filter(Boolean).join(" · ")),
  );
  if (view) status.view = view;
  drawMessage();
  drawFigures();
  drawFiles();
  drawStages();
  showMap();
}

function drawFigures() {
  const rows = figures(project?.summary ?? {});
  byId("figures").hidden = rows.length === 0;
  fill(
    byId("figures").querySelector("dl"),
    ...rows.map(([text, value]) => make("div", {}, make("dt", {}, text), make("dd", {}, value))),
  );
  const facts = factsIn(project?.summary);
  byId("verdict").hidden = !facts || firstText(facts) === "";
  if (facts) byId("reasons", FindingList).facts = facts;
}

function drawFiles() {
  const files = project?.files ?? [];
  byId("files").hidden = files.length === 0;
  const row = (file) => {
    const report = file.name === "report.html";
    const link = report
      ? make("a", { href: reportUrl(id), target: "_blank", rel: "noopener" }, file.label)
      : checked(make("a", { href: fileUrl(id, file.name), download: "" }, file.label), {
          message: byId("files-message"),
          status: byId("files-status"),
        });
    return make("li", {}, link, make("small", {}, `${file.name}, ${bytes(file.bytes)}`));
  };
  fill(byId("approval"), ...(project ? approvalLines(project.approval) : []));
  const found = project?.summary?.findings ? ["csv", "geojson"] : [];
  fill(byId("files").querySelector("ul"), ...files.map(row), ...found.map(findingsRow));
}

/** A download of the findings: a table, or for a GIS. */
const findingsRow = (ending) =>
  make(
    "li",
    {},
    make(
      "a",
      { href: findingsUrl(id, ending), download: "" },
      ending === "csv" ? "Findings, CSV" : "Findings, GeoJSON",
    ),
    make("small", {}, `findings.${ending}`),
  );

function drawStages() {
  const done = new Map((project?.stages ?? []).map((row) => [row.stage, row]));
  const live = view?.job.state === "running" ? view.status.stages : [];
  const rows = live.length
    ? live.map((row) => [
        row.stage,
        STAGE_WORDS[row.state] ?? row.state,
        row.seconds,
        done.get(row.stage)?.peak_bytes,
      ])
    : [...done.values()].map((row) => [row.stage, STAGE_WORDS.done, row.seconds, row.peak_bytes]);
  byId("stages").hidden = rows.length === 0;
  const cells = ([stage, state, time, memory]) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, stage),
      make("td", {}, state),
      make("td", { className: "number" }, typeof time === "number" ? seconds(time) : ""),
      make("td", { className: "number" }, memory ? bytes(memory) : ""),
    );
  fill(byId("stages").querySelector("tbody"), ...rows.map(cells));
}

function showMap() {
  const walking =
    view?.job.state === "running" && view.status.stages.some((row) => row.stage === "odometry");
  if (!(project?.viewable || walking) || byId("viewer").querySelector("iframe")) return;
  const viewer = make("iframe", { src: viewerUrl(id) + location.hash, title: "Map in 3-D" });
  // Keys work without a click first: the viewer takes them unless another control has the focus.
  const takeKeys = () => document.activeElement === document.body && viewer.focus();
  viewer.addEventListener("load", takeKeys);
  viewer.addEventListener("pointerenter", takeKeys);
  byId("viewer").replaceChildren(viewer);
}

/** Has the viewer fly to the stretch of the walk in the fragment of the address. */
function showStretch() {
  const viewer = byId("viewer").querySelector("iframe");
  if (!viewer || !location.hash) return;
  byId("viewer").scrollIntoView({ block: "nearest" });
  const { location: shown } = viewer.contentWindow; // viser adds a query to it
  shown.replace(shown.href.split("#")[0] + location.hash);
}

function drawLog() {
  if (view) log.job = view.job.id;
  log.read();
}

async function reload() {
  try {
    project = await readProject(id);
    lacking = null;
    if (project.approval.checking) setTimeout(reload, COMPARED_AGAIN_MS);
    document.querySelector("rig-section").reload();
  } catch (error) {
    lacking = error;
  }
  draw();
}

/** Shows why there is no project; before its job made a folder, that is expected. */
function drawMessage() {
  const expected = lacking instanceof ApiError && lacking.status === 404 && view;
  const damage = project?.problem ? `Damaged: ${project.problem}` : "";
  if (lacking && !expected) showError(byId("message"), lacking);
  else byId("message").textContent = damage;
}

function onJob(fresh) {
  if (fresh.job.project !== id) return;
  const before = view;
  view = fresh;
  const stagesDone = (one) => one?.status.stages.filter((row) => row.state !== "running").length;
  if (before?.job.state !== view.job.state || stagesDone(before) !== stagesDone(view)) reload();
  else draw();
  drawLog();
}

addEventListener("hashchange", showStretch);
byId("reasons").addEventListener("click", (event) => {
  const again = targetOf(event).closest("a.stretch");
  if (again && again.getAttribute("href").endsWith(location.hash)) showStretch();
});
document.querySelector("project-tools").addEventListener("renamed", (event) => {
  project = /** @type {CustomEvent} */ (event).detail;
  draw();
});
const receive = watchJobs(onJob, (linked) => {
  document.querySelector("page-head").linked = linked;
});

/** Finds the newest job, with its log, also when it succeeded: the stream sends only the others. */
async function findJob() {
  const [newest] = await listJobsOf(id);
  if (newest && !view) receive(newest);
}

reload();
findJob().catch((error) => {
  lacking ??= error;
  draw();
});
