// Smooth motion out of poses that arrive 10 to 20 times a second, unevenly. Poses are played back a little late, on a clock that
// runs with the server's time and never jumps, so that between two poses there is always one to go to.
import type { Pose, PoseUpdate } from "../wire/types";

const delay = 0.14; // s behind the newest pose
const kept = 40;
const coast = 0.25; // s that a late pose is made up for by going on as before
const jump = 1.2; // m that no robot drives between two poses: it was placed anew

export function wrap(angle: number): number {
  return angle - 2 * Math.PI * Math.round(angle / (2 * Math.PI));
}

export class Motion {
  private readonly poses: PoseUpdate[] = [];
  private clock = 0; // s, server time being shown
  private rate = 1; // server seconds per second; a replay may run faster
  private shownAt = 0; // ms
  private firstAt = 0;
  private firstTime = 0;
  jumped = false; // the robot was placed anew since the last look; the reader resets it

  push(pose: PoseUpdate, now: number): void {
    const last = this.poses.at(-1);
    if (last && pose.time <= last.time) {
      if (pose.time > last.time - 5) return; // the same or an older one
      this.restart(pose, now); // the run began anew
    } else if (!last || Math.hypot(pose.x - last.x, pose.y - last.y) > jump) {
      this.jumped = last !== undefined;
      this.restart(pose, now);
    }
    this.poses.push(pose);
    if (this.poses.length > kept) this.poses.shift();
    const took = (now - this.firstAt) / 1000;
    if (took > 1) this.rate = Math.min(20, Math.max(0.05, (pose.time - this.firstTime) / took));
    if (took > 6) (this.firstAt = now - took * 500), (this.firstTime = pose.time - took * 0.5 * this.rate);
  }

  private restart(pose: PoseUpdate, now: number): void {
    this.poses.length = 0;
    this.clock = pose.time;
    this.shownAt = this.firstAt = now;
    this.firstTime = pose.time;
    this.rate = 1;
  }

  newest(): PoseUpdate | null {
    return this.poses.at(-1) ?? null;
  }

  // Where the robot is to be drawn at `now` (ms); null before the first pose.
  at(now: number): Pose | null {
    const last = this.poses.at(-1);
    if (!last) return null;
    const dt = Math.min(0.25, Math.max(0, (now - this.shownAt) / 1000));
    this.shownAt = now;
    const wanted = last.time - delay * this.rate;
    const error = wanted - (this.clock + dt * this.rate);
    this.clock += dt * this.rate + (Math.abs(error) > 1.5 * this.rate ? error : error * Math.min(1, dt * 2));
    return this.sample(this.clock);
  }

  private sample(time: number): Pose {
    const { poses } = this;
    const last = poses.at(-1)!;
    if (time >= last.time) return glide(last, Math.min(coast, time - last.time));
    for (let k = poses.length - 1; k > 0; k--) {
      const a = poses[k - 1]!, b = poses[k]!;
      if (time < a.time) continue;
      const t = (time - a.time) / (b.time - a.time);
      return { x: a.x + (b.x - a.x) * t, y: a.y + (b.y - a.y) * t, theta: a.theta + wrap(b.theta - a.theta) * t };
    }
    return poses[0]!;
  }
}

// Goes on along the arc that the robot was last on.
function glide(p: PoseUpdate, dt: number): Pose {
  const theta = p.theta + (p.angular * dt) / 2;
  return { x: p.x + Math.cos(theta) * p.linear * dt, y: p.y + Math.sin(theta) * p.linear * dt, theta: p.theta + p.angular * dt };
}
