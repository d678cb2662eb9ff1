// The window through which the plan is seen: which point of the map lies in the middle, and how many pixels a metre has.
// Map: x right, y up, metres. Screen: x right, y down, CSS pixels from the window's upper left corner.
import type { Point } from "../wire/types";

export interface Bounds {
  minX: number;
  minY: number;
  maxX: number;
  maxY: number;
}
export interface View {
  x: number; // map point in the middle
  y: number;
  scale: number; // px per m
  width: number; // px
  height: number;
}

export function toScreen(v: View, [x, y]: Point): Point {
  return [v.width / 2 + (x - v.x) * v.scale, v.height / 2 - (y - v.y) * v.scale];
}
export function toMap(v: View, [sx, sy]: Point): Point {
  return [v.x + (sx - v.width / 2) / v.scale, v.y - (sy - v.height / 2) / v.scale];
}

export function fitScale(b: Bounds, width: number, height: number): number {
  return Math.min(width / Math.max(0.1, b.maxX - b.minX), height / Math.max(0.1, b.maxY - b.minY));
}
export function fit(b: Bounds, width: number, height: number): View {
  return { x: (b.minX + b.maxX) / 2, y: (b.minY + b.maxY) / 2, scale: fitScale(b, width, height), width, height };
}

// Zooms so that the map point under `at` stays under it.
export function zoomAt(v: View, at: Point, factor: number): View {
  const [mx, my] = toMap(v, at);
  const scale = v.scale * factor;
  return { ...v, scale, x: mx - (at[0] - v.width / 2) / scale, y: my + (at[1] - v.height / 2) / scale };
}
export function panBy(v: View, dx: number, dy: number): View {
  return { ...v, x: v.x - dx / v.scale, y: v.y + dy / v.scale };
}

// Pixels beside the plan that something else covers: so far may the plan be moved aside.
export interface Covered {
  left: number;
  right: number;
}

const closest = 160; // px per m
// Keeps the scale between the whole plan and arm's length, and the plan inside the window.
export function clampView(v: View, b: Bounds, covered: Covered = { left: 0, right: 0 }): View {
  const whole = fitScale(b, v.width, v.height);
  const scale = Math.min(Math.max(closest, whole), Math.max(whole, v.scale));
  return { ...v, scale, x: clampAxis(v.x, b.minX - covered.left / scale, b.maxX + covered.right / scale, v.width / scale), y: clampAxis(v.y, b.minY, b.maxY, v.height / scale) };
}
function clampAxis(centre: number, min: number, max: number, shown: number): number {
  if (shown >= max - min) return (min + max) / 2;
  return Math.min(max - shown / 2, Math.max(min + shown / 2, centre));
}

export function boundsOf(points: Point[]): Bounds {
  const b = { minX: Infinity, minY: Infinity, maxX: -Infinity, maxY: -Infinity };
  for (const [x, y] of points) {
    b.minX = Math.min(b.minX, x);
    b.maxX = Math.max(b.maxX, x);
    b.minY = Math.min(b.minY, y);
    b.maxY = Math.max(b.maxY, y);
  }
  return b;
}

export function inside(polygon: Point[], [x, y]: Point): boolean {
  let odd = false;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [xi, yi] = polygon[i]!;
    const [xj, yj] = polygon[j]!;
    if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) odd = !odd;
  }
  return odd;
}

export function centroid(polygon: Point[]): Point {
  let area = 0, cx = 0, cy = 0;
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [xi, yi] = polygon[i]!;
    const [xj, yj] = polygon[j]!;
    const cross = xj * yi - xi * yj;
    area += cross;
    cx += (xi + xj) * cross;
    cy += (yi + yj) * cross;
  }
  if (Math.abs(area) < 1e-9) {
    const b = boundsOf(polygon);
    return [(b.minX + b.maxX) / 2, (b.minY + b.maxY) / 2];
  }
  return [cx / (3 * area), cy / (3 * area)];
}

export function distance(a: Point, b: Point): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
