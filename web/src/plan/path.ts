// What is left of a path for a robot that has driven along it since it was planned, and the dots behind it.
import type { Point } from "../wire/types";

const look = 12; // segments ahead in which the robot is looked for

export function remaining(path: Point[], robot: Point): Point[] {
  let best = Infinity, at = 0, t = 0;
  for (let k = 0; k + 1 < path.length && k < look; k++) {
    const [a, b] = [path[k]!, path[k + 1]!];
    const dx = b[0] - a[0], dy = b[1] - a[1], length2 = dx * dx + dy * dy;
    const u = length2 === 0 ? 0 : Math.min(1, Math.max(0, ((robot[0] - a[0]) * dx + (robot[1] - a[1]) * dy) / length2));
    const d = (a[0] + u * dx - robot[0]) ** 2 + (a[1] + u * dy - robot[1]) ** 2;
    if (d < best) (best = d), (at = k), (t = u);
  }
  if (path.length < 2 || best > 4) return path;
  return [robot, ...path.slice(t >= 1 ? at + 2 : at + 1)];
}

const spacing = 0.55; // m
const longest = 16; // dots

export class Trail {
  points: Point[] = [];
  add(at: Point): boolean {
    const last = this.points.at(-1);
    if (last && Math.hypot(at[0] - last[0], at[1] - last[1]) < spacing) return false;
    this.points.push(at);
    if (this.points.length > longest) this.points.shift();
    return true;
  }
  clear(): void {
    this.points = [];
  }
}
