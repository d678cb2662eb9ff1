import { describe, expect, it } from "vitest";
import { erase, isKnown, isWall, maskOf, outlines, simplify, trace, type Mask } from "../../src/plan/vector";
import { inside } from "../../src/plan/view";
import type { MapInfo, Point } from "../../src/wire/types";
import { randomOf } from "../random";

// A map as one sees it: the first line is the top.
function drawn(lines: string[]): { mask: Mask; map: MapInfo } {
  const width = lines[0]!.length, height = lines.length;
  const mask = new Uint8Array(width * height);
  lines.forEach((line, row) => [...line].forEach((c, i) => (mask[(height - 1 - row) * width + i] = c === "#" ? 1 : 0)));
  return { mask, map: { width, height, resolution: 1, origin: { x: 0, y: 0 }, url: "" } };
}
// Inside by the even-odd rule over all rings.
const filled = (rings: Point[][], p: Point) => rings.filter((ring) => inside(ring, p)).length % 2 === 1;

describe("grey values", () => {
  it("are walls, floor or unknown", () => {
    expect([0, 254, 205].map(isWall)).toEqual([true, false, false]);
    expect([0, 254, 205].map(isKnown)).toEqual([true, true, false]);
  });
});

describe("trace", () => {
  it("finds the border of a wall with a room in it", () => {
    const { mask, map } = drawn(["####", "#..#", "####"]);
    const rings = trace(mask, map.width, map.height);
    expect(rings).toHaveLength(2);
    expect(rings.map((r) => r.length)).toEqual([4, 4]);
  });
  it("treats cells that touch at a corner as apart", () => {
    const { mask, map } = drawn(["#.", ".#"]);
    expect(trace(mask, map.width, map.height)).toHaveLength(2);
  });
  it("encloses exactly the cells of any mask", () => {
    const random = randomOf(3);
    for (let round = 0; round < 60; round++) {
      const width = 3 + Math.floor(random() * 12), height = 3 + Math.floor(random() * 12);
      const mask = Uint8Array.from({ length: width * height }, () => (random() < 0.55 ? 1 : 0));
      const rings = trace(mask, width, height);
      for (let j = 0; j < height; j++) {
        for (let i = 0; i < width; i++) expect(filled(rings, [i + 0.5, j + 0.5]), `${round}: ${i},${j}`).toBe(mask[j * width + i] === 1);
      }
    }
  });
});

describe("outlines", () => {
  it("stand in metres, y up", () => {
    const { mask, map } = drawn(["..", "#."]);
    const [ring] = outlines(mask, { ...map, resolution: 0.5, origin: { x: 10, y: 20 } });
    expect(new Set(ring!.map(String))).toEqual(new Set(["10,20", "10.5,20", "10.5,20.5", "10,20.5"]));
  });
});

describe("simplify", () => {
  it("turns the steps of a slanted wall into few corners and keeps right angles", () => {
    const steps: Point[] = [[0, 0], [20, 0], [20, 20]];
    for (let k = 20; k > 0; k--) steps.push([k, k - 1], [k - 1, k - 1]);
    expect(simplify(steps, 0.75).length).toBeLessThanOrEqual(6);
    const square: Point[] = [[0, 0], [5, 0], [10, 0], [10, 10], [0, 10]];
    const corners = simplify(square, 0.75).map(String);
    for (const corner of ["10,0", "10,10", "0,10"]) expect(corners).toContain(corner);
  });
});

describe("erase", () => {
  it("takes an exhibit out of the map and leaves what stands beside it", () => {
    const { mask, map } = drawn(["########", "#......#", "#..##..#", "#..##..#", "#......#", "########"]);
    erase(mask, map, [[3, 2], [5, 2], [5, 4], [3, 4]], 0);
    const walls = maskOf(mask, (v) => v === 1);
    expect(walls.reduce((sum, v) => sum + v, 0)).toBe(24);
  });
  it("does not mind outlines beyond the map or without area", () => {
    const { mask, map } = drawn(["##", "##"]);
    erase(mask, map, [[-5, -5], [50, -5], [50, 50], [-5, 50]], 3);
    expect([...mask]).toEqual([0, 0, 0, 0]);
    expect(() => erase(mask, map, [[0, 0], [1, 1]], 1)).not.toThrow();
  });
});
