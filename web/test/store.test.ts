import { describe, expect, it } from "vitest";
import { atExhibit, emptyState, reduce, saying, secondsLeft, Store, waiting, type State } from "../src/store";
import type { Request, ServerMessage, Status } from "../src/wire/types";

const hello: ServerMessage = { type: "hello", epoch: "a", seq: 0, time: 0, site: "x", session: { name: "", staff: false } };
const pose: ServerMessage = { type: "pose", time: 10, x: 1, y: 2, theta: 0, sigmaPosition: 0, sigmaTheta: 0, localized: true, linear: 0, angular: 0 };
const speech: ServerMessage = { type: "speech", seq: 1, cue: "narration", exhibit: "orrery", narration: 0, text: { en: "Look." }, duration: 20, time: 10 };
const request = (id: string, state: Request["state"], position: number): Request => ({
  id, state, name: "", channel: "web", exhibit: "orrery", point: null, reason: "", position, etaSeconds: null, tour: "", asked: 0, yours: id === "2",
});
const play = (...messages: ServerMessage[]) => messages.reduce<State>((s, m) => reduce(s, m, 5_000), emptyState);

describe("reduce", () => {
  it("does not change the state it is given", () => {
    const before = structuredClone(emptyState);
    play(hello, pose, speech);
    expect(emptyState).toEqual(before);
  });
  it("forgets what the robot did in an earlier run of the server", () => {
    const state = play(hello, pose, speech, { ...hello, epoch: "b" });
    expect(state).toMatchObject({ epoch: "b", pose: null, speech: null, notes: [] });
  });
  it("keeps it when only the line was lost", () => {
    expect(play(hello, pose, hello).pose).toMatchObject({ x: 1 });
  });
  it("knows that a replayed speech began some time ago", () => {
    const state = play(hello, { ...pose, time: 16 }, speech);
    expect(saying(state, 5_000 + 15_000)).not.toBeNull();
    expect(saying(state, 5_000 + 16_000)).toBeNull();
  });
  it("updates a request in place and keeps whose it is", () => {
    const state = play(hello, { type: "queue", requests: [request("1", "active", 1), request("2", "pending", 2)] }, { type: "request", seq: 2, request: { ...request("2", "failed", 0), yours: false } });
    expect(state.queue!.map((r) => [r.id, r.state, r.yours])).toEqual([["1", "active", false], ["2", "failed", true]]);
  });
  it("keeps the newest notes only", () => {
    let state = emptyState;
    for (let seq = 1; seq <= 300; seq++) state = reduce(state, { type: "note", seq, severity: "info", code: "", text: "", time: seq }, 0);
    expect(state.notes).toHaveLength(200);
    expect(state.notes[0]!.seq).toBe(300);
  });
});

describe("what views ask", () => {
  it("waiting: the active one first, then by position, without those that ended", () => {
    const queue = [request("3", "pending", 3), request("2", "pending", 2), request("9", "fulfilled", 0), request("1", "active", 1)];
    expect(waiting(queue).map((r) => r.id)).toEqual(["1", "2", "3"]);
  });
  it("atExhibit: only while it explains or asks", () => {
    const status = { exhibit: "orrery", activity: "explaining" } as Status;
    expect(atExhibit(status)).toBe(true);
    expect(atExhibit({ ...status, activity: "driving" })).toBe(false);
    expect(atExhibit({ ...status, exhibit: null })).toBe(false);
  });
  it("secondsLeft runs down between two messages and not below nothing", () => {
    const state = { ...emptyState, status: { secondsToGo: 10 } as Status, statusAt: 1_000 };
    expect(secondsLeft(state, 4_000)).toBe(7);
    expect(secondsLeft(state, 60_000)).toBe(0);
    expect(secondsLeft(emptyState, 0)).toBeNull();
  });
});

describe("Store", () => {
  it("tells its listeners once for a burst of messages", () => {
    const scheduled: (() => void)[] = [];
    const store = new Store((run) => scheduled.push(run));
    let told = 0;
    store.listen(() => told++);
    for (let k = 0; k < 50; k++) store.take({ ...pose, time: k } as ServerMessage);
    expect(scheduled).toHaveLength(1);
    scheduled[0]!();
    expect(told).toBe(1);
    expect(store.state.pose!.time).toBe(49);
    store.take(hello);
    expect(scheduled).toHaveLength(2);
  });
});
