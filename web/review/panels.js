// The figures of a pair, what the decisions do, and the journal. Takes data, makes elements.

import { fill, make } from "../shared/dom.js";
import { when } from "../shared/format.js";
import { KINDS, length, plain, seconds, share } from "./captions.js";

const put = (panel, ...children) => panel.replaceChildren(...children.filter(Boolean));
const fact = (words, value, hint) =>
  make(
    "div",
    {},
    make("dt", {}, words),
    make("dd", {}, value, hint ? make("small", {}, ` ${hint}`) : null),
  );
const over = (row) => row.error_m !== null && row.limit_m !== null && row.error_m > row.limit_m;

/** The pair in hand: figures of the program and what a person found anew. */
export function showPair(panel, row, facts, found, limit_m) {
  if (!row)
    return put(
      panel,
      make("h2", {}, "No pair chosen"),
      make("p", { className: "quiet" }, "J takes the first one"),
    );
  const bad = (yes, words) => (yes ? make("span", { className: "bad" }, "✕ ", words) : words);
  const figures = found ?? row;
  const contradicted = row.verification_m !== null && row.verification_m > limit_m;
  put(
    panel,
    make("h2", {}, row.title),
    make(
      "p",
      {},
      row.reason
        ? make("span", {}, "Turned down by the program: ", row.reason)
        : row.kind === "manual"
          ? "Made by a person"
          : "Kept by the program",
    ),
    make(
      "dl",
      {},
      fact("Influence", length(row.influence_m), "if it changed sides"),
      fact("Overlap", share(figures.overlap)),
      fact(
        "Error",
        bad(over(figures), length(figures.error_m)),
        figures.limit_m === null ? "" : `limit ${length(figures.limit_m)}`,
      ),
      fact("Held against sliding", plain(figures.degeneracy, 2), "0 free … 0.33"),
      fact(
        "Other ways round",
        bad(contradicted, length(row.verification_m)),
        `median of ${row.paths ?? 0}`,
      ),
      fact("Share of chi²", plain(row.chi2)),
      fact(
        "Off the graph by",
        facts ? length(facts.apart_m) : "…",
        facts ? `${((facts.apart_rad * 180) / Math.PI).toFixed(2)}°` : "",
      ),
      fact("Decided by", row.who || "the program", row.why),
    ),
    facts?.paths.length ? paths(facts) : null,
  );
}

function paths(facts) {
  const line = (path) =>
    make(
      "li",
      {},
      make("span", {}, path.frames.join(" → ")),
      make("b", {}, length(path.residual_m)),
    );
  return make(
    "details",
    {},
    make("summary", {}, `Alternative paths (${facts.path_count})`),
    make("ul", { className: "paths" }, ...facts.paths.slice(0, 20).map(line)),
  );
}

/** What the decisions do to the graph. */
export function showEffect(panel, effect, { working, choose }) {
  if (!effect)
    return put(
      panel,
      make("h2", {}, "Effect"),
      make("p", { className: "quiet" }, working ? "Solving the graph…" : "Nothing decided yet"),
    );
  const { last, all } = effect;
  const pair = (p) =>
    make(
      "button",
      { type: "button", className: "link", onclick: () => choose(p) },
      `multiframes ${p[0]} and ${p[1]}`,
    );
  const list = (words, pairs, name) =>
    pairs.length
      ? make(
          "div",
          { className: name ?? "" },
          make("h3", {}, words),
          make(
            "ul",
            {},
            ...pairs.slice(0, 8).map((one) => make("li", {}, ...one)),
            pairs.length > 8 ? make("li", {}, `and ${pairs.length - 8} more`) : null,
          ),
        )
      : null;
  put(
    panel,
    make("h2", {}, working ? "Effect (solving…)" : "Effect"),
    make(
      "dl",
      {},
      fact("chi², last decision", `${plain(last.chi2_before, 4)} → ${plain(last.chi2_after, 4)}`),
      fact("Edges in the graph", `${last.edges_before} → ${last.edges_after}`),
      fact("chi², all decisions", `${plain(all.chi2_before, 4)} → ${plain(all.chi2_after, 4)}`),
      fact("Largest move in all", length(all.moves[0]?.moved_m ?? 0)),
    ),
    list(
      "✕ Accepted, but does not fit",
      effect.conflicts.map((one) => [
        pair(one.pair),
        ` off by ${length(one.residual_m)}, ${((one.residual_rad * 180) / Math.PI).toFixed(1)}°, by ${one.who}`,
      ]),
      "bad",
    ),
    list(
      "Without effect: not in this graph, or never registered",
      effect.missing.map((p) => [pair(p)]),
    ),
    list(
      "Measures something else than was seen",
      effect.changed.map((p) => [pair(p)]),
    ),
    list(
      "Dropped by the program as a consequence",
      all.rejected_automatically.map((p) => [pair(p)]),
    ),
    list(
      "Taken in again as a consequence",
      all.accepted_automatically.map((p) => [pair(p)]),
    ),
    list(
      "Largest moves of the last decision",
      last.moves
        .slice(0, 5)
        .map((move) => [
          `${length(move.moved_m)} at multiframe ${move.frame_id} (${seconds(move.t_s)})`,
        ]),
    ),
  );
}

/** Who approved what; a decision after the approval makes a draft again. */
function approvalWords({ approval, in_map }) {
  if (!approval) return "Not approved, a draft";
  const version = `version ${approval.version} by ${approval.who}, ${when(approval.time)}`;
  if (approval.check === "altered") return `✗ Altered since the approval: ${approval.altered}`;
  if (!approval.current) return `A draft. An earlier map was approved: ${version}`;
  if (in_map && approval.check === "checking")
    return `Approved: ${version}; the bytes are being compared with the signature`;
  return in_map
    ? `✓ Approved: ${version}`
    : `A draft again: decisions came after the approval of ${version}`;
}

function mapWords({ busy, finished, in_map, standing }) {
  if (busy) return "▶ A job waits or runs";
  if (!finished) return "◌ There is no finished map yet";
  if (!in_map) return "◌ The map does not know the last decisions yet";
  return standing.length
    ? "✓ The map was made with these decisions"
    : "✓ The map is as the program made it";
}

/** Whether the map knows the decisions, and who approved it. */
export function showSigning(panel, state, { remake, approve }) {
  const { approval } = state;
  const hurdle = state.busy
    ? "A job waits or runs"
    : !state.finished
      ? "There is no finished map yet"
      : !state.in_map
        ? "The map does not know the last decisions"
        : approval?.current && approval.check !== "altered"
          ? "This map is approved"
          : "";
  fill(
    panel,
    make("h2", {}, "Map"),
    make("p", {}, mapWords(state)),
    make(
      "p",
      {
        className:
          approval?.check === "altered"
            ? "error"
            : approval?.check === "checked" && state.in_map
              ? "good"
              : "",
      },
      approvalWords(state),
    ),
    approval ? make("p", { className: "quiet hash" }, approval.hash) : null,
    make(
      "div",
      { className: "buttons" },
      make(
        "button",
        {
          type: "button",
          id: "remake",
          disabled: state.busy || state.in_map || !state.may_process,
        },
        "Make a new map",
      ),
      make(
        "button",
        {
          type: "button",
          id: "approve",
          disabled: Boolean(hurdle) || !state.may_review,
          title: hurdle,
        },
        "Approve verification…",
      ),
    ),
    hurdle && !state.busy && !(approval?.current && state.in_map)
      ? make("p", { className: "quiet" }, `Approving: ${hurdle.toLowerCase()}`)
      : null,
    make("p", { className: "error", role: "alert" }),
  );
  panel.querySelector("#remake").onclick = () => remake(panel.querySelector(".error"));
  panel.querySelector("#approve").onclick = () => approve();
}

const about = (row) =>
  row.frame_i === null ? "" : ` multiframes ${row.frame_i} and ${row.frame_j}`;

/** What somebody else did meanwhile: the last of some rows of the journal. */
export function journalWords(row, count) {
  const more =
    count > 1 ? `, after ${count - 1} other ${count > 2 ? "decisions" : "decision"}` : "";
  return `Meanwhile ${row.who} ${KINDS[row.kind] ?? row.kind}${about(row)}${more}`;
}

export function showJournal(list, rows) {
  fill(
    list,
    ...rows.map((row) =>
      make(
        "li",
        { value: row.seq },
        make("b", {}, row.who),
        ` ${KINDS[row.kind] ?? row.kind}${about(row)}`,
        make("small", {}, ` ${when(row.time)}`),
        row.why ? make("q", {}, row.why) : null,
      ),
    ),
  );
}
