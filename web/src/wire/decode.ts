// What the server sends, from unknown bytes to typed values. Nothing else in the page looks at raw messages.
import { DecodeError, Reader } from "./check";
import { decodeQueue, decodeRequest, decodeStatus, point, pose, text } from "./rest";
import type { Health, Note, ServerMessage, Speech, VelocitySpace } from "./types";

export { DecodeError } from "./check";

export function decodeText(line: string): ServerMessage | null {
  let value: unknown;
  try {
    value = JSON.parse(line);
  } catch {
    throw new DecodeError("", "JSON", line);
  }
  return decodeMessage(value);
}

// null: a type this page does not know; newer servers may send more.
export function decodeMessage(value: unknown): ServerMessage | null {
  const r = new Reader(value);
  const type = r.at("type").string();
  switch (type) {
    case "hello":
      return {
        type, epoch: r.at("epoch").id(), seq: r.at("seq").number(), time: r.at("time").number(), site: siteId(r.at("site")),
        session: { name: r.at("session").at("name").stringOr(""), staff: r.at("session").at("staff").boolOr(false) },
      };
    case "pose":
      return {
        type, time: r.at("time").number(), ...pose(r), sigmaPosition: r.at("sigma_position").numberOr(0),
        sigmaTheta: r.at("sigma_theta").numberOr(0), localized: r.at("localized").bool(), linear: r.at("linear").numberOr(0),
        angular: r.at("angular").numberOr(0),
      };
    case "status":
      return { type, ...decodeStatus(r) };
    case "path":
      return { type, points: r.at("points").list(point), length: r.at("length").numberOr(0) };
    case "people":
      return { type, time: r.at("time").number(), people: r.at("people").list(point) };
    case "queue":
      return { type, requests: decodeQueue(r.at("requests")) };
    case "viewers":
      return { type, count: r.at("count").number() };
    case "health":
      return { type, ...decodeHealth(r) };
    case "belief":
      return { type, time: r.at("time").number(), samples: r.at("samples").list((s) => s.numbers(3) as [number, number, number]) };
    case "velocity_space":
      return { type, ...velocitySpace(r) };
    case "speech":
      return { type, ...speech(r) };
    case "request":
      return { type, seq: r.at("seq").number(), request: decodeRequest(r.at("request")) };
    case "note":
      return { type, ...note(r) };
    case "visit":
      return { type, seq: r.at("seq").number() };
    case "pong":
      return { type, id: r.at("id").number() };
    case "lagging":
      return { type, dropped: r.at("dropped").number() };
    case "error":
      return { type, code: r.at("code").stringOr("error"), detail: r.at("detail").stringOr("") };
    default:
      return null;
  }
}

function siteId(r: Reader): string {
  return typeof r.value === "object" && r.value !== null ? r.at("id").string() : r.stringOr("");
}

function speech(r: Reader): Speech {
  return {
    seq: r.at("seq").number(), cue: r.at("cue").string(), exhibit: r.at("exhibit").stringOr("") || null,
    narration: r.at("narration").numberOr(0), text: text(r.at("text")), duration: r.at("duration").number(), time: r.at("time").number(),
  };
}

const severities = ["info", "warning", "incident"] as const;
function note(r: Reader): Note {
  return { seq: r.at("seq").number(), ...noteBody(r) };
}
function noteBody(r: Reader): Omit<Note, "seq"> {
  return {
    severity: r.at("severity").oneOf(severities), code: r.at("code").stringOr(""), text: r.at("text").string(), time: r.at("time").numberOr(0),
  };
}

export function decodeHealth(r: Reader): Health {
  const where = r.at("localization");
  return {
    devices: r.at("devices").list((d) => ({
      device: d.at("device").string(), connected: d.at("connected").bool(), reason: d.at("reason").stringOr(""),
      ageSeconds: d.at("age_seconds").numberOr(null), rateHz: d.at("rate_hz").numberOr(null),
    })),
    localization: {
      localized: where.at("localized").boolOr(false), sigmaPosition: where.at("sigma_position").numberOr(null),
      sigmaTheta: where.at("sigma_theta").numberOr(null), particles: where.at("particles").numberOr(0),
    },
    viewers: r.at("viewers").numberOr(0),
    notes: r.at("notes").listOr(noteBody),
  };
}

function velocitySpace(r: Reader): VelocitySpace {
  const linear = r.at("linear").list((n) => n.number());
  const angular = r.at("angular").list((n) => n.number());
  const score = r.at("score").list((n) => n.numberOr(null));
  if (score.length !== linear.length * angular.length) throw new DecodeError("score", `${linear.length * angular.length} numbers`, score.length);
  const chosen = r.at("chosen");
  return { linear, angular, score, chosen: { linear: chosen.at("linear").numberOr(0), angular: chosen.at("angular").numberOr(0) } };
}

// Binary messages, little-endian; the first byte says which.
const scanHeader = 32;
const frameHeader = 12;
export function decodeBinary(buffer: ArrayBuffer): ServerMessage | null {
  if (buffer.byteLength < 1) throw new DecodeError("", "a binary message", null);
  const view = new DataView(buffer);
  switch (view.getUint8(0)) {
    case 1:
      return decodeScan(buffer, view);
    case 3:
      if (buffer.byteLength <= frameHeader) throw new DecodeError("frame", `more than ${frameHeader} bytes`, buffer.byteLength);
      return { type: "frame", camera: view.getUint8(1), time: view.getFloat64(4, true), jpeg: new Uint8Array(buffer, frameHeader) };
    default:
      return null;
  }
}

function decodeScan(buffer: ArrayBuffer, view: DataView): ServerMessage {
  if (buffer.byteLength < scanHeader) throw new DecodeError("scan", `at least ${scanHeader} bytes`, buffer.byteLength);
  const count = view.getUint16(2, true);
  const wanted = scanHeader + count * 5;
  if (buffer.byteLength !== wanted) throw new DecodeError("scan", `${wanted} bytes for ${count} beams`, buffer.byteLength);
  const ranges = new Float32Array(count);
  for (let i = 0; i < count; i++) ranges[i] = view.getFloat32(scanHeader + 4 * i, true);
  return {
    type: "scan",
    laser: view.getUint8(1),
    time: view.getFloat64(4, true),
    pose: { x: view.getFloat32(12, true), y: view.getFloat32(16, true), theta: view.getFloat32(20, true) },
    angleMin: view.getFloat32(24, true),
    angleStep: view.getFloat32(28, true),
    ranges,
    kinds: new Uint8Array(buffer.slice(scanHeader + 4 * count)),
  };
}
