// The audit of a rig as text. No DOM, no network.

const UNITS = {
  rad: { factor: 180 / Math.PI, unit: "°", digits: 3 },
  m: { factor: 100, unit: " cm", digits: 2 },
  s: { factor: 1e3, unit: " ms", digits: 2 },
};
const STATUS = {
  consistent: { mark: "✓", word: "agrees", className: "good" },
  off: { mark: "✕", word: "differs", className: "bad" },
  "not observable": { mark: "–", word: "not observable", className: "quiet" },
};
const MODE = "calibration.mode=";

/** The rows of the table: texts, and the result as mark and word. */
export const rowsOf = (parameters) =>
  parameters.map(({ sensor, quantity, axis, unit, change, sd, status }) => ({
    sensor: sensor === "imu" ? "IMU" : sensor,
    quantity: [quantity, axis].filter(Boolean).join(" "),
    change: status === "not observable" && sd === null ? "–" : amount(change, sd, UNITS[unit]),
    ...STATUS[status],
  }));

function amount(change, sd, { factor, unit, digits }) {
  const value = change * factor;
  const sign = value < 0 ? "−" : "+";
  const text = `${sign}${Math.abs(value).toFixed(digits)}`;
  return sd === null ? text + unit : `${text} ± ${(sd * factor).toFixed(digits)}${unit}`;
}

/** The outcome in a word. */
export function outcomeOf({ parameters, applied }) {
  if (applied) return { mark: "✓", word: "Calibrated rig used for this map", className: "good" };
  if (!parameters.length) return { mark: "–", word: "Not compared", className: "quiet" };
  const off = parameters.some((one) => one.status === "off");
  if (off) return { mark: "✕", word: "The rig file differs from the recording", className: "bad" };
  return { mark: "✓", word: "The rig file agrees with the recording", className: "good" };
}

/** The job that maps the recording again and calibrates its rig; null if no job is known. */
export function calibratingJob(project, views) {
  const job = views.map((view) => view.job).find((one) => one.inputs.recordings.length > 0);
  if (!job) return null;
  const { recordings, preset, rig, imu, gnss, settings } = job.inputs;
  const others = settings.filter((text) => !text.startsWith(MODE));
  return { project, recordings, preset, rig, imu, gnss, settings: [...others, `${MODE}auto`] };
}
