// Which screen the kiosk shows: what the hand at the screen has chosen comes first, then what the robot does.
import type { State } from "../store";
import { atExhibit } from "../store";

export type Wanted = "nothing" | "choose" | "pick"; // what the person at the screen is about
export type Screen = "attract" | "choose" | "pick" | "idle" | "way" | "exhibit" | "makeway" | "halt" | "offline";

export const offlineAfter = 3_000; // ms of a lost line
export const makeWayAfter = 4_000; // ms of waiting for people
export const idleAfter = 45_000; // ms without a touch while choosing
export const goodbyeAfter = 10_000; // ms of "are you still there?"

export interface Moment {
  now: number; // ms
  touchedAt: number; // ms
  lostAt: number | null; // ms, since when the line is lost
  waitingAt: number | null; // ms, since when people are in the way
}

export function screenOf(state: State, wanted: Wanted, m: Moment): Screen {
  if (m.lostAt !== null && m.now - m.lostAt > offlineAfter) return "offline";
  const { status } = state;
  if (!status) return state.link.state === "live" ? "attract" : "offline";
  if (status.activity === "stopped" || status.activity === "faulted") return "halt";
  if (wanted !== "nothing") return m.now - m.touchedAt > idleAfter ? "idle" : wanted;
  if (atExhibit(status)) return "exhibit";
  if (m.waitingAt !== null && m.now - m.waitingAt > makeWayAfter) return "makeway";
  if (status.activity === "driving" || status.activity === "waiting") return "way";
  if (status.activity === "localizing" || status.lost) return "halt";
  return "attract";
}

// Nobody answered: the choice is forgotten.
export function gaveUp(wanted: Wanted, m: Moment): boolean {
  return wanted !== "nothing" && m.now - m.touchedAt > idleAfter + goodbyeAfter;
}
