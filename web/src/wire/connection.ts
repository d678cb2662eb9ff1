// The one WebSocket of a page: subscribes, resumes events after a break, measures the line and comes back by itself.
// Alone in knowing sockets; hands decoded messages on.
import { decodeBinary, decodeText } from "./decode";
import type { ClientMessage, ServerMessage } from "./types";

export type LinkState = "connecting" | "live" | "lost";

export interface Link {
  state: LinkState;
  latency: number | null; // ms, there and back
  heardAt: number | null; // wall clock ms of the last message
  retryAt: number | null; // wall clock ms of the next attempt
}

// What a connection needs from its surroundings; tests bring their own.
export interface Surroundings {
  open(): SocketLike;
  now(): number; // ms
  after(ms: number, run: () => void): () => void; // returns: cancel
  random(): number; // 0..1
}
export interface SocketLike {
  binaryType: string;
  onopen: (() => void) | null;
  onclose: (() => void) | null;
  onerror: (() => void) | null;
  onmessage: ((event: { data: unknown }) => void) | null;
  send(text: string): void;
  close(): void;
}

const firstRetry = 500; // ms
const longestRetry = 15_000;
const pingEvery = 4_000;
const silenceLimit = 9_000; // nothing heard for this long, pongs included: the line is dead

// Full jitter on the upper half: viewers do not all come back in the same moment.
export function retryDelay(attempt: number, random: number): number {
  const span = Math.min(longestRetry, firstRetry * 2 ** Math.min(attempt, 10));
  return span / 2 + (span / 2) * random;
}

export class Connection {
  link: Link = { state: "connecting", latency: null, heardAt: null, retryAt: null };

  private socket: SocketLike | null = null;
  private topics: string[] = [];
  private epoch: string | null = null;
  private lastSeq = 0;
  private attempt = 0;
  private pingId = 0;
  private pingSent = 0;
  private cancelRetry: (() => void) | null = null;
  private cancelPing: (() => void) | null = null;

  constructor(
    private readonly around: Surroundings,
    private readonly onMessage: (message: ServerMessage) => void,
    private readonly onLink: (link: Link) => void,
  ) {}

  start(): void {
    this.connect();
  }

  // Replaces the topics; told to the server at once and after every reconnect.
  subscribe(topics: string[]): void {
    if (topics.length === this.topics.length && topics.every((t, i) => t === this.topics[i])) return;
    this.topics = topics;
    this.send({ type: "subscribe", topics });
  }

  // Do not wait for the next attempt.
  retryNow(): void {
    if (this.link.state === "live" || this.socket) return;
    this.cancelRetry?.();
    this.connect();
  }

  private connect(): void {
    this.cancelRetry = null;
    const socket = this.around.open();
    this.socket = socket;
    socket.binaryType = "arraybuffer";
    socket.onopen = () => this.opened(socket);
    socket.onmessage = (event) => this.received(socket, event.data);
    socket.onclose = () => this.closed(socket);
    socket.onerror = () => {}; // a close follows
    this.watchSilence(socket, this.around.now());
  }

  private opened(socket: SocketLike): void {
    if (socket !== this.socket) return;
    if (this.topics.length > 0) this.send({ type: "subscribe", topics: this.topics });
    this.ping();
  }

  private received(socket: SocketLike, data: unknown): void {
    if (socket !== this.socket) return;
    const heardAt = this.around.now();
    const wasLive = this.link.state === "live";
    this.link = { ...this.link, heardAt };
    let message: ServerMessage | null;
    try {
      message = typeof data === "string" ? decodeText(data) : decodeBinary(data as ArrayBuffer);
    } catch (error) {
      console.warn("ignored a message:", (error as Error).message);
      return;
    }
    if (!wasLive) {
      this.attempt = 0;
      this.setLink({ state: "live", retryAt: null });
    }
    if (message) this.take(message);
  }

  private take(message: ServerMessage): void {
    if (message.type === "hello") {
      if (this.epoch === message.epoch && message.seq > this.lastSeq) {
        this.send({ type: "resume", epoch: message.epoch, last_seq: this.lastSeq });
      } else {
        this.lastSeq = message.seq;
      }
      this.epoch = message.epoch;
    } else if (message.type === "pong") {
      if (message.id === this.pingId) this.setLink({ latency: Math.round(this.around.now() - this.pingSent) });
      return;
    } else if ("seq" in message) {
      if (message.seq <= this.lastSeq) return; // seen before the break
      this.lastSeq = message.seq;
    }
    this.onMessage(message);
  }

  private closed(socket: SocketLike): void {
    if (socket !== this.socket) return;
    this.socket = null;
    this.cancelPing?.();
    const delay = retryDelay(this.attempt++, this.around.random());
    this.cancelRetry = this.around.after(delay, () => this.connect());
    this.setLink({ state: "lost", latency: null, retryAt: this.around.now() + delay });
  }

  private ping(): void {
    this.pingSent = this.around.now();
    this.send({ type: "ping", id: ++this.pingId });
  }

  // Half-open lines give no close event: whoever says nothing for too long is gone.
  private watchSilence(socket: SocketLike, since: number): void {
    this.cancelPing = this.around.after(pingEvery, () => {
      if (socket !== this.socket) return;
      const heard = Math.max(since, this.link.heardAt ?? 0);
      if (this.around.now() - heard > silenceLimit) {
        socket.close();
        this.closed(socket);
        return;
      }
      if (this.link.state === "live") this.ping();
      this.watchSilence(socket, since);
    });
  }

  private send(message: ClientMessage): void {
    if (!this.socket) return;
    try {
      this.socket.send(JSON.stringify(message));
    } catch {
      // not open yet: opened() says it again
    }
  }

  private setLink(change: Partial<Link>): void {
    this.link = { ...this.link, ...change };
    this.onLink(this.link);
  }
}

export function browserSurroundings(path: string): Surroundings {
  return {
    open: () => new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}${path}`) as unknown as SocketLike,
    now: () => Date.now(),
    after: (ms, run) => {
      const id = setTimeout(run, ms);
      return () => clearTimeout(id);
    },
    random: Math.random,
  };
}
