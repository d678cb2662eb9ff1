import { describe, expect, it } from "vitest";
import { Motion, wrap } from "../../src/plan/motion";
import { PeopleDots } from "../../src/plan/people";
import { remaining, Trail } from "../../src/plan/path";
import type { PoseUpdate } from "../../src/wire/types";
import { randomOf } from "../random";

const pose = (time: number, x: number, more: Partial<PoseUpdate> = {}): PoseUpdate => ({
  time, x, y: 0, theta: 0, sigmaPosition: 0, sigmaTheta: 0, localized: true, linear: 0.7, angular: 0, ...more,
});

describe("Motion", () => {
  it("moves evenly at 60 frames a second though poses come at 10 Hz and late", () => {
    const motion = new Motion(), random = randomOf(5), speed = 0.7;
    const arrivals = Array.from({ length: 60 }, (_, k) => ({ at: 1000 + k * 100 + random() * 60, pose: pose(k * 0.1, k * 0.1 * speed) }));
    const xs: number[] = [];
    let k = 0;
    for (let now = 1000; now < 6500; now += 1000 / 60) {
      while (k < arrivals.length && arrivals[k]!.at <= now) motion.push(arrivals[k]!.pose, arrivals[k++]!.at);
      const at = motion.at(now);
      if (at && now > 2500) xs.push(at.x);
    }
    const steps = xs.slice(1).map((x, i) => x - xs[i]!);
    const even = speed / 60;
    expect(Math.min(...steps)).toBeGreaterThan(even * 0.5);
    expect(Math.max(...steps)).toBeLessThan(even * 1.6);
  });
  it("turns the short way", () => {
    const motion = new Motion();
    motion.push(pose(0, 0, { theta: 3.1 }), 0);
    motion.push(pose(0.1, 0, { theta: -3.1 }), 100);
    for (let now = 0; now < 200; now += 16) {
      const at = motion.at(now)!;
      expect(Math.abs(wrap(at.theta - Math.PI))).toBeLessThan(0.06);
    }
  });
  it("goes on along its arc when a pose is late, but not for long", () => {
    const motion = new Motion();
    for (let k = 0; k < 20; k++) motion.push(pose(k * 0.1, k * 0.07), k * 100);
    let last = 0;
    for (let now = 1900; now < 9000; now += 16) last = motion.at(now)!.x;
    expect(last).toBeLessThan(19 * 0.07 + 0.7 * 0.26);
  });
  it("says so when the robot is placed anew, instead of driving through walls", () => {
    const motion = new Motion();
    motion.push(pose(0, 0), 0);
    motion.push(pose(0.1, 9), 100);
    expect(motion.jumped).toBe(true);
    expect(motion.at(116)!.x).toBeCloseTo(9, 1);
  });
  it("follows a replay that runs faster than time", () => {
    const motion = new Motion();
    let x = 0;
    for (let now = 0; now < 8000; now += 20) {
      if (now % 100 === 0) motion.push(pose((now / 1000) * 5, (now / 1000) * 5 * 0.2, { linear: 0.2 }), now);
      x = motion.at(now)!.x;
    }
    expect(x).toBeGreaterThan(7.98 - 1.2);
  });
  it("starts over with another run of the server", () => {
    const motion = new Motion();
    motion.push(pose(500, 3), 0);
    motion.push(pose(1, 2.5), 100);
    expect(motion.at(120)!.x).toBeCloseTo(2.5, 1);
  });
});

describe("PeopleDots", () => {
  it("lets a person glide and fade instead of jump", () => {
    const dots = new PeopleDots();
    dots.see([[0, 0], [5, 5]]);
    for (let k = 0; k < 60; k++) dots.step(1 / 60, false);
    expect(dots.dots).toHaveLength(2);
    dots.see([[0.4, 0]]);
    dots.step(1 / 60, false);
    expect(dots.dots[0]!.x).toBeGreaterThan(0);
    expect(dots.dots[0]!.x).toBeLessThan(0.2);
    for (let k = 0; k < 60; k++) dots.step(1 / 60, false);
    expect(dots.dots.map((d) => [Math.round(d.x * 100) / 100, d.y])).toEqual([[0.4, 0]]);
    expect(dots.step(1 / 60, false)).toBe(false);
  });
  it("is instant for those who want no motion", () => {
    const dots = new PeopleDots();
    dots.see([[1, 1]]);
    dots.step(0.016, true);
    expect(dots.dots[0]).toMatchObject({ x: 1, y: 1, alpha: 1 });
  });
});

describe("remaining", () => {
  it("begins where the robot is", () => {
    expect(remaining([[0, 0], [4, 0], [4, 4]], [2, 0.1])).toEqual([[2, 0.1], [4, 0], [4, 4]]);
    expect(remaining([[0, 0], [4, 0], [4, 4]], [4, 1])).toEqual([[4, 1], [4, 4]]);
  });
  it("keeps a path the robot is not on", () => {
    const path: [number, number][] = [[0, 0], [4, 0]];
    expect(remaining(path, [20, 20])).toBe(path);
    expect(remaining([], [0, 0])).toEqual([]);
  });
});

describe("Trail", () => {
  it("drops a dot every so often and forgets the oldest", () => {
    const trail = new Trail();
    for (let k = 0; k < 1000; k++) trail.add([k * 0.05, 0]);
    expect(trail.points).toHaveLength(16);
    expect(trail.points[1]![0] - trail.points[0]![0]).toBeGreaterThan(0.5);
  });
});
