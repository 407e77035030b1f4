// The runs of this session: one watch for the whole page; they are found again after a reload.

import { get, post } from "./api.mjs";

const EVERY_MS = 500;
const SETTLED_MS = 400;

/** Tells `change` with every answer about the runs. */
class JobWatch extends EventTarget {
  /** What `GET /api/job` answered last: the latest run, null where there is none, and all that have results. */
  current = null;
  runs = [];
  scenarios = [];
  #store = null;
  #timer = 0;
  #asked = 0;
  #version = null;

  /** Follow the runs of this session from now on. */
  attach(store) {
    this.#store = store;
    store.addEventListener("book", () => this.refresh());
    store.addEventListener("state", () => this.#onState());
    this.refresh();
  }

  get isRunning() {
    return this.current?.state === "running";
  }

  /** Ask for the runs; every half second while one is at work. */
  async refresh() {
    clearTimeout(this.#timer);
    const asked = (this.#asked += 1);
    try {
      const answer = await get("/api/job");
      if (asked === this.#asked) this.#take(answer);
    } catch {
      // the watch of the server tells that it is gone
    }
    if (asked === this.#asked && this.isRunning) this.#timer = setTimeout(() => this.refresh(), EVERY_MS);
  }

  /** Begin a run; this and the others reject with ApiError where the server does not. */
  start(request) {
    return this.#post("/api/job", request);
  }

  /** Make files of a run. */
  make(id, formats) {
    return this.#post("/api/job/files", { id, formats });
  }

  remove(id) {
    return this.#post("/api/job/remove", { id });
  }

  cancel() {
    return this.#post("/api/job/cancel");
  }

  async #post(path, body) {
    this.#asked += 1; // an answer that is under way tells of before
    this.#take(await post(path, body));
    if (this.isRunning) this.refresh();
  }

  /** Look again where the server tells of another run, such as one that another window began. */
  compare(summary) {
    if (!summary || this.isRunning) return;
    if (summary.id !== this.current?.id || summary.state !== this.current.state) this.refresh();
  }

  #take({ job, runs, scenarios }) {
    Object.assign(this, { current: job ?? null, runs, scenarios });
    this.#version = this.#store.state.version;
    this.dispatchEvent(new Event("change"));
  }

  /** An edit may make a run old. */
  #onState() {
    if (this.current?.state !== "done" || this.#store.waiting || this.#store.state.version === this.#version) return;
    this.#version = this.#store.state.version;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), SETTLED_MS);
  }
}

export const jobs = new JobWatch();
