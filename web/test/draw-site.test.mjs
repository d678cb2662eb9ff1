import { readdirSync, readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import { draw } from "../tools/draw-site.mjs";

const sites = fileURLToPath(new URL("../../static/sites/", import.meta.url));
const picture = ({ width, cells }) => {
  const signs = { 0: "#", 254: ".", 205: "?" };
  const text = Array.from(cells, (value) => signs[value]).join("");
  return text.match(new RegExp(`.{${width}}`, "g"));
};

describe("draw", () => {
  it("encloses floors, cuts doors and puts solids last", () => {
    const plan = {
      size: [9, 6], resolution: 1, outer_wall: 1,
      floors: [{ box: [1, 1, 7, 5] }],
      walls: [{ box: [4, 1, 5, 5] }],
      doors: [{ box: [4, 2, 5, 3] }],
      solids: [{ disc: [2.5, 3.5, 0.6] }],
    };
    expect(picture(draw(plan))).toEqual([
      "########?",
      "#...#..#?",
      "#.#.#..#?",
      "#......#?",
      "#...#..#?",
      "########?",
    ]);
  });

  it("says which shape it does not understand", () => {
    const plan = { size: [1, 1], resolution: 1, outer_wall: 0, floors: [{ name: "hall" }] };
    expect(() => draw(plan)).toThrow(/"hall".*needs box/);
  });
});

describe.each(readdirSync(sites, { withFileTypes: true }).filter((e) => e.isDirectory()).map((e) => e.name))("%s", (site) => {
  it("has the map that its plan gives", () => {
    const { width, height, cells } = draw(JSON.parse(readFileSync(`${sites}${site}/plan.json`, "utf8")));
    const expected = Buffer.concat([Buffer.from(`P5\n${width} ${height}\n255\n`), cells]);
    expect(readFileSync(`${sites}${site}/map.pgm`).equals(expected)).toBe(true);
  });
});
