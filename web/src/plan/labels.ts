// Where names stand on the plan: below their exhibit when there is room, else above or beside; a name that would cover another one
// is left out until there is room (its number stays).
import type { Point } from "../wire/types";

export interface Anchor {
  id: string;
  lines: string[];
  width: number; // px, of the widest line
  lineHeight: number; // px
  at: Point; // px, middle of the thing named
  half: Point; // px, half its size
  must: boolean; // to be shown whatever it covers
  on?: boolean; // stands on its place, not beside it: names of rooms
}
export interface Placed {
  id: string;
  lines: string[];
  x: number; // px, middle
  y: number; // px, baseline of the first line
  align: "center" | "left" | "right";
}
export interface Box {
  x0: number;
  y0: number;
  x1: number;
  y1: number;
}

const gap = 4; // px between the thing and its name

// `taken`: boxes that names should not cover. `busy` 0..1: how much wall lies under a box.
export function placeLabels(anchors: Anchor[], taken: Box[], busy: (box: Box) => number, window: Box): Placed[] {
  const out: Placed[] = [];
  const boxes = [...taken];
  const rank = (a: Anchor) => (a.must ? 0 : a.on ? 2 : 1);
  for (const anchor of [...anchors].sort((a, b) => rank(a) - rank(b))) {
    let best: { placed: Placed; box: Box } | null = null, bestCost = Infinity;
    candidates(anchor, window).forEach((candidate, choice) => {
      const cover = boxes.reduce((sum, box) => sum + overlap(candidate.box, box), 0) / area(candidate.box);
      const cut = 1 - overlap(candidate.box, window) / area(candidate.box);
      const astray = anchor.on && busy(between(anchor.at, candidate.box)) > 0; // behind a wall a room's name is another room's
      // A touch counts at once: the share of a letter is small, but a name without it is misread.
      const cost = (cover > 0 ? 0.4 : 0) + (cover + cut) * 5 + busy(candidate.box) * 3 + choice * 0.08 + (astray ? 5 : 0);
      if (cost < bestCost) (best = candidate), (bestCost = cost);
    });
    if (!best || (bestCost > (anchor.on ? 0.35 : 1.2) && !anchor.must)) continue;
    const chosen = best as { placed: Placed; box: Box };
    out.push(chosen.placed);
    boxes.push(chosen.box);
  }
  return out;
}

function candidates(a: Anchor, window: Box): { placed: Placed; box: Box }[] {
  const h = a.lines.length * a.lineHeight, [x, y] = a.at, [hx, hy] = a.half;
  const below = y + hy + gap, above = y - hy - gap - h, right = x + hx + gap + 2, left = x - hx - gap - 2;
  // A name that would be cut by the window's edge moves in, as long as its exhibit is in the window.
  const inWindow = x > window.x0 && x < window.x1 && y > window.y0 && y < window.y1;
  const make = (align: Placed["align"], wanted: number, top: number) => {
    const lx = align === "center" && inWindow ? Math.max(window.x0 + a.width / 2 + 2, Math.min(window.x1 - a.width / 2 - 2, wanted)) : wanted;
    const x0 = align === "center" ? lx - a.width / 2 : align === "left" ? lx : lx - a.width;
    return {
      placed: { id: a.id, lines: a.lines, x: lx, y: top + a.lineHeight * 0.8, align },
      box: { x0, y0: top, x1: x0 + a.width, y1: top + h },
    };
  };
  if (a.on) return [0, -1.5, 1.5, -3, 3].map((lines) => make("center", x, y - h / 2 + lines * h)).map(spaced);
  const aside = a.width * 0.28;
  return [
    make("center", x, below), make("center", x, above), make("left", right, y - h / 2), make("right", left, y - h / 2), make("center", x - aside, below),
    make("center", x + aside, below), make("center", x - aside, above), make("center", x + aside, above),
  ];
}
// Room names keep off their neighbours: two names that nearly touch read as one.
function spaced(c: { placed: Placed; box: Box }): { placed: Placed; box: Box } {
  return { placed: c.placed, box: { ...c.box, x0: c.box.x0 - 2 * gap, x1: c.box.x1 + 2 * gap } };
}
// The way from a room's place to its name.
function between([x, y]: Point, to: Box): Box {
  const middle = (to.y0 + to.y1) / 2;
  return { x0: x - 1, x1: x + 1, y0: Math.min(y, middle), y1: Math.max(y, middle) };
}
function area(b: Box): number {
  return Math.max(1, (b.x1 - b.x0) * (b.y1 - b.y0));
}
function overlap(a: Box, b: Box): number {
  return Math.max(0, Math.min(a.x1, b.x1) - Math.max(a.x0, b.x0)) * Math.max(0, Math.min(a.y1, b.y1) - Math.max(a.y0, b.y0));
}

// Long names go on two lines, broken at the space nearest the middle, or at a hyphen when there is no space.
export function breakName(name: string, measure: (text: string) => number, limit: number): string[] {
  if (measure(name) <= limit) return [name];
  const gap = name.includes(" ") ? " " : "-";
  let best = -1;
  for (let k = 1; k < name.length - 1; k++) {
    if (name[k - 1] === gap && Math.abs(k - name.length / 2) < Math.abs(best - name.length / 2)) best = k;
  }
  return best < 0 ? [name] : [name.slice(0, best).trimEnd(), name.slice(best)];
}
