// REST: one function a call, typed answers, problems as ProblemError.
import { Reader } from "./wire/check";
import {
  decodeCameras, decodeExhibits, decodeMapInfo, decodeProblem, decodeQueue, decodeRequest, decodeSession, decodeSite, decodeStatistics, decodeStatus,
  decodeTours,
} from "./wire/rest";
import { decodeHealth } from "./wire/decode";
import type { Mode, Pose, Problem } from "./wire/types";

export class ProblemError extends Error {
  constructor(readonly problem: Problem) {
    super(problem.detail || problem.title || `HTTP ${problem.status}`);
  }
}

const base = "/api/v1";
const patience = 12_000; // ms

async function call<T>(method: string, path: string, body: unknown, read: (r: Reader) => T, headers: Record<string, string> = {}): Promise<T> {
  const stop = new AbortController();
  const timer = setTimeout(() => stop.abort(), patience);
  try {
    const answer = await fetch(path.startsWith("/") ? path : `${base}/${path}`, {
      method,
      credentials: "same-origin",
      signal: stop.signal,
      headers: { Accept: "application/json", ...(body === undefined ? {} : { "Content-Type": "application/json" }), ...headers },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
    const text = await answer.text();
    let value: unknown = null;
    try {
      value = text === "" ? null : JSON.parse(text);
    } catch {
      if (answer.ok) throw new ProblemError({ title: "", status: answer.status, detail: "", code: "not_json" });
    }
    if (!answer.ok) throw new ProblemError(decodeProblem(value, answer.status));
    return read(new Reader(value));
  } catch (error) {
    if (error instanceof ProblemError) throw error;
    const aborted = stop.signal.aborted;
    throw new ProblemError({ title: "", status: 0, detail: "", code: aborted ? "timeout" : error instanceof TypeError ? "no_connection" : "bad_answer" });
  } finally {
    clearTimeout(timer);
  }
}

const nothing = () => undefined;
const get = <T>(path: string, read: (r: Reader) => T) => call("GET", path, undefined, read);

// The same click sent twice (a lost answer, a double tap) is one request.
function once(): Record<string, string> {
  const random = crypto.getRandomValues(new Uint32Array(4));
  return { "Idempotency-Key": Array.from(random, (n) => n.toString(16).padStart(8, "0")).join("") };
}

export const api = {
  status: () => get("status", decodeStatus),
  site: () => get("site", decodeSite),
  exhibits: () => get("exhibits", decodeExhibits),
  tours: () => get("tours", decodeTours),
  cameras: () => get("cameras", decodeCameras),
  map: () => get("map", decodeMapInfo),
  queue: () => get("queue", decodeQueue),
  session: () => get("session", decodeSession),
  health: () => get("health", decodeHealth),
  statistics: () => get("statistics", decodeStatistics),

  sendTo: (exhibit: string, name: string) => call("POST", "queue", { exhibit, ...(name ? { name } : {}) }, decodeRequest, once()),
  comeTo: (x: number, y: number, name: string) => call("POST", "queue", { x, y, ...(name ? { name } : {}) }, decodeRequest, once()),
  leave: (id: string) => call("DELETE", `queue/${encodeURIComponent(id)}`, undefined, nothing),
  startTour: (tour: string, name: string) => call("POST", "tours/current", { tour, ...(name ? { name } : {}) }, nothing, once()),
  endTour: () => call("DELETE", "tours/current", undefined, nothing),
  answer: (answer: "more" | "move_on") => call("POST", "tours/current/answer", { answer }, nothing),

  signIn: (password: string) => call("POST", "session", { password }, decodeSession),
  stop: () => call("POST", "stop", {}, nothing),
  resume: () => call("POST", "resume", {}, nothing),
  setMode: (mode: Mode) => call("PATCH", "settings", { mode }, nothing),
  setPose: (pose: Pose) => call("PUT", "pose", { ...pose }, nothing),
  lookEverywhere: () => call("PUT", "pose", { global: true }, nothing),
};
