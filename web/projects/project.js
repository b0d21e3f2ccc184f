// One project: the map, the figures, the results, the job.

import { idHere } from "../shared/address.js";
import {
  ApiError,
  fileUrl,
  findingsUrl,
  listJobsOf,
  mapUrl,
  readCurrentUser,
  readProject,
  clientReportUrl,
  reportPdfUrl,
  reportUrl,
  viewerUrl,
  watchJobs,
} from "../shared/api.js";
import { approvalLines, approvalMark } from "../shared/approval_lines.js";
import { badge } from "../shared/badge.js";
import {
  byId,
  detailOf,
  html,
  nothing,
  only,
  render,
  say,
  showError,
  targetOf,
  within,
} from "../shared/dom.js";
import { askFirst, askOnce } from "../shared/download.js";
import { figures } from "../shared/figures.js";
import { bytes, seconds, stateOf, when } from "../shared/format.js";
import "./job_status.js";
import "./job_workers.js";
import "./export_panel.js";
import { FindingList } from "../shared/finding_list.js";
import { t, wordOf } from "../shared/texts.js";
import { factsIn, firstText } from "../shared/verdict.js";
import "../shared/page_head.js";
import { openShare } from "../shared/share.js";
import "./project_storage.js";
import "./project_tools.js";
import "./rig_section.js";
import { stageText } from "./steps.js";

/** @import {JobView, ProjectView, ResultFile} from "../shared/http_types" */

const COMPARED_AGAIN_MS = 3000;
/** @type {Record<string, string>} */
const STAGE_WORDS = {
  done: `✓ ${t("stage-is-done")}`,
  reused: `✓ ${t("stage-is-reused")}`,
  running: `▶ ${t("state-running")}`,
};

/** What the page shows. */
const state = {
  id: idHere(),
  /** @type {ProjectView | null} */
  project: null,
  /** @type {JobView | null} */
  view: null, // the newest job
  lacking: /** @type {unknown} */ (null), // why there is no project
  mayShare: false,
  exportsOf: "", // when the map was made whose exports are shown
};

function draw() {
  const { id, project, view } = state;
  const name = project?.name || view?.job.inputs.title || id; // a waiting job has no project yet
  document.title = `${name} · recon4`;
  only("page-head").name = name;
  byId("title").textContent = name;
  only("project-tools").name = name;
  const open = view !== null && view.job.state !== "succeeded";
  render(
    html`${open ? nothing : badge(stateOf(project, view))}
      ${project?.finished ? approvalMark(project.approval) : nothing}
      <p class="quiet">${project ? factsOf(project) : nothing}</p>
      ${project?.stages.some(({ stage }) => stage === "map") ? mapLink(id) : nothing}`,
    byId("state"),
  );
  const status = only("job-status");
  status.hidden = !open;
  if (view) {
    status.view = view;
    only("job-workers").view = view;
  }
  drawMessage();
  drawFigures();
  drawFiles();
  drawStages();
  showMap();
}

/** The delivered points fill a page of their own; beside this text is the graph. */
const mapLink = (/** @type {string} */ id) =>
  html`<div class="buttons">
    <a class="button" href=${mapUrl(id)}>${t("open-map")}</a>${
      state.mayShare
        ? html`<button type="button" @click=${() => openShare(id)}>${t("share")}</button>`
        : nothing
    }
  </div>`;

const factsOf = (/** @type {ProjectView} */ { preset, rig, bytes: size, updated }) =>
  [
    preset && t("fact-preset", { preset }),
    rig && t("fact-rig", { rig }),
    bytes(size),
    when(updated),
  ]
    .filter(Boolean)
    .join(" · ");

function drawFigures() {
  const rows = figures(state.project?.summary ?? {});
  byId("figures").hidden = rows.length === 0;
  render(
    rows.map(
      ([text, value]) =>
        html`<div>
          <dt>${text}</dt>
          <dd>${value}</dd>
        </div>`,
    ),
    within(byId("figures"), "dl"),
  );
  const facts = factsIn(state.project?.summary);
  byId("verdict").hidden = !facts || firstText(facts) === "";
  if (facts) byId("reasons", FindingList).facts = facts;
}

function drawFiles() {
  const { project } = state;
  const files = project?.files ?? [];
  byId("files").hidden = files.length === 0;
  const mapped = project?.stages.some(({ stage }) => stage === "map") ?? false;
  showExports(mapped);
  render(project ? approvalLines(project.approval) : nothing, byId("approval"));
  const found = project?.summary.findings ? ["csv", "geojson"] : [];
  const reports = mapped ? [reportRow(), clientReportRow()] : nothing;
  const rows = [files.map(fileRow), reports, found.map(findingsRow)];
  render(rows, within(byId("files"), "ul"));
}

/** The panel of exports; it is read again when the map is another. */
function showExports(/** @type {boolean} */ mapped) {
  byId("export").hidden = !mapped;
  const made = mapped ? (state.project?.updated ?? "") : "";
  if (!made || made === state.exportsOf) return;
  state.exportsOf = made;
  only("export-panel").show();
}

const filePlaces = () => ({ message: byId("files-message"), status: byId("files-status") });

/** A result: the report opens beside the page, other files are downloads. */
function fileRow(/** @type {ResultFile} */ { name, label, bytes: size }) {
  const { id } = state;
  const link =
    name === "report.html"
      ? html`<a href=${reportUrl(id)} target="_blank" rel="noopener">${wordOf("result", label)}</a>`
      : html`<a href=${fileUrl(id, name)} download @click=${askFirst(filePlaces)}
          >${wordOf("result", label)}</a
        >`;
  return html`<li>${link}<small>${name}, ${bytes(size)}</small></li>`;
}

const reportPdfName = () => `${state.id}-report.pdf`;

/** The report for the client, made and signed when it is asked for. */
const reportRow = () =>
  html`<li>
    <a href=${reportPdfUrl(state.id)} download @click=${askOnce(filePlaces, reportPdfName)}
      >${t("report-pdf")}</a
    ><small>report.pdf</small>
  </li>`;

/** The same as a page. */
const clientReportRow = () =>
  html`<li>
    <a href=${clientReportUrl(state.id)} target="_blank" rel="noopener">${t("report-page")}</a>
  </li>`;

/** A download of the findings: a table, or for a GIS. */
const findingsRow = (/** @type {string} */ ending) =>
  html`<li>
    <a href=${findingsUrl(state.id, ending)} download
      >${t("findings-as", { format: ending === "csv" ? "CSV" : "GeoJSON" })}</a
    ><small>findings.${ending}</small>
  </li>`;

function drawStages() {
  const { project, view } = state;
  const done = new Map((project?.stages ?? []).map((row) => [row.stage, row]));
  const live = view?.job.state === "running" ? view.status.stages : [];
  const rows = live.length
    ? live.map((row) => ({
        stage: row.stage,
        state: STAGE_WORDS[row.state] ?? row.state,
        time_s: row.seconds,
        memory: done.get(row.stage)?.peak_bytes,
      }))
    : [...done.values()].map((row) => ({
        stage: row.stage,
        state: STAGE_WORDS.done,
        time_s: row.seconds,
        memory: row.peak_bytes,
      }));
  byId("stages").hidden = rows.length === 0;
  render(
    rows.map(
      ({ stage, state: word, time_s, memory }) =>
        html`<tr>
          <th scope="row">${stageText(stage)}</th>
          <td>${word}</td>
          <td class="number">${typeof time_s === "number" ? seconds(time_s) : nothing}</td>
          <td class="number">${memory ? bytes(memory) : nothing}</td>
        </tr>`,
    ),
    within(byId("stages"), "tbody"),
  );
}

function showMap() {
  const { id, project, view } = state;
  const walking =
    view?.job.state === "running" && view.status.stages.some((row) => row.stage === "odometry");
  const ended = Boolean(view?.job.finished);
  const empty = byId("viewer").querySelector(".empty");
  if (empty) empty.textContent = t(ended ? "nothing-was-made" : "nothing-to-show");
  if (!(project?.viewable || walking) || byId("viewer").querySelector("iframe")) return;
  const viewer = document.createElement("iframe");
  Object.assign(viewer, { src: viewerUrl(id) + location.hash, title: t("map-in-3d") });
  // Keys work without a click first: the viewer takes them unless another control has the focus.
  const takeKeys = () => document.activeElement === document.body && viewer.focus();
  viewer.addEventListener("load", takeKeys);
  viewer.addEventListener("pointerenter", takeKeys);
  byId("viewer").replaceChildren(viewer);
}

/** Has the viewer fly to the stretch of the walk in the fragment of the address. */
function showStretch() {
  const viewer = byId("viewer").querySelector("iframe");
  if (!viewer?.contentWindow || !location.hash) return;
  byId("viewer").scrollIntoView({ block: "nearest" });
  const shown = viewer.contentWindow.location;
  const loaded = shown.protocol !== "about:"; // before the first answer the frame has no address
  if (loaded)
    shown.replace(shown.href.split("#")[0] + location.hash); // viser adds a query to it
  else viewer.src = viewerUrl(state.id) + location.hash;
}

function drawLog() {
  const log = only("job-log");
  if (!state.view) return;
  log.job = state.view.job.id;
  log.read();
}

async function reload() {
  try {
    state.project = await readProject(state.id);
    state.lacking = null;
    if (state.project.approval.checking) setTimeout(reload, COMPARED_AGAIN_MS);
    only("rig-section").reload();
    only("project-storage").reload();
  } catch (error) {
    state.lacking = error;
  }
  draw();
}

/** Shows why there is no project; before its job made a folder, that is expected. */
function drawMessage() {
  const { lacking, view, project } = state;
  const expected = lacking instanceof ApiError && lacking.status === 404 && view;
  if (lacking && !expected) showError(byId("message"), lacking);
  else say(byId("message"), project?.problem ? t("damaged", { problem: project.problem }) : "");
}

function onJob(/** @type {JobView} */ fresh) {
  if (fresh.job.project !== state.id) return;
  const before = state.view;
  state.view = fresh;
  const stagesDone = (/** @type {JobView | null} */ one) =>
    one?.status.stages.filter((row) => row.state !== "running").length;
  if (before?.job.state !== fresh.job.state || stagesDone(before) !== stagesDone(fresh)) reload();
  else draw();
  drawLog();
}

addEventListener("hashchange", showStretch);
byId("reasons").addEventListener("click", (event) => {
  const again = targetOf(event).closest("a.stretch")?.getAttribute("href");
  if (again?.endsWith(location.hash)) showStretch();
});
only("project-storage").addEventListener("freed", reload);
only("project-tools").addEventListener("renamed", (event) => {
  state.project = detailOf(event);
  draw();
});
const receive = watchJobs(
  onJob,
  (linked) => {
    only("page-head").linked = linked;
    if (linked) only("export-panel").refresh();
  },
  (view) => only("export-panel").receive(view),
);

/** Finds the newest job, with its log, also when it succeeded: the stream sends only the others. */
async function findJob() {
  const [newest] = await listJobsOf(state.id);
  if (newest && !state.view) receive(newest);
}

readCurrentUser()
  .then(({ may }) => {
    state.mayShare = may.includes("share");
    draw();
  })
  .catch(() => {}); // the head of the page says what is wrong
reload();
findJob().catch((error) => {
  state.lacking ??= error;
  draw();
});
