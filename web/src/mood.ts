// How the robot's face looks, out of what it does. It gets stern only after it asked nicely, and briefly.
import type { Speech, Status } from "./wire/types";

export type Mood = "happy" | "neutral" | "sad" | "angry";

const patience = 9; // s of waiting until it looks sad
const sternFrom = 16; // s
const sternUntil = 22;

export function moodOf(status: Status | null, speech: Speech | null, waitedSeconds: number): Mood {
  if (!status) return "neutral";
  switch (status.activity) {
    case "explaining":
    case "asking":
    case "idle":
      return "happy";
    case "waiting":
      if (status.why !== "people_in_the_way") return "neutral";
      return waitedSeconds > sternFrom && waitedSeconds < sternUntil ? "angry" : waitedSeconds > patience ? "sad" : "neutral";
    case "stopped":
    case "faulted":
      return "sad";
    case "driving":
    case "homing":
      return speech && (speech.cue === "greeting" || speech.cue === "farewell") ? "happy" : "neutral";
    default:
      return "neutral";
  }
}
