// What visitors ask of the robot: sending a wish, taking it back, and the words about it. Used by the card, the list and the queue.
import { api } from "../api";
import { lang, problemWords, say, setPrefs, store, t } from "../app";
import { about } from "../i18n";
import { exhibitById, waiting } from "../store";
import type { Request } from "../wire/types";

export const longestName = 40;

export type Sent = { ok: true; request: Request } | { ok: false; words: string };

export async function wish(target: { exhibit: string } | { x: number; y: number }): Promise<Sent> {
  const name = store.state.prefs.name.trim();
  try {
    const request = "exhibit" in target ? await api.sendTo(target.exhibit, name) : await api.comeTo(target.x, target.y, name);
    mine.add(request.id);
    const queue = store.state.queue ?? [];
    if (!queue.some((r) => r.id === request.id)) store.set({ queue: [...queue, { ...request, yours: true }] });
    return { ok: true, request };
  } catch (error) {
    return { ok: false, words: problemWords(error) };
  }
}

export async function takeBack(request: Request): Promise<string> {
  try {
    await api.leave(request.id);
    return "";
  } catch (error) {
    return problemWords(error);
  }
}

// Requests sent from this page: the broadcast queue cannot say whose they are.
const mine = new Set<string>();
export function isMine(r: Request): boolean {
  return r.yours || mine.has(r.id);
}

export function placeName(r: Request): string {
  const exhibit = exhibitById(store.state, r.exhibit);
  return exhibit ? say(exhibit.title) : r.exhibit ?? t().aPlace;
}

export function waitWords(r: Request, first: boolean): string {
  if (r.state === "active") return t().now;
  if (r.etaSeconds === null || r.etaSeconds <= 0) return first ? t().next : "";
  return about(r.etaSeconds, lang());
}

// My open wish for an exhibit, if there is one.
export function myWishFor(exhibit: string): Request | null {
  return waiting(store.state.queue).find((r) => r.exhibit === exhibit && isMine(r)) ?? null;
}

// "You are number 2, 4 min."
export function standing(r: Request): string {
  if (r.state === "active") return t().onMyWay;
  const place = waiting(store.state.queue).findIndex((q) => q.id === r.id) + 1;
  return t().youAreNumber(place, r.etaSeconds && r.etaSeconds > 0 ? about(r.etaSeconds, lang()) : "");
}

export function rename(event: Event): void {
  setPrefs({ name: (event.target as HTMLInputElement).value.slice(0, longestName) });
}
