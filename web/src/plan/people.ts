// People are seen anew a few times a second and have no names: each new set is matched to the dots on the screen, which glide to
// their new places, appear and fade.
import type { Point } from "../wire/types";

export interface Dot {
  x: number;
  y: number;
  toX: number;
  toY: number;
  alpha: number;
  gone: boolean;
}

const reach = 1.0; // m a person may have walked between two sets
const settle = 0.16; // s
const fade = 0.25; // s

export class PeopleDots {
  dots: Dot[] = [];

  see(people: Point[]): void {
    const free = new Set(this.dots.filter((d) => !d.gone));
    const fresh: Dot[] = [];
    for (const [x, y] of people) {
      let best: Dot | null = null, bestDistance = reach;
      for (const dot of free) {
        const d = Math.hypot(dot.toX - x, dot.toY - y);
        if (d < bestDistance) (best = dot), (bestDistance = d);
      }
      if (best) {
        free.delete(best);
        best.toX = x;
        best.toY = y;
      } else {
        fresh.push({ x, y, toX: x, toY: y, alpha: 0, gone: false });
      }
    }
    for (const dot of free) dot.gone = true;
    this.dots.push(...fresh);
  }

  // True while something still moves.
  step(dt: number, instant: boolean): boolean {
    let moving = false;
    const pull = instant ? 1 : 1 - Math.exp(-dt / settle);
    const grow = instant ? 1 : dt / fade;
    for (const dot of this.dots) {
      if (Math.abs(dot.toX - dot.x) + Math.abs(dot.toY - dot.y) > 0.01 || dot.gone || dot.alpha < 1) moving = true;
      dot.x += (dot.toX - dot.x) * pull;
      dot.y += (dot.toY - dot.y) * pull;
      dot.alpha = dot.gone ? dot.alpha - grow : Math.min(1, dot.alpha + grow);
    }
    this.dots = this.dots.filter((d) => d.alpha > 0);
    return moving;
  }
}
