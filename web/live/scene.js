// What this page knows of the capture, kept over lost links: it asks only for what it lacks.

import { openLiveStream, readMe } from "../shared/api.js";

const SILENT_MS = 5000;
const CONNECT_MS = 3000;
const AGAIN_MS = 700;
const TOO_MANY = 4429; // close code: no place for this stream; the reason says so in words
const AGAIN_WHEN_FULL_MS = 10_000;
const HERE_EVERY_MS = 30_000;

export class LiveScene {
  project = "";
  state = "";
  path = [];
  marks = [];
  gaps = [];
  me = null;
  plan = null;
  showPlan = true;
  newest = {};
  total = 0;
  server = "";
  renewed = false; // the server is another version than this page was made for
  #cloud;
  #on;
  #socket;
  #heard = 0;
  #heardLast = performance.now();
  #coming = null;
  #generation = -1;
  #open = false;

  constructor(cloud, handlers) {
    this.#cloud = cloud;
    this.#on = handlers;
    this.#connect();
    setInterval(() => this.#checkLink(), 500);
    setInterval(() => this.#sayHere(), HERE_EVERY_MS);
    addEventListener("online", () => this.#connectAgain());
    document.addEventListener("visibilitychange", () => document.hidden || this.#checkLink());
  }

  /** Since when nothing was heard [s]. */
  get silentS() {
    return Math.round((performance.now() - this.#heardLast) / 1000);
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
    this.#heard = performance.now();
    this.#open = false;
    const socket = (this.#socket = openLiveStream(this.have, {
      onMessage: (told) => socket === this.#socket && this.#take(told),
      onPoints: (data) => socket === this.#socket && this.#takePoints(data),
      onClose: (event) => socket === this.#socket && this.#lost(event),
    }));
  }

  #lost({ code, reason }) {
    this.#socket = null;
    this.#coming = null;
    this.#on.link(false, code === TOO_MANY ? reason : "");
    readMe(true).catch(() => {}); // signed out meanwhile? then this leads to the login
    setTimeout(
      () => this.#socket ?? this.#connect(),
      code === TOO_MANY ? AGAIN_WHEN_FULL_MS : AGAIN_MS,
    );
  }

  #connectAgain() {
    const socket = this.#socket;
    if (!socket) return;
    socket.close();
    this.#lost();
  }

  #checkLink() {
    const patience = this.#open ? SILENT_MS : CONNECT_MS;
    if (this.#socket && performance.now() - this.#heard > patience) this.#connectAgain();
  }

  /** Somebody looks: the session does not go idle. */
  #sayHere() {
    if (this.#open && !document.hidden) this.#socket?.send("{}");
  }

  #take(told) {
    this.#heard = this.#heardLast = performance.now();
    this.#open = true;
    this.#on.link(true);
    if (told.project && told.project !== this.project) this.#forget(told.project);
    this.state = told.state ?? this.state;
    this.renewed ||= Boolean(told.server && this.server && told.server !== this.server);
    this.server = told.server ?? this.server;
    Object.assign(this.newest, told);
    if (told.points) {
      this.#coming = told.points;
      this.total = told.points.total;
    }
    if (told.path) this.path.splice(told.path.start, Infinity, ...told.path.points);
    if (told.pose) this.me = told.pose;
    if (told.marks) this.marks.splice(told.marks.start, Infinity, ...told.marks.marks);
    if (told.gaps) this.gaps = told.gaps.gaps;
    if (told.plan) this.#on.plan(told.plan);
    this.#on.news();
  }

  #takePoints(data) {
    this.#heard = performance.now();
    const coming = this.#coming;
    if (!coming) return;
    if (coming.start === 0) this.#cloud.clear();
    this.#generation = coming.generation;
    this.#cloud.add(data, coming.count, coming.voxel_m);
    this.#coming = null;
    this.#on.news();
  }

  #forget(project) {
    this.project = project;
    this.path = [];
    this.marks = [];
    this.gaps = [];
    this.me = this.plan = null;
    this.newest = {};
    this.#generation = -1;
    this.#cloud.clear();
  }
}
