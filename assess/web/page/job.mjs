// The simulation of this session: one for the whole page, found again after a reload. Its classes go to `store.simulated`.

import { get, post } from "./api.mjs";

const EVERY_MS = 500;
const SETTLED_MS = 400;

/** Tells `change` with every answer about the job. */
class JobWatch extends EventTarget {
  /** What `GET /api/job` answered last; null where nothing was simulated. */
  current = null;
  #store = null;
  #timer = 0;
  #asked = 0;
  #version = null;

  /** Follow the job of this session from now on. */
  attach(store) {
    this.#store = store;
    store.addEventListener("book", () => this.refresh());
    store.addEventListener("state", () => this.#onState());
    this.refresh();
  }

  get isRunning() {
    return this.current?.state === "running";
  }

  /** Ask for the job; every half second while it runs. */
  async refresh() {
    clearTimeout(this.#timer);
    const asked = (this.#asked += 1);
    try {
      const { job } = await get("/api/job");
      if (asked === this.#asked) this.#take(job);
    } catch {
      // the watch of the server tells that it is gone
    }
    if (asked === this.#asked && this.isRunning) this.#timer = setTimeout(() => this.refresh(), EVERY_MS);
  }

  /** Start a simulation; rejects with ApiError where the server does not. */
  async start(request) {
    this.#asked += 1; // an answer that is under way tells of the job before
    const { job } = await post("/api/job", request);
    this.#take(job);
    this.refresh();
  }

  async cancel() {
    this.#asked += 1;
    const { job } = await post("/api/job/cancel");
    this.#take(job);
  }

  /** Look again where the server tells of another job, such as one that another window started. */
  compare(summary) {
    if (!summary || this.isRunning) return;
    if (summary.id !== this.current?.id || summary.state !== this.current.state) this.refresh();
  }

  #take(job) {
    this.current = job ?? null;
    this.#version = this.#store.state.version;
    this.#store.simulated = simulatedRows(job);
    this.dispatchEvent(new Event("change"));
  }

  /** An edit may make simulated classes old. */
  #onState() {
    if (this.current?.state !== "done" || this.#store.waiting || this.#store.state.version === this.#version) return;
    this.#version = this.#store.state.version;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.refresh(), SETTLED_MS);
  }
}

export const jobs = new JobWatch();

/** The simulated pieces by row; those for which the formula's chance stands are left out. */
function simulatedRows(job) {
  const rows = new Map();
  if (job?.state !== "done" || !job.items) return rows;
  const stale = new Set(job.stale);
  const { row, simulated, low, high, chance } = job.items;
  row.forEach((one, at) => {
    if (!simulated[at]) return;
    rows.set(one, { class: job.items.class[at], chance: chance[at], low: low[at], high: high[at], stale: stale.has(one) });
  });
  return rows;
}

/**
 * Pieces by class as a run found them, whatever changed since: the same as in its reports. Under "" are those that are
 * anchored or have the formula's class only. Null where nothing was simulated.
 */
export function countSimulated(job = jobs.current) {
  if (job?.state !== "done" || !job.items?.simulated.some(Boolean)) return null;
  return countPieces(job.items, (at) => (job.items.simulated[at] ? job.items.class[at] : ""));
}

/** How many pieces, quantities counted, are of each class that `classOf` tells of a row of a run. */
export function countPieces({ row, quantity }, classOf) {
  const counts = {};
  row.forEach((_, at) => (counts[classOf(at)] = (counts[classOf(at)] ?? 0) + quantity[at]));
  return counts;
}
