// What the review page knows: the server's state, the pairs, the selected pair and the effect of
// the decisions. No DOM, no network.

import { t, written } from "../shared/texts.js";
import { keyOf, length, reasonText } from "./captions.js";
import { IDENTITY, apart } from "./math.js";

/**
 * @typedef {import("../shared/http_types").ReviewView} ReviewView
 * @typedef {import("../shared/http_types").AlignmentView} AlignmentView
 * @import {Effect, Move, PairFacts, WorkView} from "../shared/http_types"
 * @typedef {object} Row a pair of the queue
 * @property {string} key
 * @property {string} title
 * @property {number} frame_i
 * @property {number} frame_j
 * @property {number} t_i_s
 * @property {number} t_j_s
 * @property {string} kind
 * @property {string} verdict of the program
 * @property {string} reason of a rejection
 * @property {boolean} measured whether it was registered
 * @property {number} paths alternative paths
 * @property {number | null} influence_m
 * @property {number | null} overlap
 * @property {number | null} error_m
 * @property {number | null} limit_m
 * @property {number | null} degeneracy
 * @property {number | null} verification_m
 * @property {number | null} chi2
 * @property {string} state the verdict in force
 * @property {string} who decided; empty = the program
 * @property {string} why
 * @property {WorkView} [work] of people on it
 * @typedef {Omit<Row, "key" | "title" | "state" | "who" | "why" | "work">} NewRow
 * @typedef {Omit<Effect["last"], "moves"> & {moves: Array<Move & {t_s: number}>}} TimedDifference
 * @typedef {Omit<Effect, "last" | "all"> &
 *   {last: TimedDifference, all: TimedDifference}} TimedEffect
 * @typedef {{rows: any[][], columns: string[], began_ns: number, limit_m: number}} Queue
 * @typedef {Record<"previous" | "next" | "accept" | "reject" | "restore" | "refine" | "pick" |
 *   "skip" | "undo" | "redo" | "add" | "keys", boolean>} Enabled which actions are
 * @typedef {object} Selected the pair that is looked at
 * @property {[number, number]} pair frames of both places
 * @property {Row} row
 * @property {PairFacts | null} facts details of the pair, null until they are read
 * @property {AlignmentView | null} found registration made on this page
 * @property {boolean} moved by hand, since the last registration
 * @property {boolean} busy a registration runs
 * @property {boolean} drawn its points are on the screen
 * @property {boolean} decided on this page, since it was selected
 */

export class ReviewState {
  /** @type {ReviewView | null} */
  server = null;
  /** @type {TimedEffect | null} */
  effect = null;
  /** @type {Selected | null} */
  selected = null;
  /** @type {Row[]} */
  rows = [];
  graph = ""; // that the rows are made of
  path_limit_m = 0.1; // largest path discrepancy
  began_ns = 0;

  /**
   * Starts again with the state and the queue of the server.
   * @param {ReviewView} server
   * @param {Queue} queue
   */
  reset(server, queue) {
    // no journal row of the server is older than -1: the first update always computes the effect
    this.server = { ...server, seq: -1 };
    this.graph = server.graph;
    this.selected = this.effect = null;
    this.began_ns = queue.began_ns;
    this.path_limit_m = queue.limit_m;
    this.rows = queue.rows.map((row) =>
      this.#described(
        /** @type {NewRow} */ (Object.fromEntries(queue.columns.map((name, k) => [name, row[k]]))),
      ),
    );
  }

  /** Takes the server's state; returns new rows of pairs that others added. */
  update(/** @type {ReviewView} */ server) {
    this.server = server;
    const known = new Set(this.rows.map((row) => row.key));
    const added = server.standing
      .map((one) => /** @type {[number, number]} */ ([one.frame_i, one.frame_j]))
      .filter((pair) => !known.has(keyOf(pair)))
      .map((pair) => this.newRow(pair));
    this.rows = [...added, ...this.rows];
    return added;
  }

  /** Takes the effect of the decisions on the graph; null without decisions. */
  setEffect(/** @type {Effect | null} */ effect) {
    this.effect = effect && this.#timed(effect);
    if (!effect) return;
    const chi2 = new Map(effect.edges.map((one) => [keyOf(one.pair), one.chi2]));
    for (const row of this.rows) row.chi2 = chi2.get(row.key) ?? row.chi2;
  }

  /** The effect with the times of its moves in the walk. */
  #timed(/** @type {Effect} */ effect) {
    const timed = (/** @type {Effect["last"]} */ part) => ({
      ...part,
      moves: part.moves.map((move) => ({ ...move, t_s: (move.t_ns - this.began_ns) / 1e9 })),
    });
    return { ...effect, last: timed(effect.last), all: timed(effect.all) };
  }

  /** Brings the rows up to date; returns the keys of those that changed. */
  refreshRows() {
    /** @type {string[]} */
    const changed = [];
    for (const row of this.rows) {
      const work = this.workOf([row.frame_i, row.frame_j]);
      if (JSON.stringify(work) !== JSON.stringify(row.work)) {
        row.work = work;
        changed.push(row.key);
      }
      if (row.kind === "manual") row.measured = this.#isMeasuredByPerson(row);
      const now = this.#decisionOf(row);
      if (now.state !== row.state || now.who !== row.who || now.why !== row.why) {
        Object.assign(row, now);
        changed.push(row.key);
      }
    }
    return changed;
  }

  /**
   * @param {[number, number]} pair
   * @param {Row} row
   */
  select(pair, row) {
    /** @type {Selected} */
    const selected = {
      pair,
      row,
      facts: null,
      found: null,
      moved: false,
      busy: false,
      drawn: false,
      decided: false,
    };
    this.selected = selected;
    return selected;
  }

  /** The decision of a person that is in force for a pair. */
  activeDecisionOf(/** @type {[number, number]} */ [i, j]) {
    return this.server?.standing.find((one) => one.frame_i === i && one.frame_j === j);
  }

  /** That of the selected pair. */
  get activeDecision() {
    return this.selected ? this.activeDecisionOf(this.selected.pair) : undefined;
  }

  /** What people do with a pair besides deciding. */
  workOf(/** @type {[number, number]} */ [i, j]) {
    return this.server?.work.find((one) => one.frame_i === i && one.frame_j === j);
  }

  /** The measured pose of the selected pair; the graph's prediction if it was never registered. */
  poseOf(/** @type {Pick<Selected, "pair" | "facts">} */ { pair, facts }) {
    const decision = this.activeDecisionOf(pair);
    return decision?.measured ? decision.T_i_j : (facts?.measured ?? facts?.predicted ?? IDENTITY);
  }

  /** Whether the selected pair was registered, by the program or by a person. */
  get isMeasured() {
    if (!this.selected) return false;
    const { row, pair } = this.selected;
    return Boolean(row.measured || this.activeDecisionOf(pair)?.measured);
  }

  get hasDecisions() {
    if (!this.server) return false;
    const { standing: activeDecisions, undoable, redoable } = this.server;
    return Boolean(this.graph && (activeDecisions.length || undoable || redoable));
  }

  /** A row for a pair the program never tried. */
  newRow(/** @type {[number, number]} */ pair) {
    const unknown = {
      influence_m: null,
      overlap: null,
      error_m: null,
      limit_m: null,
      degeneracy: null,
      verification_m: null,
      chi2: null,
    };
    return this.#described({
      frame_i: pair[0],
      frame_j: pair[1],
      t_i_s: 0,
      t_j_s: 0,
      kind: "manual",
      verdict: "rejected",
      reason: "",
      measured: Boolean(this.activeDecisionOf(pair)?.measured),
      paths: 0,
      ...unknown,
    });
  }

  /** Which actions are enabled, by the person's permissions and the selected pair. */
  enabled(/** @type {number} */ pairs) {
    const may = Boolean(this.server?.may_review);
    const { selected } = this;
    // a person decides about points they have seen
    const drawn = may && selected !== null && selected.drawn;
    const open = drawn && !selected.decided;
    return {
      previous: pairs > 0,
      next: pairs > 0,
      accept: open && this.isMeasured,
      reject: open,
      restore: may && Boolean(selected && this.activeDecisionOf(selected.pair)),
      refine: drawn && !selected.busy,
      pick: drawn,
      skip: may && selected !== null,
      undo: may && (this.server?.undoable ?? 0) > 0,
      redo: may && (this.server?.redoable ?? 0) > 0,
      add: Boolean(this.graph),
      keys: true,
    };
  }

  /** What the button to refine does next. */
  get refineText() {
    const { selected } = this;
    if (selected?.busy) return t("refining");
    return selected?.found?.measurement && !selected.moved ? t("create-edge") : t("refine");
  }

  /** What to do next with the selected pair. */
  get hint() {
    const { selected, server } = this;
    if (!selected?.facts || !server) return "";
    if (selected.decided) return t("hint-decided");
    if (selected.found && !selected.moved) return registrationHint(selected);
    if (selected.moved) return t("hint-moved");
    return this.isMeasured ? "" : t("hint-not-registered");
  }

  #isMeasuredByPerson(/** @type {Row} */ row) {
    return Boolean(this.activeDecisionOf([row.frame_i, row.frame_j])?.measured);
  }

  #described(/** @type {NewRow} */ row) {
    const { frame_i, frame_j } = row;
    const title = t("pair-title", { i: String(frame_i), j: String(frame_j) });
    return { ...row, key: keyOf([frame_i, frame_j]), title, ...this.#decisionOf(row) };
  }

  /** A person's decision, else the program's after the decisions, else its first verdict. */
  #decisionOf(/** @type {Pick<Row, "frame_i" | "frame_j" | "verdict">} */ row) {
    const decision = this.activeDecisionOf([row.frame_i, row.frame_j]);
    if (decision) {
      const { accepted, who, why } = decision;
      return { state: accepted ? "accepted" : "rejected", who, why };
    }
    const isIn = (/** @type {number[][] | undefined} */ pairs) =>
      pairs?.some(([i, j]) => i === row.frame_i && j === row.frame_j);
    const rejected = isIn(this.effect?.all.rejected_automatically) && "rejected";
    const accepted = isIn(this.effect?.all.accepted_automatically) && "accepted";
    return { state: rejected || accepted || row.verdict, who: "", why: "" };
  }
}

function registrationHint(/** @type {Selected} */ { found, facts }) {
  if (!found || !facts) return "";
  const [m, degrees] = apart(found.T_i_j, facts.predicted);
  const moved = { length: length(m), angle: written(`${degrees.toFixed(2)}°`) };
  if (!found.converged) return t("hint-not-converged");
  return found.reason
    ? t("hint-refined-rejected", { ...moved, reason: reasonText(found.reason) })
    : t("hint-refined", moved);
}
