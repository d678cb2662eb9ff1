// Fingers, mouse and wheel on the plan: one moves it, two turn closer or farther, a press without movement picks.
import type { Point } from "../wire/types";
import type { View } from "./view";

export interface Gesturable {
  placeMode: boolean;
  current(): View | null;
  panned(dx: number, dy: number): void;
  zoomedAt(at: Point, factor: number): void;
  clicked(at: Point): void;
  placed(from: Point, to: Point): void;
}

const slop = 6; // px a press may wander and still be a press

export class Gestures {
  private readonly fingers = new Map<number, Point>();
  private start: Point = [0, 0];
  private wandered = false;

  constructor(private readonly plan: Gesturable) {}

  private at(e: MouseEvent): Point {
    const box = (e.currentTarget as HTMLElement).getBoundingClientRect();
    return [e.clientX - box.left, e.clientY - box.top];
  }

  readonly down = (e: PointerEvent): void => {
    if (e.button !== 0) return;
    (e.currentTarget as HTMLElement).setPointerCapture(e.pointerId);
    const at = this.at(e);
    this.fingers.set(e.pointerId, at);
    if (this.fingers.size === 1) {
      this.start = at;
      this.wandered = false;
    } else {
      this.wandered = true;
    }
  };

  readonly move = (e: PointerEvent): void => {
    const was = this.fingers.get(e.pointerId);
    if (!was) return;
    const at = this.at(e);
    if (Math.hypot(at[0] - this.start[0], at[1] - this.start[1]) > slop) this.wandered = true;
    if (this.fingers.size === 1) {
      if (this.plan.placeMode) this.plan.placed(this.start, at);
      else if (this.wandered) this.plan.panned(at[0] - was[0], at[1] - was[1]);
      else return;
      this.fingers.set(e.pointerId, at);
      return;
    }
    const other = [...this.fingers].find(([id]) => id !== e.pointerId)![1];
    this.fingers.set(e.pointerId, at);
    const before = Math.hypot(was[0] - other[0], was[1] - other[1]), after = Math.hypot(at[0] - other[0], at[1] - other[1]);
    this.plan.panned((at[0] - was[0]) / 2, (at[1] - was[1]) / 2);
    if (before > 10) this.plan.zoomedAt([(at[0] + other[0]) / 2, (at[1] + other[1]) / 2], after / before);
  };

  readonly up = (e: PointerEvent): void => {
    if (!this.fingers.delete(e.pointerId)) return;
    if (this.fingers.size > 0) return;
    if (this.plan.placeMode) this.plan.placed(this.start, this.at(e));
    else if (!this.wandered) this.plan.clicked(this.start);
  };

  readonly cancel = (e: PointerEvent): void => {
    this.fingers.delete(e.pointerId);
  };

  // Where the page itself can scroll, the wheel belongs to the page, unless Ctrl is held (which is also what a pinch on a pad sends).
  readonly wheel = (event: Event): void => {
    const e = event as WheelEvent;
    const scrolls = document.documentElement.scrollHeight > innerHeight + 1;
    if (scrolls && !e.ctrlKey) return;
    e.preventDefault();
    const lines = e.deltaMode === 1 ? 30 : 1;
    this.plan.zoomedAt(this.at(e), Math.exp(-e.deltaY * lines * (e.ctrlKey ? 0.008 : 0.0022)));
  };
}
