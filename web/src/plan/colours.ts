// The colours of the plan, read from the design tokens whenever the theme changes. A canvas cannot read variables by itself.
const names = {
  floor: "--floor", poche: "--poche", panel: "--panel", ink: "--ink", ink2: "--ink-2", line: "--line", lineStrong: "--line-strong", exhibit: "--exhibit",
  exhibitFill: "--exhibit-fill", goal: "--goal", goalInk: "--goal-ink", robot: "--robot", onRobot: "--on-robot", robotTint: "--robot-tint",
  people: "--people", hazard: "--hazard", hazardFill: "--hazard-fill", laser: "--laser", stop: "--stop", focus: "--focus",
} as const;

export type Colours = Record<keyof typeof names, string>;

export function readColours(): Colours {
  const style = getComputedStyle(document.documentElement);
  return Object.fromEntries(Object.entries(names).map(([key, token]) => [key, style.getPropertyValue(token).trim()])) as Colours;
}

// The same colour, see-through.
export function withAlpha(hex: string, alpha: number): string {
  const n = Math.round(Math.min(1, Math.max(0, alpha)) * 255);
  return hex.slice(0, 7) + n.toString(16).padStart(2, "0");
}
