// Everything the page knows, in one value. `reduce` is pure; views read, never write. Listeners are told at most once a frame, so
// that a burst of messages costs one rendering of the newest values.
import type { Link } from "./wire/connection";
import type { Lang } from "./wire/types";
import type {
  Camera, Exhibit, Health, MapInfo, Note, Point, PoseUpdate, Problem, Request, Scan, ServerMessage, Session, Site, Speech, Statistics, Status,
  Tour, VelocitySpace,
} from "./wire/types";

export type Loaded<T> = { state: "loading" } | { state: "ready"; value: T } | { state: "failed"; problem: Problem };

export interface MapImage extends MapInfo {
  cells: Uint8Array; // grey values, row 0 at the bottom
}

export type Theme = "light" | "dark";
// What the person at this screen chose; kept in the browser.
export interface Prefs {
  lang: Lang;
  theme: Theme;
  name: string;
}

export interface State {
  prefs: Prefs;
  link: Link;
  epoch: string;
  session: Session;
  site: Loaded<Site>;
  exhibits: Loaded<Exhibit[]>;
  tours: Loaded<Tour[]>;
  cameras: Loaded<Camera[]>;
  map: Loaded<MapImage>;
  status: Status | null;
  statusAt: number; // wall clock ms of its arrival
  pose: PoseUpdate | null;
  poseAt: number;
  path: Point[];
  pathLength: number;
  people: Point[];
  queue: Request[] | null;
  viewers: number | null;
  speech: Speech | null;
  speechAt: number; // wall clock ms when it began
  notes: Note[]; // newest first
  health: Health | null;
  belief: [number, number, number][];
  velocitySpace: VelocitySpace | null;
  scans: (Scan | null)[]; // by laser
  scanAt: number;
  statistics: Statistics | null;
}

export const emptyState: State = {
  prefs: { lang: "en", theme: "light", name: "" },
  link: { state: "connecting", latency: null, heardAt: null, retryAt: null },
  epoch: "",
  session: { name: "", staff: false, languages: [] },
  site: { state: "loading" },
  exhibits: { state: "loading" },
  tours: { state: "loading" },
  cameras: { state: "loading" },
  map: { state: "loading" },
  status: null,
  statusAt: 0,
  pose: null,
  poseAt: 0,
  path: [],
  pathLength: 0,
  people: [],
  queue: null,
  viewers: null,
  speech: null,
  speechAt: 0,
  notes: [],
  health: null,
  belief: [],
  velocitySpace: null,
  scans: [null, null],
  scanAt: 0,
  statistics: null,
};

const notesKept = 200;

export function reduce(state: State, message: ServerMessage, now: number): State {
  switch (message.type) {
    case "hello":
      // Another run of the server: its clock and events start anew.
      return message.epoch === state.epoch
        ? { ...state, session: { ...state.session, ...message.session } }
        : { ...state, epoch: message.epoch, session: { ...state.session, ...message.session }, speech: null, notes: [], pose: null, path: [], people: [], scans: [null, null], belief: [] };
    case "pose":
      return { ...state, pose: message, poseAt: now };
    case "status":
      return { ...state, status: message, statusAt: now };
    case "path":
      return { ...state, path: message.points, pathLength: message.length };
    case "people":
      return { ...state, people: message.people };
    case "queue":
      return { ...state, queue: message.requests };
    case "request":
      return { ...state, queue: withRequest(state.queue, message.request) };
    case "viewers":
      return { ...state, viewers: message.count };
    case "speech":
      return { ...state, speech: message, speechAt: now - spokenFor(state, message) };
    case "note":
      return { ...state, notes: [message, ...state.notes].slice(0, notesKept) };
    case "health":
      return { ...state, health: message };
    case "belief":
      return { ...state, belief: message.samples };
    case "velocity_space":
      return { ...state, velocitySpace: message };
    case "scan": {
      const scans = [...state.scans];
      scans[message.laser === 1 ? 1 : 0] = message;
      return { ...state, scans, scanAt: now };
    }
    case "frame": // pictures go to the cameras directly
    case "visit":
    case "pong":
    case "lagging":
    case "error":
      return state;
  }
}

// Replayed events are older than they seem: how long the speech has been going on, in ms.
function spokenFor(state: State, speech: Speech): number {
  const newest = state.pose?.time ?? speech.time;
  return Math.max(0, (newest - speech.time) * 1000);
}

// The queue as a list is authoritative; a single request only updates what is there already, so that order never jumps.
function withRequest(queue: Request[] | null, request: Request): Request[] | null {
  return queue && queue.map((r) => (r.id === request.id ? { ...request, yours: request.yours || r.yours } : r));
}

export class Store {
  state: State = emptyState;
  private readonly listeners = new Set<() => void>();
  private scheduled = false;

  constructor(private readonly schedule: (run: () => void) => void) {}

  take(message: ServerMessage): void {
    this.state = reduce(this.state, message, Date.now());
    this.notify();
  }
  set(change: Partial<State>): void {
    this.state = { ...this.state, ...change };
    this.notify();
  }
  listen(listener: () => void): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  private notify(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    this.schedule(() => {
      this.scheduled = false;
      for (const listener of this.listeners) listener();
    });
  }
}

// ---- What several views ask of the state ---------------------------------------------------------------------------------

export function value<T>(loaded: Loaded<T>): T | null {
  return loaded.state === "ready" ? loaded.value : null;
}
export function exhibitById(state: State, id: string | null): Exhibit | null {
  return (id && value(state.exhibits)?.find((e) => e.id === id)) || null;
}
export function waiting(queue: Request[] | null): Request[] {
  return (queue ?? []).filter((r) => r.state === "active" || r.state === "pending").sort((a, b) => order(a) - order(b));
}
function order(r: Request): number {
  return r.state === "active" ? -1 : r.position;
}
// The exhibit the robot heads for or stands at.
export function nextExhibit(state: State): string | null {
  return state.status?.exhibit ?? null;
}
export function atExhibit(status: Status | null): boolean {
  return status !== null && status.exhibit !== null && (status.activity === "explaining" || status.activity === "asking");
}
// Seconds of travel, explanation or waiting left now: the status's figure, run down since it came.
export function secondsLeft(state: State, now: number): number | null {
  const left = state.status?.secondsToGo;
  return left === null || left === undefined ? null : Math.max(0, left - (now - state.statusAt) / 1000);
}
// The text now being said, or null when it is over.
export function saying(state: State, now: number): Speech | null {
  const { speech, speechAt } = state;
  return speech && now - speechAt < (speech.duration + 1.5) * 1000 ? speech : null;
}
