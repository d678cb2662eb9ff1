// The wire between Docent and this page, as typed values (protocols/web/README.md). SI units, radians, map frame; times are
// seconds since the run's start. Imports nothing.

export type Lang = "en" | "de";
export type Text = { en: string; [lang: string]: string };
export type Point = [number, number];
export interface Pose {
  x: number;
  y: number;
  theta: number;
}

export type Mode = "open" | "web_only" | "staff";
export type Activity =
  | "starting" | "localizing" | "idle" | "homing" | "driving" | "waiting" | "explaining" | "asking" | "stopped" | "faulted";

export interface Status {
  time: number;
  pose: Pose | null; // before the robot has looked round
  sigmaPosition: number; // m
  sigmaTheta: number; // rad
  mode: Mode;
  activity: Activity;
  why: string;
  reason: string;
  sentence: Text;
  detail: Text;
  exhibit: string | null;
  requester: string;
  tour: { id: string; stop: number; stops: number } | null;
  distanceToGo: number | null; // m
  secondsToGo: number | null;
  peopleNear: number;
  battery: number | null; // 0..1
  speedLimit: number; // m/s
  lost: boolean;
  stopped: boolean;
}

export interface PoseUpdate extends Pose {
  time: number;
  sigmaPosition: number;
  sigmaTheta: number;
  localized: boolean;
  linear: number; // m/s
  angular: number; // rad/s
}

export type RequestState = "pending" | "active" | "fulfilled" | "cancelled" | "failed";
export interface Request {
  id: string;
  state: RequestState;
  name: string;
  channel: string;
  exhibit: string | null;
  point: { x: number; y: number } | null;
  reason: string;
  position: number;
  etaSeconds: number | null;
  tour: string;
  asked: number;
  yours: boolean;
}

export interface Speech {
  seq: number;
  cue: string; // narration, greeting, make_way, horn, arrived, farewell
  exhibit: string | null;
  narration: number;
  text: Text;
  duration: number;
  time: number;
}

export interface Note {
  seq: number;
  severity: "info" | "warning" | "incident";
  code: string;
  text: string;
  time: number;
}

export interface Device {
  device: string;
  connected: boolean;
  reason: string;
  ageSeconds: number | null;
  rateHz: number | null;
}
export interface Health {
  devices: Device[];
  localization: { localized: boolean; sigmaPosition: number | null; sigmaTheta: number | null; particles: number };
  viewers: number;
  notes: Omit<Note, "seq">[];
}

export interface VelocitySpace {
  linear: number[]; // m/s
  angular: number[]; // rad/s
  score: (number | null)[]; // linear-major; null: would hit, or out of reach
  chosen: { linear: number; angular: number };
}

export enum BeamKind {
  none = 0,
  map = 1,
  person = 2,
  far = 3,
}
export interface Scan {
  laser: number; // 0 front, 1 rear
  time: number;
  pose: Pose; // map_from_laser
  angleMin: number;
  angleStep: number;
  ranges: Float32Array; // m, NaN: no return
  kinds: Uint8Array;
}
export interface Frame {
  camera: number; // index as in GET cameras
  time: number;
  jpeg: Uint8Array;
}

export type ServerMessage =
  | { type: "hello"; epoch: string; seq: number; time: number; site: string; session: { name: string; staff: boolean } }
  | ({ type: "pose" } & PoseUpdate)
  | ({ type: "status" } & Status)
  | { type: "path"; points: Point[]; length: number }
  | { type: "people"; time: number; people: Point[] }
  | { type: "queue"; requests: Request[] }
  | { type: "viewers"; count: number }
  | ({ type: "health" } & Health)
  | { type: "belief"; time: number; samples: [number, number, number][] }
  | ({ type: "velocity_space" } & VelocitySpace)
  | ({ type: "speech" } & Speech)
  | { type: "request"; seq: number; request: Request }
  | ({ type: "note" } & Note)
  | { type: "visit"; seq: number }
  | { type: "pong"; id: number }
  | { type: "lagging"; dropped: number }
  | { type: "error"; code: string; detail: string }
  | ({ type: "scan" } & Scan)
  | ({ type: "frame" } & Frame);

export type ClientMessage =
  | { type: "subscribe"; topics: string[] }
  | { type: "resume"; epoch: string; last_seq: number }
  | { type: "ping"; id: number };

// ---- REST -------------------------------------------------------------------------------------------------------------

export interface Site {
  id: string;
  title: Text;
  width: number; // cells
  height: number; // cells
  resolution: number; // m per cell
  origin: { x: number; y: number };
  boundary: Point[];
  home: Pose;
  hazards: { id: string; kind: string; title: Text; polygon: Point[] }[];
  areas: { title: Text; x: number; y: number }[];
  speed: { open: number; web_only: number; staff: number };
  footprint: { front: number; rear: number; half_width: number };
  languages: string[];
}

export interface Narration {
  text: Text;
  picture: string;
  duration: number;
}
export interface Exhibit {
  id: string;
  number: number;
  title: Text;
  summary: Text;
  x: number;
  y: number;
  outline: Point[];
  icon: string;
  picture: string;
  viewpoints: Pose[];
  narrations: Narration[];
}

export interface Tour {
  id: string;
  title: Text;
  summary: Text;
  exhibits: string[];
  minutes: number;
}

export interface Camera {
  id: string;
  title: Text;
  kind: "onboard" | "wall";
  width: number;
  height: number;
}

export interface MapInfo {
  width: number; // cells
  height: number; // cells
  resolution: number;
  origin: { x: number; y: number };
  url: string;
}

export interface Session {
  name: string;
  staff: boolean;
  languages: string[];
}

export interface Statistics {
  since: number;
  distanceM: number;
  hours: number;
  requests: number;
  fulfilled: number;
  successRate: number | null;
  exhibits: { id: string; visits: number; seconds: number }[];
  viewers: number;
}

// RFC 9457, as every error of the server.
export interface Problem {
  title: string;
  status: number;
  detail: string;
  code: string;
  field?: string;
}
