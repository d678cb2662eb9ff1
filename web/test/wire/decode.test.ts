import { describe, expect, it } from "vitest";
import { decodeBinary, DecodeError, decodeMessage, decodeText } from "../../src/wire/decode";
import { randomOf } from "../random";

function scanBytes(count: number): ArrayBuffer {
  const buffer = new ArrayBuffer(32 + 5 * count), view = new DataView(buffer);
  view.setUint8(0, 1);
  view.setUint8(1, 1);
  view.setUint16(2, count, true);
  view.setFloat64(4, 12.5, true);
  [1, 2, 0.5, -1.5, 0.01].forEach((v, i) => view.setFloat32(12 + 4 * i, v, true));
  for (let k = 0; k < count; k++) {
    view.setFloat32(32 + 4 * k, k === 0 ? NaN : k, true);
    view.setUint8(32 + 4 * count + k, k % 4);
  }
  return buffer;
}

const status = {
  type: "status", time: 3, pose: { x: 1, y: 2, theta: 0.1 }, pose_sigma: { position: 0.02, theta: 0.01 }, mode: "open", activity: "driving", why: "requested",
  reason: "", sentence: { en: "I am on my way.", de: "Ich bin unterwegs." }, detail: { en: "", de: "" }, exhibit: "orrery", requester: null, tour: null,
  distance_to_go: 3.2, seconds_to_go: null, people_near: 2, battery: null, speed_limit: 0.7, lost: false, stopped: false,
};

describe("text messages", () => {
  it("become typed values", () => {
    const message = decodeText(JSON.stringify(status));
    expect(message).toMatchObject({ type: "status", distanceToGo: 3.2, secondsToGo: null, requester: "", exhibit: "orrery", battery: null });
  });
  it("may lack a pose before the robot has looked round", () => {
    expect(decodeMessage({ ...status, pose: null, pose_sigma: null })).toMatchObject({ pose: null, sigmaPosition: 0 });
  });
  it("of an unknown type are passed over", () => {
    expect(decodeMessage({ type: "weather", sunny: true })).toBeNull();
  });
  it("that are wrong name the field and what was expected", () => {
    expect(() => decodeMessage({ ...status, mode: "closed" })).toThrow(/^mode: expected one of open, web_only, staff, got "closed"/);
    expect(() => decodeMessage({ type: "people", time: 1, people: [[1, 2], [3]] })).toThrow(/^people\[1\]: expected 2 numbers/);
    expect(() => decodeMessage({ type: "pose", time: 1, x: "1", y: 0, theta: 0, localized: true })).toThrow(/^x: expected a number/);
    expect(() => decodeText("{")).toThrow(DecodeError);
    expect(() => decodeMessage([])).toThrow(DecodeError);
    expect(() => decodeMessage({ type: "velocity_space", linear: [0, 1], angular: [0], score: [1], chosen: {} })).toThrow(/^score: expected 2 numbers/);
  });
  it("do not take fields from the prototype", () => {
    expect(() => decodeMessage(JSON.parse('{"__proto__": {"type": "pong", "id": 1}}'))).toThrow(DecodeError);
  });
  it("never throw anything but DecodeError, whatever is changed in them", () => {
    const random = randomOf(7);
    const junk = [null, undefined, -1, "", "x", [], {}, NaN, true, [[1]], { en: 3 }, 1e308];
    for (let round = 0; round < 4000; round++) {
      const copy: Record<string, unknown> = structuredClone(status);
      const keys = Object.keys(copy).filter((k) => k !== "type");
      for (let n = 0; n < 1 + random() * 3; n++) copy[keys[Math.floor(random() * keys.length)]!] = junk[Math.floor(random() * junk.length)];
      try {
        decodeMessage(copy);
      } catch (error) {
        expect(error).toBeInstanceOf(DecodeError);
      }
    }
  });
});

describe("binary messages", () => {
  it("carry scans", () => {
    const message = decodeBinary(scanBytes(5));
    if (message?.type !== "scan") throw new Error("not a scan");
    expect(message.laser).toBe(1);
    expect(message.time).toBe(12.5);
    expect(message.pose).toEqual({ x: 1, y: 2, theta: 0.5 });
    expect([...message.ranges]).toEqual([NaN, 1, 2, 3, 4]);
    expect([...message.kinds]).toEqual([0, 1, 2, 3, 0]);
  });
  it("carry frames", () => {
    const buffer = new ArrayBuffer(15), view = new DataView(buffer);
    view.setUint8(0, 3);
    view.setUint8(1, 2);
    view.setFloat64(4, 9, true);
    new Uint8Array(buffer).set([0xff, 0xd8, 0xff], 12);
    expect(decodeBinary(buffer)).toMatchObject({ type: "frame", camera: 2, time: 9, jpeg: new Uint8Array([0xff, 0xd8, 0xff]) });
  });
  it("that are cut, too long or empty are refused", () => {
    for (const length of [0, 1, 11, 31, 56, 58]) {
      const cut = new ArrayBuffer(length);
      new Uint8Array(cut).set(new Uint8Array(scanBytes(5)).slice(0, Math.min(length, 57)));
      expect(() => decodeBinary(cut), `${length} bytes`).toThrow(DecodeError);
    }
    expect(() => decodeBinary(new Uint8Array([3, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]).buffer)).toThrow(DecodeError);
  });
  it("of random bytes decode or are refused", () => {
    const random = randomOf(11);
    for (let round = 0; round < 5000; round++) {
      const bytes = Uint8Array.from({ length: Math.floor(random() * 120) }, () => random() * 256);
      if (random() < 0.7 && bytes.length > 0) bytes[0] = random() < 0.5 ? 1 : 3;
      try {
        decodeBinary(bytes.buffer);
      } catch (error) {
        expect(error).toBeInstanceOf(DecodeError);
      }
    }
  });
});
