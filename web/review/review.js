// The review page: loop closures by influence, each looked at, decided or registered again; the map
// is approved.

import { idHere } from "../shared/address.js";
import {
  alignPair,
  approveMap,
  decide,
  fitPoints,
  readEffect,
  readJournal,
  readPair,
  readProject,
  readQueue,
  readReview,
  readWalk,
  redoDecision,
  readCurrentUser,
  remakeMap,
  shareWork,
  undoDecision,
} from "../shared/api.js";
import { attempt, byId, detailOf, only, say, showError, succeeds, within } from "../shared/dom.js";
import { askForFrames, showKeys } from "./dialogs.js";
import { journalNews, showApproval, showEffect, showJournal, showPair } from "./panels.js";
import { keyOf } from "./captions.js";
import { Draft } from "./drafts.js";
import { PairLoader } from "./loader.js";
import { askToSign, shownMap } from "./signing.js";
import { ReviewState } from "./state.js";
import { Team } from "./team.js";
import { drawTools, goesOn, listenToActions } from "./tools.js";
import { watchProject } from "./watch.js";
import { withPassword } from "../account/recent_login.js";
import "../shared/map_verdict.js";
import "../shared/page_head.js";
import { t } from "../shared/texts.js";
import "./queue.js";
import "./view.js";

/** @import {Effect, NewDecision, ReviewView, StandingView} from "../shared/http_types" */

const id = idHere();
const queue = only("review-queue");
const view = only("pair-view");
const message = byId("message");
const state = new ReviewState();
const team = new Team(id, byId("team"), (kind, more) => share(kind, more));
const loader = new PairLoader(id);
const reason = new Draft(() => byId("decision").querySelector("input"));
const effects = { requested: 0, shown: 0 };
/**
 * The requests that change something, one after the other, and the row of the journal after the
 * last one of this page about each pair.
 */
const turns = {
  last: /** @type {Promise<unknown>} */ (Promise.resolve()),
  own: /** @type {Map<string, number>} */ (new Map()),
};

document.title = t("title-of", { project: id });

// -- the selected pair

async function select(/** @type {[number, number]} */ pair) {
  const selected = state.select(pair, queue.get(keyOf(pair)) ?? state.newRow(pair));
  drawSelected();
  reason.show(keyOf(pair));
  view.clear(t("reading-points"));
  say(message, "");
  try {
    const [facts, points] = await loader.load(pair, view.reach);
    if (state.selected !== selected) return;
    selected.facts = facts;
    const { odometry, predicted, upright } = facts;
    const drawn = view.set(points, { odometry, predicted, after: state.poseOf(selected) }, upright);
    drawSelected();
    drawn.then(() => {
      selected.drawn = true;
      if (state.selected === selected) drawSelected();
    });
    for (const next of queue.neighbors())
      loader.load([next.frame_i, next.frame_j], view.reach).catch(() => {});
  } catch (error) {
    if (state.selected !== selected) return;
    view.clear(t("no-points"));
    showError(message, error);
  }
}

/** What leads on while no pair is selected, as the name of a text. */
function firstStep() {
  if (!state.server) return message.textContent ? "nothing-to-review" : "sorting";
  if (queue.length) return "press-j";
  if (state.rows.length) return "no-pairs-listed";
  return state.graph ? "no-pairs" : "nothing-yet";
}

function drawSelected() {
  const { selected } = state;
  showPair(byId("pair"), selected ?? { hint: t(firstStep()) }, state.path_limit_m);
  const enabled = state.enabled(queue.length);
  drawTools(byId("decision"), queue.tools, actions, { enabled, refineText: state.refineText });
  byId("said").textContent = state.hint;
  team.show(selected && { pair: selected.pair, work: state.workOf(selected.pair) });
}

// -- decisions, sent in the order of the keys

/** Resolves to whether it was done; why not is on the page. */
function inTurn(/** @type {() => unknown} */ action) {
  const turn = turns.last.then(async () => {
    byId("news").textContent = "";
    const done = await succeeds(message, action);
    if (!done) update(await readReview(id).catch(() => null)); // others decided
    return done;
  });
  turns.last = turn;
  return turn;
}

function update(/** @type {ReviewView | null | undefined} */ server, mine = false) {
  if (!server) return;
  const before = state.server;
  const decided = state.activeDecision;
  for (const row of state.update(server)) queue.add(row);
  follow(decided, mine);
  if (state.refreshRows().length) queue.refresh();
  only("map-verdict").facts = server.map;
  showApproval(byId("signing"), server, { remake, approve });
  drawSelected();
  if (before?.seq !== server.seq) updateEffect();
  if (before && ((before.busy && !server.busy) || (!before.in_map && server.in_map)))
    updateHistory();
  if (byId("journal", HTMLDetailsElement).open) drawJournal();
}

/** The selected pair was decided: what others decided can be decided again; its pose is shown. */
function follow(/** @type {StandingView | undefined} */ before, /** @type {boolean} */ mine) {
  const { selected, activeDecision: now } = state;
  if (!selected || JSON.stringify(before) === JSON.stringify(now)) return;
  if (!mine) selected.decided = false;
  const shown = !selected.drawn || selected.moved || selected.found;
  if (!shown && String(before?.T_i_j) !== String(now?.T_i_j)) view.pose = state.poseOf(selected);
}

/** Another map was made: who judged the selected pair in it. */
async function updateHistory() {
  loader.clear();
  const { selected } = state;
  if (!selected?.facts) return;
  const facts = await readPair(id, selected.pair).catch(() => null);
  if (!facts || state.selected !== selected) return;
  selected.facts.history = facts.history;
  drawSelected();
}

/** Polls whether others decided, or a job made another map or another graph. */
function poll() {
  turns.last = turns.last.then(async () => {
    const before = state.server;
    const server = await readReview(id).catch(() => null); // the page head shows a lost link
    if (!server || state.server !== before || JSON.stringify(server) === JSON.stringify(before))
      return;
    if (!before || server.graph !== state.graph) {
      await attempt(message, begin);
      return;
    }
    update(server);
    const added = server.seq - before.seq;
    const [row] = added > 0 ? await readJournal(id).catch(() => []) : [];
    if (row) byId("news").textContent = journalNews(row, added);
  });
}

/** Decides about the selected pair; refused until its points were drawn. */
function send(/** @type {NewDecision["kind"]} */ kind, more = {}) {
  const { selected } = state;
  if (!selected || !state.server?.may_review) return undefined;
  const { pair, row, facts } = selected;
  const blocked =
    kind === "restore" ? !state.activeDecisionOf(pair) : !selected.drawn || selected.decided;
  if (blocked) return undefined;
  if (kind === "accept" && !state.isMeasured) {
    say(message, t("not-registered-yet"));
    return undefined;
  }
  const why = reason.take();
  const T_i_j = row.measured ? (facts?.measured ?? []) : [];
  const seen = state.server.seq;
  const body = { kind, frame_i: pair[0], frame_j: pair[1], T_i_j, why, ...more };
  selected.decided = kind !== "restore";
  const sent = inTurn(async () => {
    try {
      const seen_seq = Math.max(seen, turns.own.get(row.key) ?? 0); // this page knows its own
      const server = await decide(id, { ...body, seen_seq });
      turns.own.set(row.key, server.seq);
      update(server, true);
    } catch (error) {
      selected.decided = false;
      reason.giveBack(keyOf(pair), why);
      drawSelected();
      throw error;
    }
  });
  drawSelected();
  if (goesOn() && kind !== "restore") queue.step(1);
  return sent;
}

/**
 * Does something with the selected pair besides deciding about it.
 * @type {import("./team.js").Share}
 */
async function share(kind, more = {}) {
  const { selected } = state;
  if (!selected || !state.server?.may_review) return false;
  const [frame_i, frame_j] = selected.pair;
  const sent = inTurn(async () => update(await shareWork(id, { kind, frame_i, frame_j, ...more })));
  if (kind === "skip") queue.step(1);
  return sent;
}

function step(
  /** @type {(id: string, after_seq: number | undefined) => Promise<ReviewView>} */ through,
) {
  if (!state.server?.may_review) return;
  inTurn(async () => update(await through(id, state.server?.seq)));
}

/** Registers from the pose on the screen; once registered and not moved since, creates the edge. */
async function refine() {
  const { selected } = state;
  if (!selected?.drawn || selected.busy || !state.server?.may_review) return;
  if (selected.found?.measurement && !selected.moved) {
    const known = selected.row.kind !== "manual" && queue.get(selected.row.key);
    await send(known ? "replace" : "add", { measurement: selected.found.measurement });
    selected.found = null;
    if (state.selected === selected) drawSelected();
    return;
  }
  selected.busy = true;
  drawSelected();
  const found = await attempt(message, () => alignPair(id, selected.pair, view.pose));
  selected.busy = false;
  if (found && state.selected === selected) {
    Object.assign(selected, { found, moved: false, decided: false });
    view.pose = found.T_i_j;
  }
  if (state.selected === selected) drawSelected();
}

/** Drops the alignment that was made on this page. */
function drop() {
  const { selected } = state;
  if (!selected?.facts) return;
  if (view.isPicking) return view.stopPicking();
  Object.assign(selected, { found: null, moved: false });
  view.pose = state.poseOf(selected);
  drawSelected();
}

function pick() {
  const { selected } = state;
  if (!selected?.facts) return;
  view.pick(async ({ p_i, p_j }) => {
    const pose = await attempt(message, () => fitPoints(id, p_i, p_j));
    if (!pose || state.selected !== selected) return; // another pair was selected meanwhile
    view.pose = pose;
    selected.moved = true;
    drawSelected();
  });
}

async function addLoop() {
  const walk = await attempt(message, () => readWalk(id));
  if (walk) askForFrames(walk, state.selected?.pair, select);
}

// -- effect, journal, approval

/** @returns {Promise<void>} */
async function updateEffect() {
  const request = ++effects.requested;
  drawEffect();
  /** @type {Effect | null} */
  let effect = null;
  if (state.hasDecisions) {
    // What is said of a decision stays: that it was refused, and who decided meanwhile.
    const found = await readEffect(id).catch((error) => showError(message, error));
    if (request !== effects.requested || !found) return;
    // Decided meanwhile, or an earlier request came late.
    if ("superseded" in found) return updateEffect();
    effect = found;
  }
  state.setEffect(effect);
  effects.shown = request;
  if (state.refreshRows().length) queue.refresh();
  drawEffect();
  drawSelected();
}

const drawEffect = () =>
  showEffect(byId("effect"), state.effect, {
    working: effects.shown < effects.requested,
    choose: select,
  });

async function drawJournal() {
  const rows = await attempt(message, () => readJournal(id));
  if (rows) showJournal(within(byId("journal"), "ol"), rows);
}

async function remake(/** @type {HTMLElement} */ error) {
  await attempt(error, async () => {
    await remakeMap(id);
    update(await readReview(id));
  });
}

const signing = {
  shown: () => shownMap(state),
  read: async () => update(await readReview(id)),
  sign: async (/** @type {import("../shared/http_types").Approve} */ approval) =>
    update(await withPassword(() => approveMap(id, approval))),
};
const approve = () => askToSign(signing);

// -- buttons and keys

/** @type {import("./tools.js").Actions} */
const actions = {
  previous: () => queue.step(-1),
  next: () => queue.step(1),
  accept: () => send("accept"),
  reject: () => send("reject"),
  restore: () => send("restore"),
  skip: () => share("skip"),
  undo: () => step(undoDecision),
  redo: () => step(redoDecision),
  add: addLoop,
  keys: showKeys,
  refine,
  pick,
  drop,
};
const reasonField = () => within(byId("decision"), "input", HTMLInputElement);

queue.addEventListener("chosen", (event) => {
  const row = queue.get(detailOf(event));
  if (row) select([row.frame_i, row.frame_j]);
});
queue.addEventListener("filtered", () => {
  if (!state.selected && state.server) view.clear(t(firstStep()));
  drawSelected();
});
view.addEventListener("laid", () => {
  if (state.selected) state.selected.moved = true;
  drawSelected();
});
view.addEventListener("reach", () => state.selected && select(state.selected.pair));
byId("journal").addEventListener("toggle", drawJournal);

// -- begin

async function begin() {
  view.clear(t("sorting"));
  const server = await readReview(id);
  loader.clear();
  const empty = { rows: [], columns: [], began_ns: 0, limit_m: state.path_limit_m };
  state.reset(server, server.graph ? await readQueue(id) : empty);
  queue.rows = state.rows;
  view.clear(t(firstStep()));
  update(server);
}

async function beginTeam() {
  only("page-head").name = (await readProject(id)).name;
  queue.me = (await readCurrentUser()).name;
  await team.begin(state.server?.may_review ?? false);
}

drawSelected();
listenToActions(actions, view, reasonField(), () => Boolean(state.selected?.drawn));
await attempt(message, begin);
if (!state.server) {
  view.clear(t(firstStep()));
  drawSelected();
}
await beginTeam().catch((error) => message.textContent || showError(message, error));
watchProject(id, () => {
  poll();
  team.look();
});
