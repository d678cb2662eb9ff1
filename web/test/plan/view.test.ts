import { describe, expect, it } from "vitest";
import { breakName, placeLabels, type Anchor, type Box } from "../../src/plan/labels";
import { centroid, clampView, fit, inside, panBy, toMap, toScreen, zoomAt, type View } from "../../src/plan/view";
import { orientedBox } from "../../src/plan/art";
import { randomOf } from "../random";

const hall = { minX: 0, minY: 0, maxX: 60, maxY: 50 };
const view: View = { x: 30, y: 25, scale: 10, width: 600, height: 500 };

describe("view", () => {
  it("goes to the screen and back", () => {
    const random = randomOf(2);
    for (let k = 0; k < 200; k++) {
      const v = { x: random() * 60, y: random() * 50, scale: 2 + random() * 80, width: 800, height: 300 };
      const p: [number, number] = [random() * 60, random() * 50];
      const back = toMap(v, toScreen(v, p));
      expect(back[0]).toBeCloseTo(p[0], 9);
      expect(back[1]).toBeCloseTo(p[1], 9);
    }
  });
  it("has y up on the map and down on the screen", () => {
    expect(toScreen(view, [30, 50])).toEqual([300, 0]);
  });
  it("zooms with the point under the finger in place", () => {
    const at: [number, number] = [120, 80];
    const before = toMap(view, at), after = toMap(zoomAt(view, at, 1.7), at);
    expect(after[0]).toBeCloseTo(before[0], 9);
    expect(after[1]).toBeCloseTo(before[1], 9);
  });
  it("never leaves the hall nor shows less than a metre or more than everything", () => {
    expect(clampView(panBy(view, 9999, -9999), hall)).toMatchObject({ x: 30, y: 25 });
    expect(clampView({ ...view, scale: 0.001 }, hall).scale).toBe(10);
    expect(clampView({ ...view, scale: 1e9 }, hall).scale).toBe(160);
    const close = clampView({ ...view, scale: 100, x: -50, y: 900 }, hall);
    expect(close).toMatchObject({ x: 3, y: 47.5 });
  });
  it("fits the whole hall", () => {
    expect(fit(hall, 300, 500)).toMatchObject({ scale: 5, x: 30, y: 25 });
  });
});

describe("shapes", () => {
  const box: [number, number][] = [[1, 1], [5, 1], [5, 3], [1, 3]];
  it("know their middle and what is inside", () => {
    expect(centroid(box)).toEqual([3, 2]);
    expect(inside(box, [2, 2])).toBe(true);
    expect(inside(box, [2, 3.5])).toBe(false);
  });
  it("lie along their longer side, however they are turned", () => {
    const random = randomOf(9);
    for (let k = 0; k < 50; k++) {
      const turn = random() * 6;
      const turned = box.map(([x, y]) => [x * Math.cos(turn) - y * Math.sin(turn), x * Math.sin(turn) + y * Math.cos(turn)] as [number, number]);
      const found = orientedBox(turned);
      expect(found.a).toBeCloseTo(2, 6);
      expect(found.b).toBeCloseTo(1, 6);
      expect(Math.abs(Math.sin(found.angle - turn))).toBeLessThan(1e-6);
    }
  });
});

describe("names on the plan", () => {
  const anchor = (id: string, x: number, y: number, must = false): Anchor => ({ id, lines: [id], width: 60, lineHeight: 14, at: [x, y], half: [12, 12], must });
  const window = { x0: 0, y0: 0, x1: 800, y1: 600 };
  it("move in from the window's edge", () => {
    const [placed] = placeLabels([anchor("a", 10, 100)], [], () => 0, window);
    expect(placed!.x - 30).toBeGreaterThanOrEqual(0);
  });
  it("of rooms make way for those of exhibits, or are left out", () => {
    const room = { ...anchor("room", 100, 120), on: true };
    expect(placeLabels([room], [], () => 0, window)).toMatchObject([{ id: "room", x: 100 }]);
    const [name, moved] = placeLabels([room, anchor("a", 100, 100)], [], () => 0, window);
    expect(name!.id).toBe("a");
    expect(Math.abs(moved!.y - name!.y)).toBeGreaterThanOrEqual(14);
    const crowded = [{ x0: 0, y0: 60, x1: 200, y1: 180 }];
    expect(placeLabels([room], crowded, () => 0, window)).toEqual([]);
  });
  it("of rooms stay in their room", () => {
    const room = { ...anchor("room", 100, 100), on: true };
    const wall = (box: Box) => (box.y0 < 118 && box.y1 > 114 ? 0.2 : 0);
    const crowded = [{ x0: 0, y0: 60, x1: 200, y1: 112 }];
    expect(placeLabels([room], crowded, () => 0, window)).toHaveLength(1);
    expect(placeLabels([room], crowded, wall, window)).toEqual([]);
  });
  it("are not cut by the window's edge where they can stand elsewhere", () => {
    const [placed] = placeLabels([anchor("a", 100, 15)], [{ x0: 0, y0: 30, x1: 200, y1: 60 }], () => 0, window);
    expect(placed!.y).toBeGreaterThan(10);
    expect(placed!.align).not.toBe("center");
  });
  it("do not cut even one letter of each other", () => {
    const [, moved] = placeLabels([{ ...anchor("a", 100, 100), half: [12, 12] }, { ...anchor("room", 158, 123), on: true }], [], () => 0, window);
    expect(moved!.y).not.toBeCloseTo(123 + 14 * 0.3, 0);
  });
  it("stand below when there is room", () => {
    const [placed] = placeLabels([anchor("a", 100, 100)], [], () => 0, window);
    expect(placed).toMatchObject({ align: "center", x: 100 });
    expect(placed!.y).toBeGreaterThan(112);
  });
  it("make way for each other", () => {
    const placed = placeLabels([anchor("a", 100, 100), anchor("b", 130, 100)], [], () => 0, window);
    expect(placed).toHaveLength(2);
    expect(placed[0]!.y).not.toBe(placed[1]!.y);
  });
  it("are left out where nothing is free, except the next stop's", () => {
    const everywhere = [{ x0: -1000, y0: -1000, x1: 1000, y1: 1000 }];
    expect(placeLabels([anchor("a", 0, 0)], everywhere, () => 0, window)).toEqual([]);
    expect(placeLabels([anchor("a", 0, 0, true)], everywhere, () => 0, window)).toHaveLength(1);
  });
  it("break near their middle", () => {
    const measure = (text: string) => text.length;
    expect(breakName("Spark transmitter", measure, 10)).toEqual(["Spark", "transmitter"]);
    expect(breakName("Balancier-Dampfmaschine", measure, 10)).toEqual(["Balancier-", "Dampfmaschine"]);
    expect(breakName("Birch-bark canoe", measure, 10)).toEqual(["Birch-bark", "canoe"]);
    expect(breakName("Orrery", measure, 10)).toEqual(["Orrery"]);
    expect(breakName("Planetenmaschine", measure, 10)).toEqual(["Planetenmaschine"]);
  });
});
