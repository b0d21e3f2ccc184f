// <recording-look>: the contents of a recording as a list.

import { lookAt } from "../shared/api.js";
import { make, showError } from "../shared/dom.js";
import { bytes, count, seconds } from "../shared/format.js";

export class RecordingLook extends HTMLElement {
  #asked = 0;

  connectedCallback() {
    this.setAttribute("role", "status");
    this.hidden = true;
  }

  /** The summary of a recording; null if unreadable or if another was requested meanwhile. */
  async look(path) {
    const mine = (this.#asked += 1);
    this.hidden = !path;
    if (!path) return null;
    this.replaceChildren(make("p", { className: "quiet" }, "Reading the recording…"));
    try {
      const found = await lookAt(path);
      if (mine !== this.#asked) return null;
      this.#show(found);
      return found;
    } catch (error) {
      if (mine === this.#asked) this.#refuse(path, error);
      return null;
    }
  }

  /** The reason, and a button for each recording in the folder. */
  #refuse(folder, error) {
    const { candidates = [] } = error;
    const reason = make("p", { className: "error" });
    showError(reason, error);
    const choose = (path) => this.dispatchEvent(new CustomEvent("pick", { detail: path }));
    const label = (path) => (path.startsWith(`${folder}/`) ? path.slice(folder.length + 1) : path);
    this.replaceChildren(
      reason,
      make(
        "div",
        { className: "buttons" },
        ...candidates.map((path) =>
          make("button", { type: "button", onclick: () => choose(path) }, `Use ${label(path)}`),
        ),
      ),
    );
  }

  #show(found) {
    const about = found.estimated ? "about " : "";
    const facts = [
      found.kind,
      bytes(found.bytes),
      ...(found.seconds > 0 ? [`${about}${seconds(found.seconds)}`] : []),
    ];
    const sensor = (one) => {
      const rate = one.rate_hz === null ? "" : `, ${one.rate_hz.toFixed(1)}/s`;
      return [
        "LiDAR",
        `${one.model} (${one.label}): ${about}${count(one.count)} ${one.content}${rate}`,
      ];
    };
    const rows = [
      ...found.sensors.map(sensor),
      ...found.samples.map((text) => ["Samples", text]),
      ...(found.rig ? [["Rig", `${file(found.rig)}, next to it`]] : []),
      ...(found.imu ? [["IMU", `${file(found.imu)}, next to it`]] : []),
      ...(found.gnss ? [["GNSS", `${file(found.gnss)}, next to it`]] : []),
      ...found.derived.map((text) => ["Derived", text]),
      ...found.missing.map((text) => ["Missing", text]),
    ];
    const warnings = found.warnings.map((text) => make("li", {}, text));
    this.replaceChildren(
      make("p", {}, make("strong", {}, facts.join(" · "))),
      make(
        "dl",
        { className: "found" },
        ...rows.flatMap(([term, text]) => [make("dt", {}, term), make("dd", {}, text)]),
      ),
      ...(warnings.length
        ? [make("p", { className: "warn" }, "▲ Warnings"), make("ul", {}, ...warnings)]
        : []),
    );
  }
}

const file = (path) => path.split("/").at(-1);

customElements.define("recording-look", RecordingLook);
