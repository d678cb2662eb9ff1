// Draws a museum's map from its plan: `node web/tools/draw-site.mjs static/sites/rhine-hall`
// reads plan.json in that folder and writes map.pgm (binary, 8 bit) and map.yaml, as ROS map_server has them.
//
// plan.json, lengths in metres, x right, y up, origin in the lower left corner of the map:
//   size        [width, height] of the whole map
//   resolution  edge of a cell
//   outer_wall  thickness of the wall that is drawn round all floors
//   floors      shapes where one can walk; what no floor covers stays unknown
//   walls       shapes, drawn on the floors
//   doors       shapes, cut out of the walls again
//   solids      shapes, drawn last: columns, plinths, furniture; all that a laser in 30 cm height sees
// A shape has one of  box [x0, y0, x1, y1],  disc [x, y, radius],  polygon [[x, y], ...],
// line [[x, y], ...] with width;  and a name for the reader. Glass, edges and low plates are not drawn here:
// they are hazards and stand in site.toml.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const unknown = 205, free = 254, occupied = 0;

// Returns a function that tells whether a point lies in the shape.
function inside(shape) {
  if (shape.box) {
    const [x0, y0, x1, y1] = shape.box;
    return (x, y) => x >= x0 && x < x1 && y >= y0 && y < y1;
  }
  if (shape.disc) {
    const [cx, cy, r] = shape.disc;
    return (x, y) => Math.hypot(x - cx, y - cy) < r;
  }
  if (shape.polygon) return (x, y) => insidePolygon(shape.polygon, x, y);
  if (shape.line && shape.width > 0) return (x, y) => distanceToLine(shape.line, x, y) < shape.width / 2;
  throw new Error(`shape "${shape.name ?? JSON.stringify(shape)}": needs box, disc, polygon, or line with width`);
}

// [x0, y0, x1, y1] of a sound shape.
function bounds({ box, disc, polygon, line, width }) {
  if (box) return box;
  if (disc) return [disc[0] - disc[2], disc[1] - disc[2], disc[0] + disc[2], disc[1] + disc[2]];
  const points = polygon ?? line, margin = polygon ? 0 : width / 2;
  const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]);
  return [Math.min(...xs) - margin, Math.min(...ys) - margin, Math.max(...xs) + margin, Math.max(...ys) + margin];
}

function insidePolygon(corners, x, y) {
  let odd = false;
  corners.forEach(([ax, ay], i) => {
    const [bx, by] = corners[(i + 1) % corners.length];
    if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
  });
  return odd;
}

function distanceToLine(points, x, y) {
  let least = Infinity;
  for (let i = 0; i + 1 < points.length; ++i) {
    const [ax, ay] = points[i], [bx, by] = points[i + 1];
    const dx = bx - ax, dy = by - ay;
    const t = Math.max(0, Math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
    least = Math.min(least, Math.hypot(x - ax - t * dx, y - ay - t * dy));
  }
  return least;
}

// Cells in rows from the top down, as the file has them.
export function draw(plan) {
  const { resolution } = plan;
  const width = Math.round(plan.size[0] / resolution), height = Math.round(plan.size[1] / resolution);
  const cells = new Uint8Array(width * height).fill(unknown);
  const paint = (shapes, value) => {
    for (const shape of shapes ?? []) {
      const covers = inside(shape);
      const [x0, y0, x1, y1] = bounds(shape).map((edge) => Math.floor(edge / resolution));
      for (let row = Math.max(0, height - 1 - y1); row < Math.min(height, height - y0); ++row) {
        const y = (height - row - 0.5) * resolution;
        for (let column = Math.max(0, x0); column <= Math.min(width - 1, x1); ++column) {
          if (covers((column + 0.5) * resolution, y)) cells[row * width + column] = value;
        }
      }
    }
  };
  paint(plan.floors, free);
  encloseFloors(cells, width, height, Math.round(plan.outer_wall / resolution));
  paint(plan.walls, occupied);
  paint(plan.doors, free);
  paint(plan.solids, occupied);
  return { width, height, cells };
}

// Every unknown cell near a floor becomes wall.
function encloseFloors(cells, width, height, reach) {
  const floor = Uint8Array.from(cells, (value) => (value === free ? 1 : 0));
  const touches = (row, column) => {
    for (let r = Math.max(0, row - reach); r <= Math.min(height - 1, row + reach); ++r)
      for (let c = Math.max(0, column - reach); c <= Math.min(width - 1, column + reach); ++c)
        if (floor[r * width + c]) return true;
    return false;
  };
  for (let row = 0; row < height; ++row)
    for (let column = 0; column < width; ++column)
      if (!floor[row * width + column] && touches(row, column)) cells[row * width + column] = occupied;
}

function main(folder) {
  const plan = JSON.parse(readFileSync(join(folder, "plan.json"), "utf8"));
  const { width, height, cells } = draw(plan);
  writeFileSync(join(folder, "map.pgm"), Buffer.concat([Buffer.from(`P5\n${width} ${height}\n255\n`), cells]));
  writeFileSync(join(folder, "map.yaml"), [
    "image: map.pgm", `resolution: ${plan.resolution}`, "origin: [0.0, 0.0, 0.0]",
    "negate: 0", "occupied_thresh: 0.65", "free_thresh: 0.196", ""].join("\n"));
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  if (process.argv.length !== 3) {
    console.error("usage: node web/tools/draw-site.mjs FOLDER");
    process.exit(2);
  }
  main(process.argv[2]);
}
