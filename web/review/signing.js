// The dialog in which a map is approved: verdict, findings, figures, and the reason of the signer.

import { badge } from "../shared/badge.js";
import { attempt, make } from "../shared/dom.js";
import { figures } from "../shared/figures.js";
import { fixedFindingList } from "../shared/finding_list.js";
import { isReason, verdictState } from "../shared/verdict.js";
import { open } from "./dialogs.js";

const SIGNED =
  "Your name, the time, the verdict, the figures and the hashes of all results are signed. " +
  "A version is kept that no later run or decision changes.";

/** What the signature is about: the verdict with its reasons, and the figures. */
const about = (map) =>
  make(
    "section",
    { className: "signed-map", tabIndex: 0, ariaLabel: "What is approved" },
    make("p", {}, badge(verdictState(map.verdict))),
    fixedFindingList(map),
    make(
      "dl",
      {},
      ...figures(map.figures).map(([text, value]) =>
        make("div", {}, make("dt", {}, text), make("dd", {}, value)),
      ),
    ),
  );

/** The field for the reason, with why and how long one is needed. */
function reasonField(map, conflicts) {
  const field = make("input", { name: "why", maxLength: 500, autocomplete: "off" });
  const hint =
    `Needed in spite of the findings, at least ${map.min_reason_characters} characters. ` +
    "It stands in the report and in every exported file";
  const label = make(
    "label",
    {},
    make("span", {}, map.reason_needed || conflicts ? "Reason (required)" : "Remark"),
    field,
    map.reason_needed ? make("small", {}, hint) : null,
  );
  return { field, label };
}

/** Asks for a reason and, if there are conflicts, for confirmation; `sign(why, confirmed)`. */
export function askToSign(map, conflicts, sign) {
  const why = reasonField(map, conflicts);
  const confirmed = make("input", { type: "checkbox" });
  const message = make("p", { className: "error", role: "alert" });
  const button = make("button", { className: "primary" }, "Sign");
  const allow = () => (button.disabled = !isReason(why.field.value, map));
  const submit = async (event) => {
    event.preventDefault();
    [button.disabled, button.textContent] = [true, "Signing…"];
    const done = await attempt(message, () => sign(why.field.value, confirmed.checked));
    button.textContent = "Sign";
    allow();
    if (done) dialog.close();
  };
  const text = `${conflicts} accepted loop closures do not fit the graph; sign anyway`;
  const cancel = make("button", { type: "button", onclick: () => dialog.close() }, "Cancel");
  const form = make(
    "form",
    { onsubmit: submit, oninput: allow },
    about(map),
    make("p", {}, SIGNED),
    why.label,
    conflicts ? make("label", { className: "check" }, confirmed, make("span", {}, text)) : null,
    message,
    make("div", { className: "buttons" }, cancel, button),
  );
  const dialog = open("Approve map", form);
  dialog.classList.add("wide");
  allow();
}
