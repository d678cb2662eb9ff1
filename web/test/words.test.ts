import { readFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { describe, expect, it } from "vitest";
import { de } from "../src/i18n/de";
import { en } from "../src/i18n/en";
import { about, clock, countdown, decimal, metres } from "../src/i18n/format";
import { moodOf } from "../src/mood";
import type { Activity, Status } from "../src/wire/types";

describe("numbers in words people use", () => {
  it("are lengths, durations and clocks", () => {
    expect(metres(3.24, "en")).toBe("3.2 m");
    expect(metres(3.24, "de")).toBe("3,2 m");
    expect(metres(14.4, "en")).toBe("14 m");
    expect(metres(2140, "en")).toBe("2.14 km");
    expect(about(2, "en")).toBe("in a moment");
    expect(about(38, "en")).toBe("about 40 s");
    expect(about(240, "de")).toBe("4 min");
    expect(about(4200, "en")).toBe("1 h 10 min");
    expect(about(7200, "en")).toBe("2 h");
    expect([de.watching(1), de.watching(1204)]).toEqual(["1 schaut zu", "1.204 schauen zu"]);
    expect(countdown(100)).toBe("1:40");
    expect(countdown(-3)).toBe("0:00");
    expect(decimal(0.7, 2, "de")).toBe("0,70");
    expect(clock(Date.UTC(2026, 10, 23, 12, 4, 6), "en")).toMatch(/^\d\d:\d\d:\d\d$/);
  });
});

describe("tone of voice", () => {
  const texts = (value: unknown): string[] =>
    typeof value === "string" ? [value]
      : typeof value === "function" ? [String((value as (...a: unknown[]) => unknown)(2, "x"))]
        : value && typeof value === "object" ? Object.values(value).flatMap(texts) : [];
  it("has no exclamation marks and no empty words, in either language", () => {
    for (const [name, catalogue] of Object.entries({ en, de })) {
      for (const text of texts(catalogue)) {
        expect(text, name).not.toMatch(/!/);
        expect(text.trim(), name).not.toBe("");
        expect(text, name).not.toContain("undefined");
      }
    }
  });
  it("says the same things in both languages", () => {
    const keys = (value: object, path = ""): string[] =>
      Object.entries(value).flatMap(([k, v]) => (v && typeof v === "object" ? keys(v, `${path}${k}.`) : [`${path}${k}`])).sort();
    expect(keys(de)).toEqual(keys(en));
  });
});

describe("contrast of the tokens", () => {
  const css = readFileSync(join(dirname(fileURLToPath(import.meta.url)), "../src/style/tokens.css"), "utf8");
  const block = (selector: string) => css.slice(css.indexOf(selector), css.indexOf("\n}", css.indexOf(selector)));
  const values = (text: string) => Object.fromEntries([...text.matchAll(/--([a-z0-9-]+):\s*(#[0-9A-Fa-f]{6})\b/g)].map((m) => [m[1]!, m[2]!]));
  const light = values(block(":root {")), dark = { ...light, ...values(block(':root[data-theme="dark"]')) };
  const luminance = (hex: string) => {
    const [r, g, b] = [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16) / 255).map((c) => (c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4));
    return 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
  };
  const contrast = (a: string, b: string) => {
    const [x, y] = [luminance(a), luminance(b)].sort((p, q) => q - p);
    return (x! + 0.05) / (y! + 0.05);
  };
  const pairs: [string, string, number][] = [
    ["ink", "wall", 7], ["ink", "panel", 7], ["ink", "sunk", 7], ["ink-2", "wall", 4.5], ["ink-2", "panel", 4.5], ["ink-2", "sunk", 4.5],
    ["robot-ink", "panel", 4.5], ["robot-ink", "wall", 4.5], ["on-reseda", "reseda", 4.5], ["reseda-ink", "reseda-tint", 4.5], ["stop-ink", "panel", 4.5],
    ["on-stop-plate", "stop-plate", 4.5], ["stop-ink", "stop-tint", 4.5], ["goal-ink", "panel", 4.5], ["goal-ink", "goal-tint", 4.5], ["on-goal", "goal", 4.5],
    ["robot", "floor", 3], ["people", "floor", 3], ["hazard", "floor", 3], ["line-strong", "panel", 3], ["poche", "floor", 3], ["exhibit", "floor", 4.5],
    ["panel", "exhibit", 4.5], ["focus", "wall", 3], ["focus", "panel", 3], ["on-night", "night", 7], ["on-night-2", "night", 4.5],
  ];
  it.each([["light", light], ["dark", dark]])("holds in the %s theme", (_, theme) => {
    for (const [a, b, needed] of pairs) {
      expect(theme[a], a).toBeDefined();
      expect(theme[b], b).toBeDefined();
      expect(contrast(theme[a]!, theme[b]!), `${a} on ${b}`).toBeGreaterThanOrEqual(needed);
    }
  });
});

describe("mood", () => {
  const status = (activity: Activity, why = "none") => ({ activity, why }) as Status;
  it("is stern only after asking nicely, and briefly", () => {
    const waits = [0, 10, 18, 30].map((s) => moodOf(status("waiting", "people_in_the_way"), null, s));
    expect(waits).toEqual(["neutral", "sad", "angry", "sad"]);
  });
  it("is happy where it tells something", () => {
    expect(moodOf(status("explaining"), null, 0)).toBe("happy");
    expect(moodOf(status("faulted"), null, 0)).toBe("sad");
    expect(moodOf(null, null, 0)).toBe("neutral");
  });
});
