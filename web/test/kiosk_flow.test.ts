import { describe, expect, it } from "vitest";
import { gaveUp, screenOf, type Moment, type Wanted } from "../src/pages/kiosk_flow";
import { emptyState, type State } from "../src/store";
import type { Activity, Status } from "../src/wire/types";

const calm: Moment = { now: 100_000, touchedAt: 99_000, lostAt: null, waitingAt: null };
const doing = (activity: Activity, exhibit: string | null = "orrery"): State => ({
  ...emptyState, link: { ...emptyState.link, state: "live" }, status: { activity, exhibit, lost: false } as Status,
});
const screen = (activity: Activity, wanted: Wanted = "nothing", m: Partial<Moment> = {}) => screenOf(doing(activity), wanted, { ...calm, ...m });

describe("the kiosk's screen", () => {
  it("shows what the robot does", () => {
    expect(screen("idle")).toBe("attract");
    expect(screen("homing")).toBe("attract");
    expect(screen("driving")).toBe("way");
    expect(screen("explaining")).toBe("exhibit");
    expect(screen("asking")).toBe("exhibit");
    expect(screen("stopped")).toBe("halt");
    expect(screen("faulted")).toBe("halt");
    expect(screen("localizing")).toBe("halt");
  });
  it("follows the hand at the screen first", () => {
    expect(screen("driving", "choose")).toBe("choose");
    expect(screen("explaining", "pick")).toBe("pick");
  });
  it("does not let anybody choose while the robot is stopped", () => {
    expect(screen("stopped", "choose")).toBe("halt");
  });
  it("asks people to make way only after a moment", () => {
    expect(screen("waiting", "nothing", { waitingAt: 98_000 })).toBe("way");
    expect(screen("waiting", "nothing", { waitingAt: 95_000 })).toBe("makeway");
  });
  it("asks whether somebody is still there, then forgets the choice", () => {
    expect(screen("idle", "pick", { touchedAt: 50_000 })).toBe("idle");
    expect(gaveUp("pick", { ...calm, touchedAt: 50_000 })).toBe(false);
    expect(gaveUp("pick", { ...calm, touchedAt: 44_000 })).toBe(true);
    expect(gaveUp("nothing", { ...calm, touchedAt: 0 })).toBe(false);
  });
  it("says so when the line stays lost, not at a short break", () => {
    expect(screen("driving", "nothing", { lostAt: 98_000 })).toBe("way");
    expect(screen("driving", "choose", { lostAt: 96_000 })).toBe("offline");
    expect(screenOf(emptyState, "nothing", calm)).toBe("offline");
  });
});
