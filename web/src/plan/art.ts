// Line drawings of exhibits as seen from above, fitted to the outline of each. Drawn in a box around (0, 0), half as wide as `a` and
// half as deep as `b` metres, the longer side along x.
import type { Exhibit, Point } from "../wire/types";
import { boundsOf, centroid } from "./view";

type Drawing = (p: Path2D, a: number, b: number) => void;

const circle = (p: Path2D, x: number, y: number, r: number) => {
  p.moveTo(x + r, y);
  p.arc(x, y, r, 0, 2 * Math.PI);
};
const box = (p: Path2D, x0: number, y0: number, x1: number, y1: number) => p.rect(x0, y0, x1 - x0, y1 - y0);
const line = (p: Path2D, ...xy: number[]) => {
  p.moveTo(xy[0]!, xy[1]!);
  for (let i = 2; i < xy.length; i += 2) p.lineTo(xy[i]!, xy[i + 1]!);
};
const spokes = (p: Path2D, r0: number, r1: number, n: number) => {
  for (let k = 0; k < n; k++) {
    const c = Math.cos((k * 2 * Math.PI) / n), s = Math.sin((k * 2 * Math.PI) / n);
    line(p, c * r0, s * r0, c * r1, s * r1);
  }
};

const drawings: Record<string, Drawing> = {
  engine(p, a, b) {
    box(p, -a * 0.9, -b * 0.8, a * 0.9, b * 0.8);
    circle(p, -a * 0.55, 0, b * 0.42);
    circle(p, -a * 0.55, 0, b * 0.16);
    line(p, -a * 0.55, -b * 0.14, a * 0.6, -b * 0.14);
    line(p, -a * 0.55, b * 0.14, a * 0.6, b * 0.14);
    box(p, a * 0.5, -b, a * 0.6, b);
  },
  locomotive(p, a, b) {
    line(p, -a, -b * 0.7, a, -b * 0.7);
    line(p, -a, b * 0.7, a, b * 0.7);
    p.roundRect(-a * 0.95, -b * 0.8, a * 1.2, b * 1.6, b * 0.7);
    box(p, a * 0.25, -b, a * 0.52, b);
    box(p, a * 0.58, -b * 0.85, a * 0.95, b * 0.85);
    circle(p, -a * 0.7, 0, b * 0.35);
  },
  wheel(p, a, b) {
    const r = Math.min(a, b);
    circle(p, 0, 0, r * 0.95);
    circle(p, 0, 0, r * 0.75);
    circle(p, 0, 0, r * 0.2);
    spokes(p, r * 0.2, r * 0.75, 8);
  },
  pendulum(p, a, b) {
    const r = Math.min(a, b);
    circle(p, 0, 0, r * 0.97);
    circle(p, 0, 0, r * 0.72);
    spokes(p, r * 0.72, r * 0.82, 24);
  },
  orrery(p, a, b) {
    const r = Math.min(a, b);
    circle(p, 0, 0, r * 0.95);
    circle(p, 0, 0, r * 0.66);
    circle(p, r * 0.66, -r * 0.1, r * 0.1);
    circle(p, -r * 0.6, r * 0.73, r * 0.13);
  },
  press(p, a, b) {
    box(p, -a, -b, a, b);
    line(p, -a * 0.72, -b, -a * 0.72, b);
    line(p, a * 0.72, -b, a * 0.72, b);
    box(p, -a * 0.5, -b * 0.6, a * 0.5, b * 0.6);
  },
  loom(p, a, b) {
    box(p, -a, -b, a, b);
    for (const x of [-0.8, -0.6, -0.4, 0.4, 0.6, 0.8]) line(p, a * x, -b * 0.8, a * x, b * 0.8);
  },
  bell(p, a, b) {
    const r = Math.min(a, b);
    circle(p, 0, 0, r * 0.95);
    circle(p, 0, 0, r * 0.7);
  },
  tunnel(p, a, b) {
    p.moveTo(-a, -b);
    line(p, -a, -b, -a * 0.35, -b * 0.5, a * 0.35, -b * 0.5, a, -b, a, b, a * 0.35, b * 0.5, -a * 0.35, b * 0.5, -a, b, -a, -b);
    line(p, -a * 0.85, -b * 0.85, -a * 0.85, b * 0.85);
    line(p, a * 0.85, -b * 0.85, a * 0.85, b * 0.85);
  },
  transmitter(p, a, b) {
    box(p, -a, -b, a, b);
    box(p, -a * 0.75, -b * 0.6, -a * 0.35, b * 0.6);
    box(p, a * 0.35, -b * 0.6, a * 0.75, b * 0.6);
  },
  telescope(p, a, b) {
    const r = Math.min(a, b);
    circle(p, 0, 0, r * 0.9);
    line(p, -a * 0.95, b * 0.4, a * 0.6, -b * 0.95);
    line(p, -a * 0.6, b * 0.95, a * 0.95, -b * 0.4);
  },
  propeller(p, a, b) {
    const r = Math.min(a, b) * 0.95;
    circle(p, 0, 0, r);
    for (let k = 0; k < 4; k++) {
      const t = (k * Math.PI) / 2;
      const at = (u: number, d: number): [number, number] => [Math.cos(t + d) * r * u, Math.sin(t + d) * r * u];
      p.moveTo(0, 0);
      p.quadraticCurveTo(...at(0.7, -0.5), ...at(0.92, 0.1));
      p.quadraticCurveTo(...at(0.7, 0.35), 0, 0);
    }
  },
  desks(p, a, b) {
    for (const y of [-0.9, 0.35]) {
      box(p, -a * 0.97, b * y, a * 0.97, b * (y + 0.55));
      for (let k = 0; k < 6; k++) box(p, a * (-0.88 + k * 0.31), b * (y + 0.14), a * (-0.72 + k * 0.31), b * (y + 0.41));
    }
  },
  cabinet(p, a, b) {
    box(p, -a, -b, a, b);
    line(p, -a * 0.8, -b, -a * 0.8, b);
    line(p, a * 0.8, -b, a * 0.8, b);
  },
  plane(p, a, b) {
    line(p, -a * 0.95, 0, a * 0.9, 0);
    line(p, -a * 0.35, -b, -a * 0.1, -b, a * 0.12, 0, -a * 0.1, b, -a * 0.35, b, -a * 0.2, 0, -a * 0.35, -b);
    line(p, a * 0.72, -b * 0.35, a * 0.84, -b * 0.35, a * 0.84, b * 0.35, a * 0.72, b * 0.35);
  },
  car(p, a, b) {
    p.roundRect(-a * 0.95, -b * 0.8, a * 1.9, b * 1.6, Math.min(a, b) * 0.35);
    box(p, -a * 0.35, -b * 0.6, a * 0.35, b * 0.6);
    for (const x of [-0.7, 0.45]) for (const y of [-1, 0.8]) box(p, a * x, b * y, a * (x + 0.25), b * (y + 0.2));
  },
  skeleton(p, a, b) {
    line(p, -a * 0.95, 0, a * 0.9, 0);
    for (let k = 0; k < 9; k++) {
      const x = a * (-0.45 + k * 0.13), w = b * 0.75 * Math.sin(((k + 1.5) / 11) * Math.PI);
      p.moveTo(x, -w);
      p.quadraticCurveTo(x - a * 0.12, 0, x, w);
    }
    p.ellipse(-a * 0.78, 0, a * 0.14, b * 0.32, 0, 0, 2 * Math.PI);
  },
  globe(p, a, b) {
    const r = Math.min(a, b) * 0.95;
    circle(p, 0, 0, r);
    p.moveTo(-r, 0);
    p.lineTo(r, 0);
    p.moveTo(r * 0.45, 0);
    p.ellipse(0, 0, r * 0.45, r, 0, 0, 2 * Math.PI);
  },
  vessel(p, a, b) {
    p.moveTo(-a * 0.95, -b * 0.7);
    p.lineTo(a * 0.3, -b * 0.7);
    p.quadraticCurveTo(a * 0.75, -b * 0.6, a * 0.97, 0);
    p.quadraticCurveTo(a * 0.75, b * 0.6, a * 0.3, b * 0.7);
    p.lineTo(-a * 0.95, b * 0.7);
    p.closePath();
    line(p, -a * 0.6, -b * 0.7, -a * 0.6, b * 0.7);
    line(p, a * 0.2, -b * 0.7, a * 0.2, b * 0.7);
  },
  truss(p, a, b) {
    line(p, -a, -b * 0.6, a, -b * 0.6);
    line(p, -a, b * 0.6, a, b * 0.6);
    const n = Math.max(3, Math.round(a / b));
    for (let k = 0; k < n; k++) {
      const x0 = -a + (2 * a * k) / n, x1 = x0 + (2 * a) / n;
      line(p, x0, b * 0.6, (x0 + x1) / 2, -b * 0.6, x1, b * 0.6);
    }
  },
  piano(p, a, b) {
    p.moveTo(-a, -b * 0.9);
    p.lineTo(-a, b * 0.9);
    p.lineTo(a * 0.1, b * 0.9);
    p.bezierCurveTo(a * 0.6, b * 0.9, a * 0.2, 0, a * 0.75, -b * 0.1);
    p.bezierCurveTo(a * 1.05, -b * 0.2, a * 1.05, -b * 0.9, a * 0.6, -b * 0.9);
    p.closePath();
    line(p, -a * 0.72, -b * 0.9, -a * 0.72, b * 0.9);
  },
  coil(p, a, b) {
    const r = Math.min(a, b);
    for (const k of [0.95, 0.78, 0.61, 0.44]) circle(p, 0, 0, r * k);
  },
  row(p, a, b) {
    const n = Math.max(2, Math.round(a / b)), r = Math.min(b * 0.8, (a / n) * 0.8);
    for (let k = 0; k < n; k++) {
      const x = -a + (a * (2 * k + 1)) / n;
      circle(p, x, 0, r);
      circle(p, x, 0, r * 0.5);
    }
  },
  // Whatever has no drawing of its own: a plinth with a second edge.
  plinth(p, a, b) {
    box(p, -a, -b, a, b);
    const m = Math.min(a, b) * 0.3;
    box(p, -a + m, -b + m, a - m, b - m);
  },
};

// Words that museums use for their drawings, to the drawing that shows it best.
const words: [RegExp, string][] = [
  [/loco|train|tram|rail|wagon/, "locomotive"], [/mule|machine|loom|weav|jacquard|textile/, "loom"], [/hammer|press|print/, "press"],
  [/girder|truss|frame/, "truss"], [/beam|steam|engine|motor|turbine|pump/, "engine"], [/cable|rope|coil|spool/, "coil"], [/piano|organ/, "piano"],
  [/wheel|bicycle|carriage|dynamo|generator|parachut|umbrella/, "wheel"], [/pendul|compass|sundial|lens/, "pendulum"],
  [/orrer|planet|astrolab|star|solar/, "orrery"], [/insulator|bottles|jars/, "row"],
  [/bell|kettle|capsule|tank|well|urn|vase|amphora|meteor|furnace|bulb|tyre|tire|tin|crystal/, "bell"], [/tunnel|bridge/, "tunnel"],
  [/transmit|radio|spark|tesla|telegraph|projector/, "transmitter"], [/telescop|refract|optic|microscop|cannon/, "telescope"],
  [/propell|screw|fan|windmill|rotor/, "propeller"], [/typewr|desk|tables?|bench|clocks/, "desks"], [/glider|plane|air|flight|wing|kite/, "plane"],
  [/car$|auto|coach|cart|truck|rover/, "car"], [/dino|skelet|whale|fossil|mammoth|bone/, "skeleton"], [/globe|earth|world|moon/, "globe"],
  [/ship|boat|canoe|submar|hull/, "vessel"], [/comput|cabinet|case|safe|gem|coin|instrument|mask|flag|dress|phone/, "cabinet"],
];

function drawingOf(icon: string, id: string): Drawing {
  for (const name of [icon, id]) {
    const known = drawings[name];
    if (known) return known;
    const word = words.find(([pattern]) => pattern.test(name));
    if (name && word) return drawings[word[1]]!;
  }
  return drawings.plinth!;
}

export interface ExhibitShape {
  id: string;
  number: number;
  outline: Point[];
  plinth: Path2D; // map frame
  art: Path2D; // map frame
  centre: Point;
  radius: number; // m, of the circle round the outline
  halfHeight: number; // m, to place names below and above
  halfWidth: number;
}

export function shapeOf(e: Exhibit): ExhibitShape {
  const outline: Point[] = e.outline.length >= 3 ? e.outline : ring([e.x, e.y], 0.5);
  const centre = centroid(outline);
  const { angle, a, b, middle } = orientedBox(outline);
  const art = new Path2D();
  drawingOf(e.icon, e.id)(art, a * 0.94, b * 0.94);
  const placed = new Path2D();
  placed.addPath(art, new DOMMatrix().translate(middle[0], middle[1]).rotate((angle * 180) / Math.PI));
  const box = boundsOf(outline);
  return {
    id: e.id, number: e.number, outline, plinth: ringPath([outline]), art: placed, centre, radius: Math.hypot(a, b), halfHeight: (box.maxY - box.minY) / 2,
    halfWidth: (box.maxX - box.minX) / 2,
  };
}

function ring([x, y]: Point, r: number): Point[] {
  return Array.from({ length: 12 }, (_, k) => [x + r * Math.cos((k * Math.PI) / 6), y + r * Math.sin((k * Math.PI) / 6)]);
}

// The smallest box round the outline that lies along one of its edges.
export function orientedBox(outline: Point[]): { angle: number; a: number; b: number; middle: Point } {
  let best = { angle: 0, a: 0, b: 0, middle: outline[0]! as Point }, bestArea = Infinity;
  for (let i = 0, j = outline.length - 1; i < outline.length; j = i++) {
    const angle = Math.atan2(outline[i]![1] - outline[j]![1], outline[i]![0] - outline[j]![0]);
    const c = Math.cos(angle), s = Math.sin(angle);
    const box = boundsOf(outline.map(([x, y]) => [c * x + s * y, -s * x + c * y]));
    const w = box.maxX - box.minX, h = box.maxY - box.minY;
    if (w * h >= bestArea - 1e-6) continue;
    bestArea = w * h;
    const u = (box.minX + box.maxX) / 2, v = (box.minY + box.maxY) / 2;
    best = { angle: w >= h ? angle : angle + Math.PI / 2, a: Math.max(w, h) / 2, b: Math.min(w, h) / 2, middle: [c * u - s * v, s * u + c * v] };
  }
  return best;
}

export function ringPath(rings: Point[][]): Path2D {
  const path = new Path2D();
  for (const points of rings) {
    points.forEach(([x, y], k) => (k === 0 ? path.moveTo(x, y) : path.lineTo(x, y)));
    path.closePath();
  }
  return path;
}
