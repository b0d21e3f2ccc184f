// The review: loops by influence, each looked at, decided, measured anew; the map approved.

import {
  alignPair,
  approveMap,
  decide,
  fitPoints,
  readEffect,
  readJournal,
  readPair,
  readPoints,
  readQueue,
  readReview,
  readWalk,
  remakeMap,
  undoDecision,
  redoDecision,
  watchJobs,
} from "../shared/api.js";
import { attempt, byId, make } from "../shared/dom.js";
import { apart } from "./math.js";
import { askForMoments, askToSign, showKeys } from "./dialogs.js";
import { listenToKeys } from "./keys.js";
import { journalWords, showEffect, showJournal, showPair, showSigning } from "./panels.js";
import { keyOf, length } from "./captions.js";
import { withPassword } from "../account/recent_login.js";
import "../shared/page_head.js";
import "./queue.js";
import "./view.js";

const id = decodeURIComponent(location.pathname.split("/")[2]);
const queue = document.querySelector("review-queue");
const view = document.querySelector("pair-view");
const message = byId("message");
const loaded = new Map();
let state = null;
let effect = null;
let effectAsked = 0;
let effectShown = 0;
let hand = null; // the pair in hand: {pair, row, facts, found, moved, busy, drawn, decided}
let last = Promise.resolve();
let limit_m = 0.1;
let graph = ""; // the queue is made of this one

const GO_ON = "recon4-review-go-on"; // whether this browser goes on after a decision
const EVERY_MS = 4000; // others decide too, in other browsers or by another server

document.title = `Review of ${id} · recon4`;

// -- one pair

async function fetched(pair) {
  const key = `${keyOf(pair)} ${view.reach}`;
  if (!loaded.has(key)) {
    loaded.set(key, Promise.all([readPair(id, pair), readPoints(id, pair, view.reach)]));
    if (loaded.size > 8) loaded.delete(loaded.keys().next().value);
  }
  return loaded.get(key).catch((error) => {
    loaded.delete(key);
    throw error;
  });
}

async function take(pair) {
  const row = queue.get(keyOf(pair)) ?? newRow(pair);
  hand = {
    pair,
    row,
    facts: null,
    found: null,
    moved: false,
    busy: false,
    drawn: false,
    decided: false,
  };
  const mine = hand;
  drawHand();
  view.clear("Reading points…");
  message.textContent = "";
  try {
    const [facts, points] = await fetched(pair);
    if (hand !== mine) return;
    mine.facts = facts;
    const drawn = view.set(
      points,
      { odometry: facts.odometry, predicted: facts.predicted, after: poseOf(mine) },
      facts.upright,
    );
    drawHand();
    drawn.then(() => {
      mine.drawn = true;
      if (hand === mine) drawHand();
    });
    for (const next of queue.neighbors()) fetched([next.frame_i, next.frame_j]).catch(() => {});
  } catch (error) {
    if (hand === mine) {
      view.clear("No points to show");
      message.textContent = error.message;
    }
  }
}

const standingOf = (pair) =>
  state?.standing.find((one) => one.frame_i === pair[0] && one.frame_j === pair[1]);

function poseOf({ pair, facts }) {
  const stands = standingOf(pair);
  return stands?.measured ? stands.T_i_j : (facts.measured ?? facts.predicted);
}

/** A pair the program never tried. */
function newRow(pair) {
  const nothing = {
    influence_m: null,
    overlap: null,
    error_m: null,
    limit_m: null,
    degeneracy: null,
    verification_m: null,
    chi2: null,
  };
  return decorated({
    frame_i: pair[0],
    frame_j: pair[1],
    t_i_s: 0,
    t_j_s: 0,
    kind: "manual",
    verdict: "rejected",
    reason: "",
    measured: Boolean(standingOf(pair)?.measured),
    paths: 0,
    ...nothing,
  });
}

function decorated(row) {
  row.key = keyOf([row.frame_i, row.frame_j]);
  row.title = `Multiframes ${row.frame_i} and ${row.frame_j}`;
  return Object.assign(row, decidedAbout(row));
}

/** What holds for a pair: a person's decision, else what the program says now, else said at first. */
function decidedAbout(row) {
  const stands = standingOf([row.frame_i, row.frame_j]);
  if (stands)
    return { state: stands.accepted ? "accepted" : "rejected", who: stands.who, why: stands.why };
  const is = (pairs) => pairs?.some((p) => p[0] === row.frame_i && p[1] === row.frame_j);
  const now = is(effect?.all.rejected_automatically)
    ? "rejected"
    : is(effect?.all.accepted_automatically)
      ? "accepted"
      : row.verdict;
  return { state: now, who: "", why: "" };
}

function drawHand() {
  showPair(byId("pair"), hand?.row, hand?.facts, hand?.found, limit_m);
  for (const [name, able] of Object.entries(ableTo())) buttons[name].disabled = !able;
  buttons.refine.firstChild.textContent = hand?.busy
    ? "Refining…"
    : hand?.found?.measurement && !hand.moved
      ? "Create edge"
      : "Refine";
  byId("said").textContent = hand && state ? handWords() : "";
}

/** What can be done with the pair in hand, or without one, by who looks. */
function ableTo() {
  const may = Boolean(state?.may_review);
  const can = may && Boolean(hand?.drawn); // nobody decides about points they have not seen
  const open = can && !hand.decided;
  const stands = hand && standingOf(hand.pair);
  return {
    previous: queue.length > 0,
    next: queue.length > 0,
    accept: open && Boolean(hand.row.measured || stands?.measured),
    reject: open,
    restore: may && Boolean(stands),
    refine: can && !hand.busy,
    pick: can,
    undo: may && state.undoable > 0,
    redo: may && state.redoable > 0,
    add: Boolean(graph),
    keys: true,
  };
}

function handWords() {
  if (!hand.facts) return "";
  if (hand.decided) return "Decided. J shows the next pair, U or Ctrl Z takes the decision back";
  if (hand.found && !hand.moved) {
    const { found } = hand;
    const [m, degrees] = apart(found.T_i_j, hand.facts.predicted);
    const moved = `${length(m)} and ${degrees.toFixed(2)}° from the graph`;
    if (!found.converged) return "It did not converge: move it nearer and refine again";
    return found.reason
      ? `Refined, ${moved}. The program would turn it down: ${found.reason}`
      : `Refined, ${moved}. Enter creates the edge`;
  }
  if (hand.moved) return "Moved by hand. Enter refines from here";
  return !hand.row.measured && !standingOf(hand.pair)?.measured
    ? "Never registered: refine it (move it first where it is far off), then it can become an edge"
    : "";
}

// -- decisions, one after the other in the order of the keys

function inTurn(action) {
  last = last.then(async () => {
    byId("news").textContent = "";
    await attempt(message, action);
    if (message.textContent) become(await readReview(id).catch(() => null)); // somebody else may have decided
  });
  return last;
}

function become(fresh) {
  if (!fresh) return;
  const seqBefore = state?.seq;
  state = fresh;
  const added = state.standing.filter((one) => !queue.get(keyOf([one.frame_i, one.frame_j])));
  for (const one of added) {
    const row = newRow([one.frame_i, one.frame_j]);
    allRows = [row, ...allRows];
    queue.add(row);
  }
  refreshRows();
  showSigning(byId("signing"), state, { remake, approve });
  drawHand();
  if (seqBefore !== state.seq) look();
  if (byId("journal", HTMLDetailsElement).open) drawJournal();
}

/** Looks whether others decided something, or a job made another map or another graph. */
function lookAround() {
  last = last.then(async () => {
    const before = state;
    const fresh = await readReview(id).catch(() => null); // the head of the page says when nobody answers
    if (!fresh || state !== before || JSON.stringify(fresh) === JSON.stringify(state)) return;
    if (!state || fresh.graph !== graph) {
      await attempt(message, begin);
      return;
    }
    become(fresh);
    const more = fresh.seq - before.seq;
    const [row] = more > 0 ? await readJournal(id).catch(() => []) : [];
    if (row) byId("news").textContent = journalWords(row, more);
  });
}

function refreshRows() {
  const changed = [];
  for (const row of allRows) {
    if (row.kind === "manual")
      row.measured = Boolean(standingOf([row.frame_i, row.frame_j])?.measured);
    const now = decidedAbout(row);
    if (now.state !== row.state || now.who !== row.who || now.why !== row.why) {
      Object.assign(row, now);
      changed.push(row.key);
    }
  }
  queue.refresh(changed);
}

function decideNow(kind, more = {}) {
  if (!hand || !state?.may_review) return undefined;
  const mine = hand;
  const { pair, row, facts } = mine;
  const stands = standingOf(pair);
  if (kind === "restore" ? !stands : !mine.drawn || mine.decided) return undefined;
  if (kind === "accept" && !row.measured && !stands?.measured) {
    message.textContent = "This pair was never registered: lay it right and refine it first";
    return undefined;
  }
  const why = reason.value.trim();
  reason.value = "";
  const seen = row.measured ? (facts?.measured ?? []) : [];
  const body = { kind, frame_i: pair[0], frame_j: pair[1], T_i_j: seen, why, ...more };
  mine.decided = kind !== "restore";
  const sent = inTurn(async () => {
    try {
      become(await decide(id, body));
    } catch (error) {
      mine.decided = false;
      throw error;
    }
  });
  drawHand();
  if (onwards.checked && kind !== "restore") queue.step(1);
  return sent;
}

function step(through) {
  if (!state?.may_review) return;
  inTurn(async () => {
    const fresh = await through(id, state.seq);
    if (hand) hand.decided = false;
    become(fresh);
  });
}

const undo = () => step(undoDecision);
const redo = () => step(redoDecision);

/** Register from where it lies; once registered and not moved since, make it an edge. */
async function enter() {
  if (!hand?.drawn || hand.busy || !state?.may_review) return;
  const mine = hand;
  if (mine.found?.measurement && !mine.moved) {
    const known = mine.row.kind !== "manual" && queue.get(mine.row.key);
    await decideNow(known ? "replace" : "add", { measurement: mine.found.measurement });
    mine.found = null;
    if (hand === mine) drawHand();
    return;
  }
  mine.busy = true;
  drawHand();
  const found = await attempt(message, () => alignPair(id, mine.pair, view.pose));
  mine.busy = false;
  if (found && hand === mine) {
    Object.assign(mine, { found, moved: false, decided: false });
    view.pose = found.T_i_j;
  }
  if (hand === mine) drawHand();
}

function drop() {
  if (!hand?.facts) return;
  if (view.isPicking) return view.stopPicking();
  [hand.found, hand.moved] = [null, false];
  view.pose = poseOf(hand);
  drawHand();
}

function pick() {
  if (!hand?.facts) return;
  const mine = hand;
  view.pick(async ({ p_i, p_j }) => {
    const pose = await attempt(message, () => fitPoints(id, p_i, p_j));
    if (!pose || hand !== mine) return; // another pair was taken meanwhile
    view.pose = pose;
    mine.moved = true;
    drawHand();
  });
}

// -- what the decisions do

async function look() {
  const mine = ++effectAsked;
  drawEffect();
  if (!graph || (!state.standing.length && !state.undoable && !state.redoable)) {
    effect = null;
  } else {
    const told = await attempt(message, () => readEffect(id));
    if (mine !== effectAsked || !told) return;
    if (told.superseded) return look(); // somebody decided, or an earlier request came late
    effect = told;
    for (const part of [effect.last, effect.all])
      for (const move of part.moves) move.t_s = (move.t_ns - began_ns) / 1e9;
    const chi2 = new Map(effect.edges.map((one) => [keyOf(one.pair), one.chi2]));
    for (const row of allRows) if (chi2.has(row.key)) row.chi2 = chi2.get(row.key);
  }
  effectShown = mine;
  refreshRows();
  drawEffect();
  drawHand();
}

const drawEffect = () =>
  showEffect(byId("effect"), effect, {
    working: effectShown < effectAsked,
    choose: (pair) => take(pair),
  });

async function drawJournal() {
  const rows = await attempt(message, () => readJournal(id));
  if (rows) showJournal(byId("journal").querySelector("ol"), rows);
}

async function remake(error) {
  await attempt(error, async () => {
    await remakeMap(id);
    become(await readReview(id));
  });
}

function approve() {
  const seen = { after_seq: state.seq, graph: state.graph };
  askToSign(effect?.conflicts.length ?? 0, async (why, confirmed) => {
    become(await withPassword(() => approveMap(id, { why, confirmed, ...seen })));
    return true;
  });
}

// -- buttons and keys

const reason = make("input", {
  autocomplete: "off",
  maxLength: 500,
  placeholder: "Reason (optional)",
  ariaLabel: "Reason",
});
const onwards = make("input", { type: "checkbox", checked: localStorage.getItem(GO_ON) === "yes" });
onwards.addEventListener("change", () =>
  localStorage.setItem(GO_ON, onwards.checked ? "yes" : "no"),
);
const button = (words, key, action, name = "") =>
  make(
    "button",
    { type: "button", className: name, onclick: action, title: `${words} (${key})` },
    make("span", {}, words),
    make("kbd", {}, key),
  );
const once = (action) => (event) => event.detail < 2 && action(); // the second click of a double one would hit the next pair
const buttons = {
  previous: button("Previous", "K", () => queue.step(-1)),
  next: button("Next", "J", () => queue.step(1)),
  accept: button(
    "Accept",
    "A",
    once(() => decideNow("accept")),
    "yes",
  ),
  reject: button(
    "Reject",
    "R",
    once(() => decideNow("reject")),
    "no",
  ),
  restore: button("Restore", "U", () => decideNow("restore")),
  refine: button("Refine", "Enter", enter),
  pick: button("Pick points", "P", pick),
  undo: button("Undo", "Ctrl Z", undo),
  redo: button("Redo", "Ctrl Y", redo),
  add: button("Add loop", "L", addLoop),
  keys: button("Keys", "?", showKeys),
};
byId("decision").append(
  make(
    "div",
    { className: "row main" },
    buttons.previous,
    buttons.reject,
    buttons.accept,
    buttons.next,
  ),
  make(
    "div",
    { className: "row" },
    buttons.restore,
    buttons.refine,
    buttons.pick,
    buttons.undo,
    buttons.redo,
  ),
  make(
    "div",
    { className: "row reason" },
    reason,
    make(
      "label",
      { className: "check" },
      onwards,
      make("span", {}, "Go on to the next pair after a decision"),
    ),
  ),
);

queue.tools.append(buttons.add, buttons.keys);

async function addLoop() {
  const walk = await attempt(message, () => readWalk(id));
  if (walk) askForMoments(walk, hand?.pair, take);
}

const press = {
  j: () => queue.step(1),
  k: () => queue.step(-1),
  a: () => decideNow("accept"),
  r: () => decideNow("reject"),
  u: () => decideNow("restore"),
  Backspace: () => decideNow("restore"),
  p: pick,
  l: addLoop,
  v: () => view.viewNext(),
  b: () => view.compareNext(),
  w: () => reason.focus(),
  "[": () => view.moveCut(-1),
  "]": () => view.moveCut(1),
  "+": () => view.zoom(1.25),
  "-": () => view.zoom(0.8),
  "?": showKeys,
  Enter: enter,
  Escape: drop,
};
const moves = {
  ArrowLeft: (m) => view.nudge(-m, 0),
  ArrowRight: (m) => view.nudge(m, 0),
  ArrowUp: (m) => view.nudge(0, m),
  ArrowDown: (m) => view.nudge(0, -m),
  PageUp: (m) => view.lift(m),
  PageDown: (m) => view.lift(-m),
  Comma: (m, turn) => view.nudge(0, 0, turn),
  Period: (m, turn) => view.nudge(0, 0, -turn),
};

// -- begin

let allRows = [];
let began_ns = 0;

queue.addEventListener("chosen", (event) => {
  const row = queue.get(/** @type {CustomEvent} */ (event).detail);
  take([row.frame_i, row.frame_j]);
});
view.addEventListener("laid", () => {
  hand.moved = true;
  drawHand();
});
view.addEventListener("reach", () => hand && take(hand.pair));
byId("journal").addEventListener("toggle", drawJournal);
listenToKeys({ press, moves, undo, redo, reason, canMove: () => Boolean(hand?.drawn) });

async function begin() {
  view.clear("Ordering the loops…");
  const fresh = await readReview(id);
  graph = fresh.graph;
  state = { ...fresh, seq: -1 };
  loaded.clear();
  hand = effect = null;
  const told = graph ? await readQueue(id) : { rows: [], columns: [], began_ns: 0, limit_m };
  ({ began_ns, limit_m } = told);
  allRows = told.rows.map((row) =>
    decorated(Object.fromEntries(told.columns.map((name, k) => [name, row[k]]))),
  );
  queue.rows = allRows;
  view.clear(
    allRows.length
      ? "J takes the first pair"
      : graph
        ? "This walk has no pair to decide about"
        : "Nothing to review until loops have been searched and verified",
  );
  become(fresh);
}

const states = new Map();
watchJobs(
  ({ job }) => {
    if (job.project !== id || states.get(job.id) === job.state) return;
    states.set(job.id, job.state);
    lookAround();
  },
  (linked) => {
    document.querySelector("page-head").linked = linked;
  },
);
drawHand();
await attempt(message, begin);
if (message.textContent) view.clear("Nothing to review");
setInterval(() => document.hidden || lookAround(), EVERY_MS);
