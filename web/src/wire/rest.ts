// The answers of the REST interface as typed values; also the pieces that messages share with them.
import { Reader } from "./check";
import type {
  Camera, Exhibit, MapInfo, Point, Pose, Problem, Request, Session, Site, Statistics, Status, Text, Tour,
} from "./types";

export function point(r: Reader): Point {
  return r.numbers(2) as Point;
}
export function pose(r: Reader): Pose {
  return { x: r.at("x").number(), y: r.at("y").number(), theta: r.at("theta").number() };
}
// {en, de}; a plain string stands for every language.
export function text(r: Reader): Text {
  if (typeof r.value === "string") return { en: r.value };
  const out: Text = { en: r.at("en").stringOr("") };
  for (const key of Object.keys(r.value as object)) out[key] = r.at(key).stringOr("");
  return out;
}
// A title as the wire has it: a plain string, and all languages under the plural name beside it.
function texts(r: Reader, one: string, all: string): Text {
  return r.at(all).missing ? text(r.at(one)) : text(r.at(all));
}
function optionalText(r: Reader): Text {
  return r.missing ? { en: "" } : text(r);
}

const modes = ["open", "web_only", "staff"] as const;
const activities = ["starting", "localizing", "idle", "homing", "driving", "waiting", "explaining", "asking", "stopped", "faulted"] as const;
export function decodeStatus(r: Reader): Status {
  const sigma = r.at("pose_sigma");
  const tour = r.at("tour");
  return {
    time: r.at("time").number(),
    pose: r.at("pose").missing ? null : pose(r.at("pose")),
    sigmaPosition: sigma.missing ? 0 : sigma.at("position").numberOr(0),
    sigmaTheta: sigma.missing ? 0 : sigma.at("theta").numberOr(0),
    mode: r.at("mode").oneOf(modes),
    activity: r.at("activity").oneOf(activities),
    why: r.at("why").stringOr("none"),
    reason: r.at("reason").stringOr(""),
    sentence: text(r.at("sentence")),
    detail: text(r.at("detail")),
    exhibit: r.at("exhibit").stringOr("") || null,
    requester: r.at("requester").stringOr(""),
    tour: tour.missing ? null : { id: tour.at("id").string(), stop: tour.at("stop").numberOr(0), stops: tour.at("stops").numberOr(0) },
    distanceToGo: r.at("distance_to_go").numberOr(null),
    secondsToGo: r.at("seconds_to_go").numberOr(null),
    peopleNear: r.at("people_near").numberOr(0),
    battery: r.at("battery").numberOr(null),
    speedLimit: r.at("speed_limit").numberOr(0),
    lost: r.at("lost").boolOr(false),
    stopped: r.at("stopped").boolOr(false),
  };
}

const states = ["pending", "active", "fulfilled", "cancelled", "failed"] as const;
export function decodeRequest(r: Reader): Request {
  const place = r.at("point");
  return {
    id: r.at("id").id(),
    state: r.at("state").oneOf(states),
    name: r.at("name").stringOr(""),
    channel: r.at("channel").stringOr(""),
    exhibit: r.at("exhibit").stringOr("") || null,
    point: place.missing ? null : Array.isArray(place.value)
      ? { x: place.numbers(place.value.length)[0]!, y: place.numbers(place.value.length)[1]! }
      : { x: place.at("x").number(), y: place.at("y").number() },
    reason: r.at("reason").stringOr(""),
    position: r.at("position").numberOr(0),
    etaSeconds: r.at("eta_seconds").numberOr(null),
    tour: r.at("tour").stringOr(""),
    asked: r.at("asked").numberOr(0),
    yours: r.at("yours").boolOr(false),
  };
}
export function decodeQueue(r: Reader): Request[] {
  return r.list(decodeRequest);
}

export function decodeSite(r: Reader): Site {
  const footprint = r.at("footprint");
  const speed = r.at("speed");
  return {
    id: r.at("id").string(),
    title: texts(r, "title", "titles"),
    width: r.at("width").number(),
    height: r.at("height").number(),
    resolution: r.at("resolution").number(),
    origin: { x: r.at("origin").at("x").number(), y: r.at("origin").at("y").number() },
    boundary: r.at("boundary").listOr(point),
    home: pose(r.at("home")),
    hazards: r.at("hazards").listOr((h) => ({
      id: h.at("id").stringOr(""), kind: h.at("kind").stringOr("keep_out"), title: h.at("titles").missing ? optionalText(h.at("title")) : text(h.at("titles")),
      polygon: h.at("polygon").list(point),
    })),
    areas: r.at("areas").listOr((a) => ({ title: texts(a, "title", "titles"), x: a.at("x").number(), y: a.at("y").number() })),
    speed: { open: speed.at("open").number(), web_only: speed.at("web_only").number(), staff: speed.at("staff").number() },
    footprint: {
      front: footprint.at("front").number(), rear: footprint.at("rear").number(), half_width: footprint.at("half_width").number(),
    },
    languages: r.at("languages").listOr((l) => l.string()),
  };
}

export function decodeExhibits(r: Reader): Exhibit[] {
  return r.list((e) => ({
    id: e.at("id").string(),
    number: e.at("number").numberOr(0),
    title: texts(e, "title", "titles"),
    summary: e.at("summaries").missing ? optionalText(e.at("summary")) : text(e.at("summaries")),
    x: e.at("x").number(),
    y: e.at("y").number(),
    outline: e.at("outline").listOr(point),
    icon: e.at("icon").stringOr(""),
    picture: e.at("picture").stringOr(""),
    viewpoints: e.at("viewpoints").listOr(pose),
    narrations: e.at("narrations").listOr((n) => ({
      text: texts(n, "text", "texts"), picture: n.at("picture").stringOr(""), duration: n.at("duration").numberOr(0),
    })),
  }));
}

export function decodeTours(r: Reader): Tour[] {
  return r.list((t) => ({
    id: t.at("id").string(),
    title: texts(t, "title", "titles"),
    summary: t.at("summaries").missing ? optionalText(t.at("summary")) : text(t.at("summaries")),
    exhibits: t.at("exhibits").list((e) => e.string()),
    minutes: t.at("minutes").numberOr(0),
  }));
}

const cameraKinds = ["onboard", "wall"] as const;
export function decodeCameras(r: Reader): Camera[] {
  return r.list((c) => ({
    id: c.at("id").string(), title: texts(c, "title", "titles"), kind: c.at("kind").oneOf(cameraKinds), width: c.at("width").number(),
    height: c.at("height").number(),
  }));
}

export function decodeMapInfo(r: Reader): MapInfo {
  return {
    width: r.at("width").number(), height: r.at("height").number(), resolution: r.at("resolution").number(),
    origin: { x: r.at("origin").at("x").number(), y: r.at("origin").at("y").number() }, url: r.at("url").string(),
  };
}

export function decodeSession(r: Reader): Session {
  return { name: r.at("name").stringOr(""), staff: r.at("staff").boolOr(false), languages: r.at("languages").listOr((l) => l.string()) };
}

export function decodeStatistics(r: Reader): Statistics {
  return {
    since: r.at("since").missing || typeof r.at("since").value === "string" ? 0 : r.at("since").number(),
    distanceM: r.at("distance_m").numberOr(0),
    hours: r.at("hours").numberOr(0),
    requests: r.at("requests").numberOr(0),
    fulfilled: r.at("fulfilled").numberOr(0),
    successRate: r.at("success_rate").numberOr(null),
    exhibits: r.at("exhibits").listOr((e) => ({ id: e.at("id").string(), visits: e.at("visits").numberOr(0), seconds: e.at("seconds").numberOr(0) })),
    viewers: r.at("viewers").numberOr(0),
  };
}

export function decodeProblem(value: unknown, status: number): Problem {
  const fallback: Problem = { title: "", status, detail: "", code: String(status) };
  try {
    const r = new Reader(value);
    const field = r.at("field").stringOr("");
    return {
      title: r.at("title").stringOr(""), status, detail: r.at("detail").stringOr(""), code: r.at("code").stringOr(String(status)),
      ...(field ? { field } : {}),
    };
  } catch {
    return fallback;
  }
}
