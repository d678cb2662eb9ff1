// From the cells of an occupancy grid to solid shapes: the borders of a region as closed polygons along cell edges, smoothed.
import type { MapInfo, Point } from "../wire/types";

// Grey values of the map's picture: 0 occupied, 205 unknown, 254 free; what lies between was measured less surely.
export const isWall = (grey: number): boolean => grey < 100;
export const isKnown = (grey: number): boolean => grey < 195 || grey > 215;

export type Mask = Uint8Array; // 1 inside, row 0 at the bottom

export function maskOf(cells: Uint8Array, test: (grey: number) => boolean): Mask {
  const mask = new Uint8Array(cells.length);
  for (let i = 0; i < cells.length; i++) mask[i] = test(cells[i]!) ? 1 : 0;
  return mask;
}

// Clears the cells inside polygons that are grown by `margin` metres: exhibits stand in the map as obstacles, the plan draws them itself.
export function erase(mask: Mask, map: MapInfo, polygon: Point[], margin: number): void {
  if (polygon.length < 3) return;
  const reach = Math.ceil(margin / map.resolution);
  const inPolygon = new Uint8Array(mask.length);
  const { width, height } = map;
  const box = cellBox(map, polygon, reach);
  for (let j = box.j0; j <= box.j1; j++) {
    for (const [from, to] of spans(polygon, map.origin.y + (j + 0.5) * map.resolution)) {
      const i0 = Math.max(0, Math.ceil((from - map.origin.x) / map.resolution - 0.5));
      const i1 = Math.min(width - 1, Math.floor((to - map.origin.x) / map.resolution - 0.5));
      for (let i = i0; i <= i1; i++) inPolygon[j * width + i] = 1;
    }
  }
  for (let j = box.j0; j <= box.j1; j++) {
    for (let i = box.i0; i <= box.i1; i++) {
      if (mask[j * width + i] && near(inPolygon, width, height, i, j, reach)) mask[j * width + i] = 0;
    }
  }
}
function cellBox(map: MapInfo, polygon: Point[], reach: number) {
  const cell = (v: number, origin: number) => Math.floor((v - origin) / map.resolution);
  const xs = polygon.map((p) => cell(p[0], map.origin.x));
  const ys = polygon.map((p) => cell(p[1], map.origin.y));
  return {
    i0: Math.max(0, Math.min(...xs) - reach), i1: Math.min(map.width - 1, Math.max(...xs) + reach),
    j0: Math.max(0, Math.min(...ys) - reach), j1: Math.min(map.height - 1, Math.max(...ys) + reach),
  };
}
function spans(polygon: Point[], y: number): Point[] {
  const xs: number[] = [];
  for (let i = 0, j = polygon.length - 1; i < polygon.length; j = i++) {
    const [xi, yi] = polygon[i]!;
    const [xj, yj] = polygon[j]!;
    if (yi > y !== yj > y) xs.push(((xj - xi) * (y - yi)) / (yj - yi) + xi);
  }
  xs.sort((a, b) => a - b);
  const out: Point[] = [];
  for (let k = 0; k + 1 < xs.length; k += 2) out.push([xs[k]!, xs[k + 1]!]);
  return out;
}
function near(mask: Mask, width: number, height: number, i: number, j: number, reach: number): boolean {
  for (let dj = -reach; dj <= reach; dj++) {
    const jj = j + dj;
    if (jj < 0 || jj >= height) continue;
    for (let di = -reach; di <= reach; di++) {
      const ii = i + di;
      if (ii >= 0 && ii < width && di * di + dj * dj <= reach * reach + 1 && mask[jj * width + ii]) return true;
    }
  }
  return false;
}

// The borders of the mask as closed rings in metres: fill with the even-odd rule. `tolerance` in cells: how far a smoothed line may
// leave the cell edges; right angles stay.
export function outlines(mask: Mask, map: MapInfo, tolerance = 1.6): Point[][] {
  const rings = trace(mask, map.width, map.height);
  return rings.map((ring) => simplify(ring, tolerance).map(([i, j]) => [map.origin.x + i * map.resolution, map.origin.y + j * map.resolution] as Point));
}

// Walks along the edges between inside and outside with the inside on the left. Only corners are kept.
export function trace(mask: Mask, width: number, height: number): Point[][] {
  const filled = (i: number, j: number) => i >= 0 && j >= 0 && i < width && j < height && mask[j * width + i] === 1;
  const stride = width + 1;
  const seen = new Uint8Array(stride * (height + 1)); // horizontal lower edges that were walked already
  const rings: Point[][] = [];
  for (let j = 0; j < height; j++) {
    for (let i = 0; i < width; i++) {
      if (!filled(i, j) || filled(i, j - 1) || seen[j * stride + i]) continue;
      rings.push(walk(filled, i, j, seen, stride));
    }
  }
  return rings;
}
const steps: Point[] = [[1, 0], [0, 1], [-1, 0], [0, -1]];
function walk(filled: (i: number, j: number) => boolean, i0: number, j0: number, seen: Uint8Array, stride: number): Point[] {
  const ring: Point[] = [];
  let x = i0, y = j0, heading = 0; // starts along the lower edge of the cell, its inside to the left
  do {
    if (heading === 0) seen[y * stride + x] = 1;
    x += steps[heading]![0];
    y += steps[heading]![1];
    const [left, right] = ahead(filled, x, y, heading);
    const turn = !left ? 1 : right ? -1 : 0;
    if (turn !== 0) ring.push([x, y]);
    heading = (heading + turn + 4) % 4;
  } while (x !== i0 || y !== j0 || heading !== 0);
  return ring;
}
// The two cells in front of corner (x, y), seen along the heading.
function ahead(filled: (i: number, j: number) => boolean, x: number, y: number, heading: number): [boolean, boolean] {
  switch (heading) {
    case 0: return [filled(x, y), filled(x, y - 1)];
    case 1: return [filled(x - 1, y), filled(x, y)];
    case 2: return [filled(x - 1, y - 1), filled(x - 1, y)];
    default: return [filled(x, y - 1), filled(x - 1, y - 1)];
  }
}

// Douglas and Peucker, on a closed ring: cut at the two points farthest apart, each half for itself.
export function simplify(ring: Point[], tolerance: number): Point[] {
  if (ring.length <= 4) return ring;
  let far = 0;
  for (let k = 1; k < ring.length; k++) if (dist2(ring[k]!, ring[0]!) > dist2(ring[far]!, ring[0]!)) far = k;
  const first = simplifyLine(ring.slice(0, far + 1), tolerance);
  const second = simplifyLine([...ring.slice(far), ring[0]!], tolerance);
  return [...first.slice(0, -1), ...second.slice(0, -1)];
}
function simplifyLine(line: Point[], tolerance: number): Point[] {
  const keep = new Uint8Array(line.length);
  keep[0] = keep[line.length - 1] = 1;
  const open: [number, number][] = [[0, line.length - 1]];
  while (open.length > 0) {
    const [from, to] = open.pop()!;
    let worst = tolerance, at = -1;
    for (let k = from + 1; k < to; k++) {
      const d = offLine(line[k]!, line[from]!, line[to]!);
      if (d > worst) (worst = d), (at = k);
    }
    if (at < 0) continue;
    keep[at] = 1;
    open.push([from, at], [at, to]);
  }
  return line.filter((_, k) => keep[k]);
}
function dist2(a: Point, b: Point): number {
  return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2;
}
function offLine(p: Point, a: Point, b: Point): number {
  const dx = b[0] - a[0], dy = b[1] - a[1];
  const length = Math.hypot(dx, dy);
  if (length === 0) return Math.sqrt(dist2(p, a));
  return Math.abs(dx * (a[1] - p[1]) - (a[0] - p[0]) * dy) / length;
}
