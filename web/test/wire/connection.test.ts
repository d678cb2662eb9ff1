import { beforeEach, describe, expect, it } from "vitest";
import { Connection, retryDelay, type Link, type SocketLike } from "../../src/wire/connection";
import type { ServerMessage } from "../../src/wire/types";

class FakeSocket implements SocketLike {
  binaryType = "";
  onopen: (() => void) | null = null;
  onclose: (() => void) | null = null;
  onerror: (() => void) | null = null;
  onmessage: ((event: { data: unknown }) => void) | null = null;
  sent: Record<string, unknown>[] = [];
  closed = false;
  send(text: string): void {
    this.sent.push(JSON.parse(text));
  }
  close(): void {
    this.closed = true;
  }
  say(message: unknown): void {
    this.onmessage?.({ data: JSON.stringify(message) });
  }
}

// Time that only the test moves.
class Surroundings {
  time = 1_000_000;
  sockets: FakeSocket[] = [];
  timers: { at: number; run: () => void }[] = [];
  open(): SocketLike {
    const socket = new FakeSocket();
    this.sockets.push(socket);
    return socket;
  }
  now(): number {
    return this.time;
  }
  random(): number {
    return 0.5;
  }
  after(ms: number, run: () => void): () => void {
    const timer = { at: this.time + ms, run };
    this.timers.push(timer);
    return () => void (this.timers = this.timers.filter((t) => t !== timer));
  }
  pass(ms: number): void {
    const end = this.time + ms;
    for (;;) {
      const next = this.timers.filter((t) => t.at <= end).sort((a, b) => a.at - b.at)[0];
      if (!next) break;
      this.timers = this.timers.filter((t) => t !== next);
      this.time = next.at;
      next.run();
    }
    this.time = end;
  }
  get newest(): FakeSocket {
    return this.sockets.at(-1)!;
  }
}

const hello = (epoch: string, seq: number) => ({ type: "hello", epoch, seq, time: 1, site: "x", session: { name: "", staff: false } });
const note = (seq: number) => ({ type: "note", seq, severity: "info", code: "c", text: `${seq}`, time: 1 });

describe("Connection", () => {
  let around: Surroundings, got: ServerMessage[], links: Link[], line: Connection;
  beforeEach(() => {
    around = new Surroundings();
    got = [];
    links = [];
    line = new Connection(around, (m) => got.push(m), (l) => links.push(l));
    line.subscribe(["pose", "status"]);
    line.start();
    around.newest.onopen!();
  });

  it("says what it wants to hear as soon as it is open", () => {
    expect(around.newest.sent[0]).toEqual({ type: "subscribe", topics: ["pose", "status"] });
  });
  it("is live with the first message and tells how long the way there and back takes", () => {
    around.newest.say(hello("a", 0));
    around.time += 42;
    around.newest.say({ type: "pong", id: 1 });
    expect(line.link).toMatchObject({ state: "live", latency: 42, heardAt: around.time });
  });
  it("sends new topics at once and not twice", () => {
    line.subscribe(["pose"]);
    line.subscribe(["pose"]);
    expect(around.newest.sent.filter((m) => m.type === "subscribe")).toHaveLength(2);
  });
  it("comes back by itself and catches up from the last event", () => {
    around.newest.say(hello("a", 3));
    around.newest.say(note(4));
    around.newest.onclose!();
    expect(line.link.state).toBe("lost");
    expect(line.link.retryAt).toBe(around.time + 375);
    around.pass(375);
    expect(around.sockets).toHaveLength(2);
    around.newest.onopen!();
    around.newest.say(hello("a", 6));
    expect(around.newest.sent.at(-1)).toEqual({ type: "resume", epoch: "a", last_seq: 4 });
    [4, 5, 6].forEach((seq) => around.newest.say(note(seq)));
    expect(got.filter((m) => m.type === "note").map((m) => "seq" in m && m.seq)).toEqual([4, 5, 6]);
  });
  it("does not ask another run of the server for events of the old one", () => {
    around.newest.say(hello("a", 30));
    around.newest.onclose!();
    around.pass(1000);
    around.newest.onopen!();
    around.newest.say(hello("b", 2));
    expect(around.newest.sent.some((m) => m.type === "resume")).toBe(false);
    around.newest.say(note(3));
    expect(got.at(-1)).toMatchObject({ type: "note", seq: 3 });
  });
  it("waits longer after every failure, and only so long", () => {
    const waits: number[] = [];
    for (let k = 0; k < 9; k++) {
      around.newest.onclose!();
      waits.push(line.link.retryAt! - around.time);
      around.pass(waits.at(-1)!);
    }
    expect(waits.slice(0, 3)).toEqual([375, 750, 1500]);
    expect(Math.max(...waits)).toBe(11_250);
  });
  it("tries at once when asked to", () => {
    around.newest.onclose!();
    line.retryNow();
    expect(around.sockets).toHaveLength(2);
    around.pass(60_000);
    expect(around.sockets.filter((s) => !s.closed).length).toBeLessThanOrEqual(2);
  });
  it("gives up a line that has gone silent", () => {
    around.newest.say(hello("a", 0));
    around.pass(8_000);
    expect(line.link.state).toBe("live");
    around.pass(5_000);
    expect(around.sockets[0]!.closed).toBe(true);
    expect(line.link.state).toBe("lost");
  });
  it("passes over broken messages and stays", () => {
    around.newest.say(hello("a", 0));
    const warn = console.warn;
    console.warn = () => {};
    around.newest.say({ type: "people", people: "many" });
    around.newest.onmessage!({ data: "not json" });
    around.newest.onmessage!({ data: new ArrayBuffer(3) });
    console.warn = warn;
    around.newest.say({ type: "viewers", count: 5 });
    expect(got.at(-1)).toMatchObject({ type: "viewers", count: 5 });
  });
});

describe("retryDelay", () => {
  it("spreads viewers over half of the span", () => {
    expect(retryDelay(0, 0)).toBe(250);
    expect(retryDelay(0, 0.999)).toBeLessThan(500);
    expect(retryDelay(50, 1)).toBe(15_000);
  });
});
