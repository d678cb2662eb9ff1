// What every page shares: its store, its line to the server, its preferences, and how views follow them.
import type { ReactiveController, ReactiveControllerHost } from "lit";
import { api, ProblemError } from "./api";
import { isLang, pick, wordsOf, type Words } from "./i18n";
import { Store, type Loaded, type MapImage, type State, type Theme } from "./store";
import { browserSurroundings, Connection } from "./wire/connection";
import type { Frame, Lang, MapInfo, Problem, Text } from "./wire/types";

export const store = new Store((run) => (document.hidden ? setTimeout(run, 250) : requestAnimationFrame(run)));

// ---- Camera pictures: the newest of each camera, straight to whoever shows it --------------------------------------------

const frameListeners = new Set<(frame: Frame) => void>();
export function onFrame(listener: (frame: Frame) => void): () => void {
  frameListeners.add(listener);
  return () => frameListeners.delete(listener);
}

export const connection = new Connection(
  browserSurroundings("/ws"),
  (message) => {
    if (message.type === "frame") {
      for (const listener of frameListeners) listener(message);
      return;
    }
    const epoch = store.state.epoch;
    store.take(message);
    if (message.type !== "hello") return;
    if (epoch !== "" && epoch !== message.epoch) loadMuseum();
    api.queue().then((queue) => store.set({ queue }), () => {}); // also when nobody has asked for anything yet
  },
  (link) => store.set({ link }),
);

// ---- The museum's files --------------------------------------------------------------------------------------------------

type Part = "site" | "exhibits" | "tours" | "cameras" | "map";
const loaders: { [P in Part]: () => Promise<unknown> } = {
  site: api.site, exhibits: api.exhibits, tours: api.tours, cameras: api.cameras, map: loadMap,
};

export function loadMuseum(parts: Part[] = ["site", "exhibits", "tours", "cameras", "map"]): void {
  for (const part of parts) void loadPart(part, 0);
}

const tries = 3;
async function loadPart(part: Part, attempt: number): Promise<void> {
  if (store.state[part].state === "failed") store.set({ [part]: { state: "loading" } } as Partial<State>);
  try {
    const loaded: Loaded<unknown> = { state: "ready", value: await loaders[part]() };
    store.set({ [part]: loaded } as Partial<State>);
  } catch (error) {
    if (attempt + 1 < tries) {
      setTimeout(() => void loadPart(part, attempt + 1), 700 * 2 ** attempt);
    } else if (store.state[part].state !== "ready") {
      const problem = problemOf(error);
      store.set({ [part]: { state: "failed", problem: { ...problem, code: `${part}: ${problem.status || problem.code}` } } } as Partial<State>);
    }
  }
}

async function loadMap(): Promise<MapImage> {
  const info = await api.map();
  const answer = await fetch(info.url, { credentials: "same-origin" });
  if (!answer.ok) throw new ProblemError({ title: "", status: answer.status, detail: "", code: "map_png" });
  return { ...info, cells: await greyCells(await answer.blob(), info) };
}

// The picture's grey values with row 0 at the bottom, as the map frame has it.
async function greyCells(picture: Blob, info: MapInfo): Promise<Uint8Array> {
  const bitmap = await createImageBitmap(picture, { colorSpaceConversion: "none", premultiplyAlpha: "none" });
  if (bitmap.width !== info.width || bitmap.height !== info.height) {
    throw new ProblemError({ title: "", status: 0, detail: "", code: "size" });
  }
  const canvas = document.createElement("canvas");
  canvas.width = info.width;
  canvas.height = info.height;
  const context = canvas.getContext("2d", { willReadFrequently: true })!;
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  const { data } = context.getImageData(0, 0, info.width, info.height);
  const cells = new Uint8Array(info.width * info.height);
  for (let row = 0; row < info.height; row++) {
    const to = (info.height - 1 - row) * info.width, from = row * info.width;
    for (let i = 0; i < info.width; i++) cells[to + i] = data[(from + i) * 4]!;
  }
  return cells;
}

// ---- Start ---------------------------------------------------------------------------------------------------------------

let wanted: string[] = [];
let watched: string[] = []; // ids of the cameras being shown
const always = ["pose", "status", "queue", "speech", "request", "viewers"];

// The pictures of these cameras and no others.
export function watchCameras(ids: string[]): void {
  watched = ids;
  subscribe();
}

// While nobody looks, only what is needed to be right at the next look.
function subscribe(): void {
  connection.subscribe(document.hidden ? always : [...new Set([...always, ...wanted, ...watched.map((id) => `camera:${id}`)])]);
}

export function start(topics: string[]): void {
  wanted = topics;
  restorePrefs();
  subscribe();
  connection.start();
  loadMuseum();
  api.session().then((session) => {
    store.set({ session });
    if (!store.state.prefs.name && session.name) setPrefs({ name: session.name });
  }, () => {});
  document.addEventListener("visibilitychange", () => {
    subscribe();
    if (!document.hidden) connection.retryNow();
  });
  window.addEventListener("online", () => connection.retryNow());
}

// ---- Preferences ---------------------------------------------------------------------------------------------------------

const remembered = (key: string) => {
  try {
    return localStorage.getItem(`docent.${key}`);
  } catch {
    return null; // storage is off: nothing is remembered, everything works
  }
};
const remember = (key: string, text: string) => {
  try {
    localStorage.setItem(`docent.${key}`, text);
  } catch {
    // as above
  }
};

function restorePrefs(): void {
  const asked = new URLSearchParams(location.search);
  const langs = [asked.get("lang"), remembered("lang"), ...navigator.languages.map((l) => l.slice(0, 2))];
  const themes = [asked.get("theme"), remembered("theme"), matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light"];
  const theme = themes.find((t) => t === "light" || t === "dark") as Theme;
  apply({ lang: langs.find(isLang) ?? "en", theme, name: remembered("name") ?? "" });
}

export function setPrefs(change: Partial<State["prefs"]>): void {
  for (const [key, text] of Object.entries(change)) remember(key, text);
  apply({ ...store.state.prefs, ...change });
}
function apply(prefs: State["prefs"]): void {
  store.set({ prefs });
  document.documentElement.lang = prefs.lang;
  document.documentElement.dataset.theme = prefs.theme;
}

export function lang(): Lang {
  return store.state.prefs.lang;
}
export function t(): Words {
  return wordsOf(lang());
}
export function say(text: Text): string {
  return pick(text, lang());
}

// ---- Problems ------------------------------------------------------------------------------------------------------------

export function problemOf(error: unknown): Problem {
  return error instanceof ProblemError ? error.problem : { title: "", status: 0, detail: "", code: "unexpected" };
}
// In words for the person at the screen; the code only when there are no words for it.
export function problemWords(error: unknown): string {
  const problem = problemOf(error);
  const known = t().problems[problem.code];
  if (known) return known;
  return lang() === "en" && problem.detail ? problem.detail : t().problem(problem.code);
}

// ---- Views follow the store ----------------------------------------------------------------------------------------------

// Renders its host again when what it selects has changed; several changes in a frame cost one rendering.
export class Watch implements ReactiveController {
  private last: unknown[] = [];
  private stop: (() => void) | null = null;

  constructor(private readonly host: ReactiveControllerHost, private readonly select: (state: State) => unknown[]) {
    host.addController(this);
  }
  hostConnected(): void {
    this.stop = store.listen(() => this.look());
    this.look();
  }
  hostDisconnected(): void {
    this.stop?.();
  }
  private look(): void {
    const now = this.select(store.state);
    if (now.length === this.last.length && now.every((v, i) => v === this.last[i])) return;
    this.last = now;
    this.host.requestUpdate();
  }
}

// Renders its host again every so often while `needed` says so: countdowns.
export class Ticking implements ReactiveController {
  private timer = 0;
  constructor(private readonly host: ReactiveControllerHost, private readonly ms: number, private readonly needed: () => boolean) {
    host.addController(this);
  }
  hostConnected(): void {
    this.timer = window.setInterval(() => this.needed() && this.host.requestUpdate(), this.ms);
  }
  hostDisconnected(): void {
    clearInterval(this.timer);
  }
}
