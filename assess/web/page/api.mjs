// Requests to the server that this page came from. Nothing is asked of any other.

const HEADERS = { "X-Assess": "1" };

/** What the server refused, or status 0 where it did not answer; `body` is its answer. */
export class ApiError extends Error {
  constructor(status, body = {}) {
    super([body.message, body.fix].filter(Boolean).join(" "));
    Object.assign(this, { name: "ApiError", status, fix: body.fix ?? "", body });
  }
}

/** Tells `gone` when the server does not answer, and `back` when it does again. */
export const connection = new EventTarget();
let isGone = false;

function tell(gone) {
  if (gone === isGone) return;
  isGone = gone;
  connection.dispatchEvent(new Event(gone ? "gone" : "back"));
}

async function request(path, options = {}) {
  let answer, body;
  try {
    answer = await fetch(path, { credentials: "same-origin", cache: "no-store", ...options });
    body = answer.ok ? await answer.json() : await answer.json().catch(() => ({}));
  } catch (error) {
    if (error.name === "AbortError") throw error;
    tell(true); // an answer that breaks off is none
    throw new ApiError(0);
  }
  tell(false);
  if (!answer.ok) throw new ApiError(answer.status, body);
  return body;
}

/** @returns {Promise<object>} the answer; rejects with ApiError, or AbortError where `signal` ended it */
export const get = (path, signal) => request(path, { signal });

const write = (type) => (path, body, signal) =>
  request(path, { method: "POST", headers: { ...HEADERS, "Content-Type": type }, body, signal });
const writeJson = write("application/json");

export const post = (path, body = {}, signal) => writeJson(path, JSON.stringify(body), signal);

/** Send the bytes of a file. */
export const send = write("application/octet-stream");

/** Ask for something as the page is left: nobody waits for the answer. */
export function leave(path) {
  fetch(path, { method: "POST", headers: HEADERS, credentials: "same-origin", keepalive: true }).catch(() => {});
}
