// State of the capture on this page, kept when the link is lost: a new link sends what is missing.

import { openLiveStream, readCurrentUser } from "../shared/api.js";

/**
 * @import {CloudCanvas} from "../shared/cloud_canvas.js"
 * @import {Gap, Mark, MarkedStretch, Message, Plan, Points, Pose} from "./messages"
 * @import {PaintedPlan} from "./overlay.js"
 * @typedef {object} SceneListeners
 * @property {() => unknown} news something has changed
 * @property {(linked: boolean, reason?: string) => unknown} link
 * @property {(plan: Plan) => unknown} plan a new coverage plan
 */

const SILENT_MS = 5000;
const CONNECT_MS = 3000;
const RETRY_MS = 700;
const TOO_MANY = 4429; // close code: too many streams; the reason is a text for the user
const RETRY_WHEN_FULL_MS = 10_000;
const PRESENT_EVERY_MS = 30_000;

export class LiveScene {
  project = "";
  state = "";
  /** @type {Array<[number, number, number]>} */
  path = [];
  /** @type {Mark[]} */
  marks = [];
  /** @type {MarkedStretch[]} */
  stretches = [];
  /** @type {Gap[]} */
  gaps = [];
  /** @type {Pose | null} */
  me = null;
  /** @type {PaintedPlan | null} */
  plan = null;
  showPlan = true;
  /** @type {Message} */
  newest = {};
  total = 0;
  server = "";
  renewed = false; // the server has another version than this page
  #cloud;
  #on;
  /** @type {WebSocket | null} */
  #socket = null;
  #received = 0;
  #receivedLast = performance.now();
  /** @type {Points | null} */
  #announced = null;
  #generation = -1;
  #open = false;

  /**
   * @param {CloudCanvas} cloud
   * @param {SceneListeners} handlers
   */
  constructor(cloud, handlers) {
    this.#cloud = cloud;
    this.#on = handlers;
    this.#connect();
    setInterval(() => this.#checkLink(), 500);
    setInterval(() => this.#sendPresent(), PRESENT_EVERY_MS);
    addEventListener("online", () => this.#connectAgain());
    document.addEventListener("visibilitychange", () => document.hidden || this.#checkLink());
  }

  /** Time since the last message [s]. */
  get silentS() {
    return Math.round((performance.now() - this.#receivedLast) / 1000);
  }

  get have() {
    return {
      project: this.project,
      generation: this.#generation,
      points: this.#cloud.count,
      path: this.path.length,
      marks: this.marks.length,
    };
  }

  #connect() {
    this.#received = performance.now();
    this.#open = false;
    /** @type {WebSocket} */
    const socket = (this.#socket = openLiveStream(this.have, {
      onMessage: (message) => socket === this.#socket && this.#take(message),
      onPoints: (data) => socket === this.#socket && this.#takePoints(data),
      onClose: (event) => socket === this.#socket && this.#lost(event),
    }));
  }

  /** @param {{ code?: number, reason?: string }} closed why the server closed, if it did */
  #lost({ code, reason = "" }) {
    this.#socket = null;
    this.#announced = null;
    this.#on.link(false, code === TOO_MANY ? reason : "");
    readCurrentUser(true).catch(() => {}); // leads to the login if the session has ended
    setTimeout(
      () => this.#socket ?? this.#connect(),
      code === TOO_MANY ? RETRY_WHEN_FULL_MS : RETRY_MS,
    );
  }

  #connectAgain() {
    const socket = this.#socket;
    if (!socket) return;
    socket.close();
    this.#lost({});
  }

  #checkLink() {
    const timeout = this.#open ? SILENT_MS : CONNECT_MS;
    if (this.#socket && performance.now() - this.#received > timeout) this.#connectAgain();
  }

  /** Keeps the session from going idle while the page is visible. */
  #sendPresent() {
    if (this.#open && !document.hidden) this.#socket?.send("{}");
  }

  #take(/** @type {Message} */ message) {
    this.#received = this.#receivedLast = performance.now();
    this.#open = true;
    this.#on.link(true);
    if (message.project && message.project !== this.project) this.#forget(message.project);
    this.state = message.state ?? this.state;
    this.renewed ||= Boolean(message.server && this.server && message.server !== this.server);
    this.server = message.server ?? this.server;
    Object.assign(this.newest, message);
    if (message.points) {
      this.#announced = message.points;
      this.total = message.points.total;
    }
    if (message.path) this.path.splice(message.path.start, Infinity, ...message.path.points);
    if (message.pose) this.me = message.pose;
    if (message.marks) this.marks.splice(message.marks.start, Infinity, ...message.marks.marks);
    if (message.stretches)
      this.stretches.splice(message.stretches.start, Infinity, ...message.stretches.stretches);
    if (message.gaps) this.gaps = message.gaps.gaps;
    if (message.plan) this.#on.plan(message.plan);
    this.#on.news();
  }

  #takePoints(/** @type {ArrayBuffer} */ data) {
    this.#received = performance.now();
    const announced = this.#announced;
    if (!announced) return;
    if (announced.start === 0) this.#cloud.clear();
    this.#generation = announced.generation;
    this.#cloud.add(data, announced.count, announced.voxel_m);
    this.#announced = null;
    this.#on.news();
  }

  #forget(/** @type {string} */ project) {
    this.project = project;
    this.path = [];
    this.marks = [];
    this.stretches = [];
    this.gaps = [];
    this.me = this.plan = null;
    this.newest = {};
    this.#generation = -1;
    this.#cloud.clear();
  }
}
