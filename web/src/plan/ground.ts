// The part of the plan that stands still: floor, walls, hazards, exhibits and names. Painted again only when the view, the theme,
// the language or the next stop changes.
import type { Exhibit, Point, Site } from "../wire/types";
import type { MapImage } from "../store";
import { ringPath, shapeOf, type ExhibitShape } from "./art";
import { withAlpha, type Colours } from "./colours";
import { breakName, placeLabels, type Anchor, type Box } from "./labels";
import { erase, isKnown, isWall, maskOf, outlines, type Mask } from "./vector";
import { boundsOf, toMap, toScreen, type Bounds, type View } from "./view";

export interface Ground {
  bounds: Bounds; // of the known part of the map
  floor: Path2D;
  walls: Path2D;
  wallMask: Mask;
  map: MapImage;
  site: Site;
  exhibits: ExhibitShape[];
  hazards: { path: Path2D; box: Bounds }[];
  boundary: Path2D | null;
}

const exhibitMargin = 0.12; // m of the measured exhibit beyond its drawn outline

export function makeGround(map: MapImage, site: Site, exhibits: Exhibit[]): Ground {
  const walls = maskOf(map.cells, isWall);
  for (const e of exhibits) erase(walls, map, e.outline, exhibitMargin);
  const floorRings = outlines(maskOf(map.cells, isKnown), map);
  const bounds = floorRings.length > 0 ? boundsOf(floorRings.flat()) : {
    minX: map.origin.x, minY: map.origin.y, maxX: map.origin.x + map.width * map.resolution, maxY: map.origin.y + map.height * map.resolution,
  };
  return {
    bounds,
    floor: ringPath(floorRings),
    walls: ringPath(outlines(walls, map)),
    wallMask: walls,
    map,
    site,
    exhibits: exhibits.map(shapeOf),
    hazards: site.hazards.filter((h) => h.polygon.length >= 3).map((h) => ({ path: ringPath([h.polygon]), box: boundsOf(h.polygon) })),
    boundary: site.boundary.length >= 3 ? ringPath([site.boundary]) : null,
  };
}

// Whether a point of the floor can be driven to at all, as far as the plan knows; the server has the last word.
export function isOpenFloor(g: Ground, [x, y]: Point): boolean {
  const i = Math.floor((x - g.map.origin.x) / g.map.resolution), j = Math.floor((y - g.map.origin.y) / g.map.resolution);
  if (i < 0 || j < 0 || i >= g.map.width || j >= g.map.height) return false;
  const grey = g.map.cells[j * g.map.width + i]!;
  return !isWall(grey) && isKnown(grey);
}

export interface GroundLook {
  view: View;
  dpr: number;
  unit: number; // px of one design pixel: larger on walls and kiosks
  colours: Colours;
  names: Map<string, string>; // exhibit id to its name
  areas: { text: string; at: Point }[];
  next: string | null;
  quiet: boolean; // walls only, pale: still loading
  hazards: boolean;
  keepClear: Point[]; // places that names should not cover: where it is going, where it stands
}

export function paintGround(c: CanvasRenderingContext2D, g: Ground, look: GroundLook): void {
  const { view: v, dpr, colours, unit } = look;
  c.setTransform(dpr, 0, 0, dpr, 0, 0);
  c.clearRect(0, 0, v.width, v.height);
  const inMap = (draw: () => void) => {
    c.save();
    c.transform(v.scale, 0, 0, -v.scale, v.width / 2 - v.x * v.scale, v.height / 2 + v.y * v.scale);
    draw();
    c.restore();
  };
  const px = (n: number) => (n * unit) / v.scale;
  inMap(() => {
    c.fillStyle = colours.floor;
    c.fill(g.floor, "evenodd");
    if (look.quiet) return;
    if (look.hazards) for (const h of g.hazards) paintHazard(c, h, look, px);
    if (look.hazards && g.boundary) {
      c.strokeStyle = withAlpha(colours.lineStrong, 0.55);
      c.lineWidth = px(1);
      c.setLineDash([px(9), px(4), px(1.5), px(4)]);
      c.stroke(g.boundary);
      c.setLineDash([]);
    }
    paintGlow(c, g, look);
    for (const e of g.exhibits) paintExhibit(c, e, e.id === look.next, look, px);
    paintHome(c, g.site, look, px);
  });
  inMap(() => {
    c.fillStyle = look.quiet ? colours.line : colours.poche;
    c.fill(g.walls, "evenodd");
    c.strokeStyle = c.fillStyle;
    c.lineWidth = px(1.2); // walls one cell thick stay visible from afar
    c.lineJoin = "miter";
    c.stroke(g.walls);
  });
  if (!look.quiet) paintNames(c, g, look);
}

function paintHazard(c: CanvasRenderingContext2D, h: { path: Path2D; box: Bounds }, look: GroundLook, px: (n: number) => number): void {
  const { colours } = look;
  c.save();
  c.fillStyle = withAlpha(colours.hazardFill, 0.55);
  c.fill(h.path);
  c.save();
  c.clip(h.path);
  c.strokeStyle = withAlpha(colours.hazard, 0.36);
  c.lineWidth = px(1.8);
  const step = px(13), reach = h.box.maxX - h.box.minX + h.box.maxY - h.box.minY;
  const first = Math.ceil((h.box.minX - h.box.maxY) / step) * step; // stripes lie still on the floor while the view moves
  c.beginPath();
  for (let d = first; d < first + reach + step; d += step) {
    c.moveTo(h.box.minY + d, h.box.minY);
    c.lineTo(h.box.maxY + d, h.box.maxY);
  }
  c.stroke();
  c.restore();
  c.strokeStyle = withAlpha(colours.hazard, 0.75);
  c.lineWidth = px(1.4);
  c.setLineDash([px(6), px(4.3)]);
  c.stroke(h.path);
  c.restore();
}

function paintGlow(c: CanvasRenderingContext2D, g: Ground, look: GroundLook): void {
  const next = g.exhibits.find((e) => e.id === look.next);
  if (!next) return;
  const [x, y] = next.centre;
  const r = Math.max(next.radius * 1.7, (58 * look.unit) / look.view.scale);
  const glow = c.createRadialGradient(x, y, 0, x, y, r);
  glow.addColorStop(0, withAlpha(look.colours.goal, 0.44));
  glow.addColorStop(0.6, withAlpha(look.colours.goal, 0.2));
  glow.addColorStop(1, withAlpha(look.colours.goal, 0));
  c.save();
  c.clip(g.floor, "evenodd");
  c.fillStyle = glow;
  c.fillRect(x - r, y - r, 2 * r, 2 * r);
  c.restore();
}

function paintExhibit(c: CanvasRenderingContext2D, e: ExhibitShape, next: boolean, look: GroundLook, px: (n: number) => number): void {
  const { colours } = look;
  c.fillStyle = next ? withAlpha(colours.goal, 0.5) : colours.exhibitFill;
  c.fill(e.plinth);
  c.strokeStyle = next ? colours.goalInk : colours.exhibit;
  c.lineJoin = "round";
  c.lineWidth = px(next ? 1.8 : 1.4);
  c.stroke(e.plinth);
  c.lineWidth = px(next ? 1.4 : 1.1);
  c.stroke(e.art);
}

function paintHome(c: CanvasRenderingContext2D, site: Site, look: GroundLook, px: (n: number) => number): void {
  const { x, y } = site.home, h = px(9.5);
  c.fillStyle = look.colours.robotTint;
  c.strokeStyle = look.colours.robot;
  c.lineWidth = px(1.4);
  c.fillRect(x - h, y - h, 2 * h, 2 * h);
  c.strokeRect(x - h, y - h, 2 * h, 2 * h);
  c.beginPath();
  c.moveTo(x + h * 0.1, y + h * 0.66);
  for (const [dx, dy] of [[-0.46, -0.1], [0.05, -0.1], [-0.05, -0.66], [0.5, 0.14], [0, 0.14]] as const) c.lineTo(x + h * dx, y + h * dy);
  c.closePath();
  c.lineJoin = "round";
  c.stroke();
}

export function badgeRadius(unit: number): number {
  return 12 * unit;
}

const roomPrefix = "room:";

function paintNames(c: CanvasRenderingContext2D, g: Ground, look: GroundLook): void {
  const { view: v, colours, unit } = look;
  const size = 13 * unit, sizeNext = 15.5 * unit, badge = badgeRadius(unit);
  const font = (px: number, weight: number) => `${weight} ${px}px Cantarell, "Segoe UI", system-ui, sans-serif`;
  const anchors: Anchor[] = [], taken: Box[] = [];
  for (const e of g.exhibits) {
    const at = toScreen(v, e.centre), next = e.id === look.next;
    if (at[0] < -200 || at[1] < -100 || at[0] > v.width + 200 || at[1] > v.height + 100) continue;
    c.font = next ? font(sizeNext, 800) : font(size, 700);
    const lines = breakName(look.names.get(e.id) ?? "", (t) => c.measureText(t).width, 118 * unit);
    const half: Point = [Math.max(badge, e.halfWidth * v.scale), Math.max(badge, e.halfHeight * v.scale)];
    anchors.push({
      id: e.id, lines, width: Math.max(...lines.map((t) => c.measureText(t).width)), lineHeight: (next ? sizeNext : size) * 1.15, at, half, must: next,
    });
    taken.push({ x0: at[0] - half[0], y0: at[1] - half[1], x1: at[0] + half[0], y1: at[1] + half[1] });
  }
  const home = toScreen(v, [g.site.home.x, g.site.home.y]);
  taken.push({ x0: home[0] - 10 * unit, y0: home[1] - 10 * unit, x1: home[0] + 10 * unit, y1: home[1] + 10 * unit });
  for (const p of look.keepClear) {
    const [x, y] = toScreen(v, p), r = 17 * unit;
    taken.push({ x0: x - r, y0: y - r, x1: x + r, y1: y + r });
  }
  c.font = font(size, 400);
  look.areas.forEach((area, k) => anchors.push({
    id: `${roomPrefix}${k}`, lines: [area.text], width: c.measureText(area.text).width, lineHeight: size * 1.15, at: toScreen(v, area.at), half: [0, 0], must: false, on: true,
  }));
  const window = { x0: 0, y0: 0, x1: v.width, y1: v.height };
  for (const p of placeLabels(anchors, taken, (box) => wallShare(g, v, box), window)) {
    if (p.id.startsWith(roomPrefix)) {
      c.font = font(size, 400);
      paintText(c, p.lines, p.x, p.y, p.align, size, colours.ink2, colours.floor, 3.5 * unit);
      continue;
    }
    const next = p.id === look.next;
    c.font = next ? font(sizeNext, 800) : font(size, 700);
    paintText(c, p.lines, p.x, p.y, p.align, (next ? sizeNext : size) * 1.15, next ? colours.ink : colours.exhibit, colours.floor, 4 * unit);
  }
}

function paintText(
  c: CanvasRenderingContext2D, lines: string[], x: number, y: number, align: CanvasTextAlign, step: number, fill: string, halo: string, width: number,
): void {
  c.textAlign = align;
  c.lineJoin = "round";
  c.strokeStyle = halo;
  c.fillStyle = fill;
  c.lineWidth = width;
  lines.forEach((text, k) => c.strokeText(text, x, y + k * step));
  lines.forEach((text, k) => c.fillText(text, x, y + k * step));
}

// Which share of a box on the screen is wall, by a few samples.
function wallShare(g: Ground, v: View, box: Box): number {
  let hits = 0;
  const count = (length: number, px: number) => Math.max(1, Math.ceil(length / px));
  const nx = count(box.x1 - box.x0, 10), ny = count(box.y1 - box.y0, 4); // finer than a wall is thick
  for (let a = 0; a < nx; a++) {
    for (let b = 0; b < ny; b++) {
      const [x, y] = toMap(v, [box.x0 + ((a + 0.5) / nx) * (box.x1 - box.x0), box.y0 + ((b + 0.5) / ny) * (box.y1 - box.y0)]);
      const i = Math.floor((x - g.map.origin.x) / g.map.resolution), j = Math.floor((y - g.map.origin.y) / g.map.resolution);
      const out = i < 0 || j < 0 || i >= g.map.width || j >= g.map.height;
      if (out || g.wallMask[j * g.map.width + i]) hits++;
    }
  }
  return hits / (nx * ny);
}
