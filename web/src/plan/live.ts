// The part of the plan that moves: laser, people, trail, path, robot; on the console also belief and beams. Painted every frame in
// which something changed.
import { BeamKind, type Point, type Pose, type Scan } from "../wire/types";
import { withAlpha, type Colours } from "./colours";
import type { Dot } from "./people";
import { toScreen, type View } from "./view";

export interface LiveLook {
  view: View;
  dpr: number;
  unit: number;
  colours: Colours;
  robot: Pose | null;
  robotAlpha: number;
  lost: boolean; // last known place: hollow
  radius: number; // m, of the robot's body
  path: Point[];
  dash: number; // m, how far the dashes have drifted
  trail: Point[];
  people: readonly Dot[];
  scans: (Scan | null)[];
  fan: boolean;
  beams: boolean;
  belief: [number, number, number][];
  placing: Pose | null; // where staff say it is
  marker: Point | null; // a place picked on the floor
  note: string; // beside a hollow robot
  cross: boolean; // keyboard's cross-hair
}

export function paintLive(c: CanvasRenderingContext2D, look: LiveLook): void {
  const { view: v, dpr } = look;
  c.setTransform(dpr, 0, 0, dpr, 0, 0);
  c.clearRect(0, 0, v.width, v.height);
  if (look.fan && !look.beams) for (const scan of look.scans) if (scan) paintFan(c, look, scan);
  if (look.beams) for (const scan of look.scans) if (scan) paintBeams(c, look, scan);
  paintTrail(c, look);
  paintPath(c, look);
  paintPeople(c, look);
  paintBelief(c, look);
  if (look.robot) paintRobot(c, look, look.robot, look.lost ? "hollow" : "solid", look.robotAlpha);
  if (look.lost && look.robot && look.note) paintNote(c, look, look.robot);
  if (look.marker) paintMarker(c, look, look.marker);
  if (look.placing) paintRobot(c, look, look.placing, "placing", 1);
  if (look.cross) paintCross(c, look);
}

function beamEnd(scan: Scan, k: number): Point | null {
  const r = scan.ranges[k]!;
  if (!(r > 0)) return null;
  const angle = scan.pose.theta + scan.angleMin + k * scan.angleStep;
  return [scan.pose.x + Math.cos(angle) * r, scan.pose.y + Math.sin(angle) * r];
}

function paintFan(c: CanvasRenderingContext2D, look: LiveLook, scan: Scan): void {
  const { view: v, colours, unit } = look;
  const from = toScreen(v, [scan.pose.x, scan.pose.y]);
  const dots = new Path2D();
  const r = 1.15 * unit;
  c.beginPath();
  c.moveTo(from[0], from[1]);
  for (let k = 0; k < scan.ranges.length; k++) {
    const end = beamEnd(scan, k);
    if (!end) {
      c.lineTo(from[0], from[1]);
      continue;
    }
    const [x, y] = toScreen(v, end);
    c.lineTo(x, y);
    dots.rect(x - r, y - r, 2 * r, 2 * r);
  }
  c.closePath();
  c.fillStyle = withAlpha(colours.laser, 0.055);
  c.fill();
  c.fillStyle = withAlpha(colours.laser, 0.5);
  c.fill(dots);
}

function paintBeams(c: CanvasRenderingContext2D, look: LiveLook, scan: Scan): void {
  const { view: v, colours, unit } = look;
  const from = toScreen(v, [scan.pose.x, scan.pose.y]);
  const map = new Path2D(), person = new Path2D(), far = new Path2D(), ends = new Path2D();
  for (let k = 0; k < scan.ranges.length; k++) {
    const end = beamEnd(scan, k);
    if (!end) continue;
    const [x, y] = toScreen(v, end);
    const kind = scan.kinds[k];
    const path = kind === BeamKind.person ? person : kind === BeamKind.far ? far : map;
    path.moveTo(from[0], from[1]);
    path.lineTo(x, y);
    if (kind === BeamKind.person) ends.rect(x - 1.6 * unit, y - 1.6 * unit, 3.2 * unit, 3.2 * unit);
  }
  c.lineWidth = 0.7 * unit;
  c.strokeStyle = withAlpha(colours.robot, 0.28);
  c.stroke(map);
  c.strokeStyle = withAlpha(colours.ink2, 0.5);
  c.setLineDash([2 * unit, 4 * unit]);
  c.stroke(far);
  c.strokeStyle = withAlpha(colours.people, 0.85);
  c.lineWidth = 1.1 * unit;
  c.setLineDash([4 * unit, 3 * unit]);
  c.stroke(person);
  c.setLineDash([]);
  c.fillStyle = colours.people;
  c.fill(ends);
}

function paintTrail(c: CanvasRenderingContext2D, look: LiveLook): void {
  const n = look.trail.length;
  look.trail.forEach((p, k) => {
    const [x, y] = toScreen(look.view, p);
    c.fillStyle = withAlpha(look.colours.robot, 0.12 + (0.5 * (k + 1)) / n);
    c.beginPath();
    c.arc(x, y, (1.1 + (0.9 * k) / n) * look.unit, 0, 2 * Math.PI);
    c.fill();
  });
}

function paintPath(c: CanvasRenderingContext2D, look: LiveLook): void {
  const { view: v, colours, unit } = look;
  if (look.path.length < 2) return;
  const points = look.path.map((p) => toScreen(v, p));
  const line = new Path2D();
  points.forEach(([x, y], k) => (k === 0 ? line.moveTo(x, y) : line.lineTo(x, y)));
  c.lineCap = c.lineJoin = "round";
  c.strokeStyle = colours.floor;
  c.lineWidth = 8.5 * unit;
  c.stroke(line);
  c.strokeStyle = colours.robot;
  c.lineWidth = 4 * unit;
  c.setLineDash([12 * unit, 8 * unit]);
  c.lineDashOffset = -look.dash * v.scale;
  c.stroke(line);
  c.setLineDash([]);
  c.lineCap = "butt";
  const [gx, gy] = points.at(-1)!;
  c.fillStyle = colours.floor;
  c.lineWidth = 2.8 * unit;
  c.beginPath();
  c.arc(gx, gy, 9.5 * unit, 0, 2 * Math.PI);
  c.fill();
  c.stroke();
  c.fillStyle = colours.robot;
  c.beginPath();
  c.arc(gx, gy, 3.2 * unit, 0, 2 * Math.PI);
  c.fill();
}

function paintPeople(c: CanvasRenderingContext2D, look: LiveLook): void {
  const r = Math.max(9 * look.unit, 0.36 * look.view.scale);
  for (const dot of look.people) {
    const [x, y] = toScreen(look.view, [dot.x, dot.y]);
    const soft = c.createRadialGradient(x, y, 0, x, y, r);
    soft.addColorStop(0, withAlpha(look.colours.people, 0.85 * dot.alpha));
    soft.addColorStop(0.55, withAlpha(look.colours.people, 0.6 * dot.alpha));
    soft.addColorStop(1, withAlpha(look.colours.people, 0));
    c.fillStyle = soft;
    c.fillRect(x - r, y - r, 2 * r, 2 * r);
  }
}

function paintBelief(c: CanvasRenderingContext2D, look: LiveLook): void {
  c.strokeStyle = withAlpha(look.colours.robot, 0.6);
  c.fillStyle = withAlpha(look.colours.robot, 0.5);
  c.lineWidth = look.unit;
  const ticks = new Path2D();
  for (const [x, y, theta] of look.belief) {
    const [sx, sy] = toScreen(look.view, [x, y]);
    c.fillRect(sx - 1.2 * look.unit, sy - 1.2 * look.unit, 2.4 * look.unit, 2.4 * look.unit);
    ticks.moveTo(sx, sy);
    ticks.lineTo(sx + Math.cos(theta) * 6 * look.unit, sy - Math.sin(theta) * 6 * look.unit);
  }
  c.stroke(ticks);
}

// The drop: body, tip ahead, two eyes. One unit of the drawing is the body's radius over 1.27.
function paintRobot(c: CanvasRenderingContext2D, look: LiveLook, pose: Pose, as: "solid" | "hollow" | "placing", alpha: number): void {
  const { view: v, colours, unit } = look;
  const [x, y] = toScreen(v, [pose.x, pose.y]);
  const s = Math.max(12.5 * unit, look.radius * v.scale) / 1.27;
  c.save();
  c.globalAlpha = alpha;
  c.translate(x, y);
  c.rotate(-pose.theta);
  c.scale(s, s);
  c.fillStyle = withAlpha(colours.floor, 0.92);
  c.beginPath();
  c.arc(0, 0, 1.62, 0, 2 * Math.PI);
  c.fill();
  const tip = Math.atan2(0.93, 0.86);
  c.beginPath();
  c.moveTo(1.85, 0);
  c.lineTo(0.86, 0.93);
  c.arc(0, 0, 1.27, tip, 2 * Math.PI - tip);
  c.closePath();
  if (as === "solid") {
    c.fillStyle = colours.robot;
    c.fill();
  } else {
    c.fillStyle = colours.floor;
    c.fill();
    c.strokeStyle = as === "hollow" ? colours.ink2 : colours.goalInk;
    c.lineWidth = 0.18;
    c.setLineDash([0.34, 0.22]);
    c.stroke();
    c.setLineDash([]);
  }
  c.fillStyle = as === "solid" ? colours.onRobot : as === "hollow" ? colours.ink2 : colours.goalInk;
  for (const side of [-0.46, 0.46]) {
    c.beginPath();
    c.arc(0.42, side, 0.27, 0, 2 * Math.PI);
    c.fill();
  }
  c.restore();
}

function paintNote(c: CanvasRenderingContext2D, look: LiveLook, at: Pose): void {
  const { view: v, colours, unit } = look;
  const [x, y] = toScreen(v, [at.x, at.y]);
  c.font = `700 ${13 * unit}px Cantarell, "Segoe UI", system-ui, sans-serif`;
  const left = x + 26 * unit + c.measureText(look.note).width < v.width;
  c.textAlign = left ? "left" : "right";
  const tx = x + (left ? 24 : -24) * unit;
  c.lineJoin = "round";
  c.strokeStyle = colours.floor;
  c.lineWidth = 4 * unit;
  c.strokeText(look.note, tx, y - 6 * unit);
  c.fillStyle = colours.ink2;
  c.fillText(look.note, tx, y - 6 * unit);
}

function paintMarker(c: CanvasRenderingContext2D, look: LiveLook, at: Point): void {
  const [x, y] = toScreen(look.view, at), { unit, colours } = look;
  c.beginPath();
  c.arc(x, y, 10 * unit, 0, 2 * Math.PI);
  c.fillStyle = withAlpha(colours.goal, 0.35);
  c.fill();
  c.strokeStyle = colours.goalInk;
  c.lineWidth = 2.4 * unit;
  c.stroke();
  c.beginPath();
  c.arc(x, y, 2.6 * unit, 0, 2 * Math.PI);
  c.fillStyle = colours.goalInk;
  c.fill();
}

function paintCross(c: CanvasRenderingContext2D, look: LiveLook): void {
  const x = look.view.width / 2, y = look.view.height / 2, r = 14 * look.unit;
  c.strokeStyle = look.colours.focus;
  c.lineWidth = 2 * look.unit;
  c.beginPath();
  c.arc(x, y, r * 0.5, 0, 2 * Math.PI);
  for (const [dx, dy] of [[1, 0], [-1, 0], [0, 1], [0, -1]] as const) {
    c.moveTo(x + dx * r * 0.5, y + dy * r * 0.5);
    c.lineTo(x + dx * r * 1.3, y + dy * r * 1.3);
  }
  c.stroke();
}
