// <docent-plan>: the plan of the hall with the robot moving on it. Two canvases, the ground that stands still and the live layer,
// and between them the exhibits' numbers as buttons. Pan, zoom, pinch, keyboard, follow.
// Events: exhibit-chosen {id}, floor-chosen {x, y}, pose-placed {pose}, follow-changed {on}, plan-ready.
import { LitElement, html } from "lit";
import { say, store, t, Watch } from "../app";
import { clock } from "../i18n";
import { value } from "../store";
import { badgeRadius, isOpenFloor, makeGround, paintGround, type Ground } from "../plan/ground";
import { readColours, type Colours } from "../plan/colours";
import { Gestures } from "../plan/gestures";
import { paintLive } from "../plan/live";
import { Motion } from "../plan/motion";
import { PeopleDots } from "../plan/people";
import { remaining, Trail } from "../plan/path";
import { clampView, type Covered, distance, fit, fitScale, inside, panBy, toMap, toScreen, zoomAt, type View } from "../plan/view";
import type { Point, Pose } from "../wire/types";

export interface Layers {
  people: boolean;
  fan: boolean;
  beams: boolean;
  belief: boolean;
  path: boolean;
  hazards: boolean;
}
export const visitorLayers: Layers = { people: true, fan: true, beams: false, belief: false, path: true, hazards: true };

const dashPace = 0.7; // m/s
const jumpFade = 280; // ms
const still = matchMedia("(prefers-reduced-motion: reduce)");

export class DocentPlan extends LitElement {
  static override properties = {
    layers: { attribute: false }, follow: { type: Boolean }, unit: { type: Number }, marker: { attribute: false }, placing: { attribute: false },
    placeMode: { type: Boolean }, active: { type: Boolean }, span: { type: Number },
  };
  declare layers: Layers;
  declare follow: boolean;
  declare unit: number; // how large symbols and names are drawn, 1: on a desk
  declare marker: Point | null;
  declare placing: Pose | null;
  declare placeMode: boolean; // a press and drag says where the robot is
  declare active: boolean; // exhibits and floor can be picked
  declare span: number; // m shown across when following

  private view: View | null = null;
  private target: View | null = null;
  private ground: Ground | null = null;
  private groundOf: unknown[] = [];
  private groundDirty = true;
  private liveDirty = true;
  private colours: Colours | null = null;
  private readonly motion = new Motion();
  private readonly people = new PeopleDots();
  private readonly trail = new Trail();
  private shown: Pose | null = null;
  private formerly: Pose | null = null; // where it was before it was placed anew
  private jumpedAt = -Infinity;
  private seen = { pose: null as unknown, people: null as unknown, scanAt: 0, belief: null as unknown, path: null as unknown, link: null as unknown };
  private covered: Covered = { left: 0, right: 0 };
  private clear: Point | null = null; // where it stops: no name there
  private dash = 0;
  private cross = false;
  private lastFrame = 0;
  private request = 0;
  private readonly gestures = new Gestures(this);
  private readonly resizes = new ResizeObserver(() => this.resize());
  private readonly themes = new MutationObserver(() => this.recolour());

  constructor() {
    super();
    this.layers = visitorLayers;
    this.follow = false;
    this.unit = 1;
    this.marker = null;
    this.placing = null;
    this.placeMode = false;
    this.active = true;
    this.span = 16;
    new Watch(this, (s) => [s.prefs.lang, s.map, s.site, s.exhibits, s.status?.exhibit, s.link.state]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.resizes.observe(this);
    this.themes.observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
    void document.fonts?.ready.then(() => (this.groundDirty = true));
    this.request = requestAnimationFrame((now) => this.frame(now));
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    cancelAnimationFrame(this.request);
    this.resizes.disconnect();
    this.themes.disconnect();
  }

  override render() {
    const s = store.state, w = t();
    const exhibits = value(s.exhibits) ?? [];
    const next = s.status?.exhibit;
    return html`
      <div class="surface" tabindex="0" role="group" aria-label=${w.planLabel(say(value(s.site)?.title ?? { en: "" }), exhibits.length)}
        aria-describedby="plan-keys" @keydown=${(e: KeyboardEvent) => this.key(e)} @focus=${() => this.setCross(true)} @blur=${() => this.setCross(false)}
        @pointerdown=${this.gestures.down} @pointermove=${this.gestures.move} @pointerup=${this.gestures.up} @pointercancel=${this.gestures.cancel}
        @wheel=${{ handleEvent: this.gestures.wheel, passive: false }}>
        <canvas class="ground" aria-hidden="true"></canvas>
      </div>
      <p id="plan-keys" class="sr">${w.planKeys}</p>
      <div class="badges" role="toolbar" aria-label=${w.exhibits} ?hidden=${!this.ground}>
        ${exhibits.map((e, i) => html`<button class="badge" ?inert=${!this.active} data-exhibit=${e.id} tabindex=${i === 0 ? 0 : -1}
          @click=${() => this.emit("exhibit-chosen", { id: e.id })} @keydown=${(k: KeyboardEvent) => this.badgeKey(k)} @focus=${() => this.showExhibit(e.id)}
          ><span class=${e.id === next ? "no next" : "no"}>${e.number}</span><span class="sr">${say(e.title)}</span></button>`)}
      </div>
      <canvas class="live" aria-hidden="true"></canvas>`;
  }

  override updated(): void {
    const s = store.state;
    const made = [value(s.map), value(s.site), value(s.exhibits)];
    if (made[0] && made[1] && made.some((v, i) => v !== this.groundOf[i])) {
      this.groundOf = made;
      this.ground = makeGround(value(s.map)!, value(s.site)!, value(s.exhibits) ?? []);
      this.view = this.target = null;
      this.requestUpdate();
    }
    this.groundDirty = this.liveDirty = true;
    if (!this.colours) this.recolour();
    this.resize();
  }

  // ---- What the page may ask --------------------------------------------------------------------------------------------

  zoom(factor: number): void {
    const v = this.target ?? this.view;
    if (v) this.aim(zoomAt(v, this.follow && this.shown ? toScreen(v, [this.shown.x, this.shown.y]) : [v.width / 2, v.height / 2], factor));
  }
  whole(): void {
    this.setFollow(false);
    if (this.view && this.ground) this.aim(fit(this.padded(), this.view.width, this.view.height));
  }
  setFollow(on: boolean): void {
    if (on === this.follow) return;
    this.follow = on;
    if (on && this.view) {
      const scale = Math.max(this.view.scale, Math.min(this.view.width, this.view.height) / this.span);
      this.target = { ...(this.target ?? this.view), scale };
    }
    this.emit("follow-changed", { on });
  }
  atWhole(): boolean {
    return !this.view || !this.ground || this.view.scale < fitScale(this.padded(), this.view.width, this.view.height) * 1.02;
  }
  isOpenFloor(at: Point): boolean {
    return this.ground !== null && isOpenFloor(this.ground, at);
  }
  isHazard(at: Point): boolean {
    return (value(store.state.site)?.hazards ?? []).some((h) => inside(h.polygon, at));
  }
  // Something covers the plan from one side: moves it aside so that the point stays in sight. Without a point: back again.
  makeRoom(at: Point | null, side: "left" | "right", px: number): void {
    this.covered = { left: at && side === "left" ? px : 0, right: at && side === "right" ? px : 0 };
    const v = this.target;
    if (!v) return;
    const x = at ? toScreen(v, at)[0] : 0, margin = 70;
    const low = this.covered.left + margin, high = v.width - this.covered.right - margin;
    this.aim(at && low < high ? { ...v, x: v.x + (x < low ? x - low : x > high ? x - high : 0) / v.scale } : v);
  }
  // Where a point of the map is on the screen, in CSS pixels of the page.
  pageOf(at: Point): Point | null {
    if (!this.view) return null;
    const box = this.getBoundingClientRect(), [x, y] = toScreen(this.view, at);
    return [box.left + x, box.top + y];
  }

  // ---- View -------------------------------------------------------------------------------------------------------------

  private padded() {
    const b = this.ground!.bounds, m = 0.15;
    return { minX: b.minX - m, minY: b.minY - m, maxX: b.maxX + m, maxY: b.maxY + m };
  }
  aim(v: View, instant = false): void {
    this.target = clampView(v, this.padded(), this.covered);
    if (instant || still.matches) this.view = this.target;
    this.groundDirty = true;
  }
  current(): View | null {
    return this.view;
  }
  panned(dx: number, dy: number): void {
    if (!this.view) return;
    if (this.follow) this.setFollow(false);
    this.aim(panBy(this.view, dx, dy), true);
  }
  zoomedAt(at: Point, factor: number): void {
    if (this.view) this.aim(zoomAt(this.view, at, factor), true);
  }

  private resize(): void {
    const width = this.clientWidth, height = this.clientHeight;
    if (width < 2 || height < 2 || !this.ground) return;
    const dpr = Math.min(3, devicePixelRatio || 1);
    for (const canvas of this.querySelectorAll("canvas")) {
      if (canvas.width !== Math.round(width * dpr) || canvas.height !== Math.round(height * dpr)) {
        canvas.width = Math.round(width * dpr);
        canvas.height = Math.round(height * dpr);
      }
    }
    if (!this.view) {
      queueMicrotask(() => this.emit("plan-ready", null));
      this.view = this.target = fit(this.padded(), width, height);
      if (this.follow) this.target = { ...this.view, scale: Math.max(this.view.scale, Math.min(width, height) / this.span) };
      if (this.follow) this.view = this.target;
    } else if (this.view.width !== width || this.view.height !== height) {
      const whole = this.atWhole();
      const v = { ...this.view, width, height };
      this.view = this.target = whole ? fit(this.padded(), width, height) : clampView(v, this.padded());
    }
    this.groundDirty = this.liveDirty = true;
  }
  private recolour(): void {
    this.colours = readColours();
    this.groundDirty = this.liveDirty = true;
  }

  // ---- Every frame ------------------------------------------------------------------------------------------------------

  private frame(now: number): void {
    this.request = requestAnimationFrame((next) => this.frame(next));
    const dt = Math.min(0.1, (now - this.lastFrame) / 1000);
    this.lastFrame = now;
    if (!this.ground || !this.view || !this.colours) return;
    this.takeIn(now, dt);
    this.moveView(dt);
    if (this.groundDirty) this.paintGround();
    if (this.liveDirty) this.paintLive(now);
  }

  private takeIn(now: number, dt: number): void {
    const s = store.state, seen = this.seen;
    const calm = still.matches;
    if (s.pose && s.pose !== seen.pose) {
      seen.pose = s.pose;
      this.motion.push(s.pose, now);
      if (this.motion.jumped) {
        this.motion.jumped = false;
        this.formerly = this.shown;
        this.jumpedAt = now;
        this.trail.clear();
      }
    }
    if (s.people !== seen.people) this.people.see((seen.people = s.people));
    const robot = calm ? this.motion.newest() : this.motion.at(now);
    const was = this.shown;
    this.shown = robot ?? s.status?.pose ?? null;
    if (this.shown && this.trail.add([this.shown.x, this.shown.y])) this.liveDirty = true;
    const moved = !was || !this.shown || Math.hypot(was.x - this.shown.x, was.y - this.shown.y) * this.view!.scale > 0.05 || was.theta !== this.shown.theta;
    const drifting = this.layers.path && s.path.length > 1 && !calm && s.link.state === "live";
    if (drifting) this.dash += dashPace * dt;
    const stop = this.layers.path ? s.path.at(-1) ?? (s.status?.activity === "explaining" ? this.shown && ([this.shown.x, this.shown.y] as Point) : this.clear) : null;
    if (stop && (!this.clear || distance(stop, this.clear) > 0.4)) {
      this.clear = stop;
      this.groundDirty = true;
    }
    const news = s.scanAt !== seen.scanAt || s.belief !== seen.belief || s.path !== seen.path || s.link !== seen.link;
    Object.assign(seen, { scanAt: s.scanAt, belief: s.belief, path: s.path, link: s.link });
    if (this.people.step(dt, calm) || moved || drifting || news || now - this.jumpedAt < jumpFade) this.liveDirty = true;
  }

  private moveView(dt: number): void {
    let target = this.target!;
    if (this.follow && this.shown) target = this.target = clampView({ ...target, x: this.shown.x, y: this.shown.y }, this.padded(), this.covered);
    const v = this.view!;
    const far = Math.hypot(target.x - v.x, target.y - v.y) * v.scale + Math.abs(Math.log(target.scale / v.scale)) * 200;
    if (far < 0.05) return;
    const pull = still.matches || far < 0.3 ? 1 : 1 - Math.exp(-dt / 0.09);
    this.view = { ...target, x: v.x + (target.x - v.x) * pull, y: v.y + (target.y - v.y) * pull, scale: v.scale * (target.scale / v.scale) ** pull };
    this.groundDirty = this.liveDirty = true;
  }

  private paintGround(): void {
    const canvas = this.querySelector<HTMLCanvasElement>("canvas.ground");
    const context = canvas?.getContext("2d");
    if (!context) return;
    this.groundDirty = false;
    const s = store.state;
    paintGround(context, this.ground!, {
      view: this.view!, dpr: canvas!.width / this.view!.width, unit: this.scaleUnit(), colours: this.colours!,
      names: new Map((value(s.exhibits) ?? []).map((e) => [e.id, say(e.title)])),
      areas: (value(s.site)?.areas ?? []).map((a) => ({ text: say(a.title), at: [a.x, a.y] })),
      next: s.status?.exhibit ?? null, quiet: s.exhibits.state === "loading", hazards: this.layers.hazards, keepClear: this.clear ? [this.clear] : [],
    });
    this.placeBadges();
  }

  private placeBadges(): void {
    const v = this.view!, shapes = new Map(this.ground!.exhibits.map((e) => [e.id, e]));
    for (const badge of this.querySelectorAll<HTMLElement>(".badge")) {
      const shape = shapes.get(badge.dataset.exhibit!);
      if (!shape) continue;
      const [x, y] = toScreen(v, shape.centre), r = badgeRadius(this.scaleUnit());
      badge.hidden = x < -r || y < -r || x > v.width + r || y > v.height + r;
      badge.style.transform = `translate(${x.toFixed(2)}px, ${y.toFixed(2)}px) translate(-50%, -50%)`;
    }
  }

  private paintLive(now: number): void {
    const canvas = this.querySelector<HTMLCanvasElement>("canvas.live");
    const context = canvas?.getContext("2d");
    if (!context) return;
    this.liveDirty = false;
    const s = store.state, { layers } = this;
    const lost = s.link.state === "lost";
    const since = (now - this.jumpedAt) / jumpFade;
    const leaving = since < 0.5 && this.formerly !== null && !still.matches;
    const robot = leaving ? this.formerly : this.shown;
    const footprint = value(s.site)?.footprint;
    paintLive(context, {
      view: this.view!, dpr: canvas!.width / this.view!.width, unit: this.scaleUnit(), colours: this.colours!, robot, lost,
      robotAlpha: since >= 1 || still.matches ? 1 : leaving ? 1 - since * 2 : since * 2 - 1,
      radius: footprint ? Math.max(footprint.half_width, (footprint.front + footprint.rear) / 2) : 0.35,
      path: layers.path && !lost && robot ? remaining(s.path, [robot.x, robot.y]) : [], dash: this.dash,
      trail: layers.path && !lost ? this.trail.points.slice(0, -1) : [], people: layers.people && !lost ? this.people.dots : [],
      scans: lost ? [] : s.scans, fan: layers.fan, beams: layers.beams, belief: layers.belief && !lost ? s.belief : [], placing: this.placing,
      marker: this.marker, note: s.link.heardAt ? t().lastSeen(clock(s.link.heardAt, s.prefs.lang)) : "", cross: this.cross,
    });
  }

  private scaleUnit(): number {
    return this.unit * (parseFloat(getComputedStyle(document.documentElement).fontSize) / 16);
  }

  // ---- Picking ----------------------------------------------------------------------------------------------------------

  clicked(at: Point): void {
    if (!this.view || !this.ground) return;
    const place = toMap(this.view, at);
    if (this.placeMode || !this.active) return;
    const hit = this.ground.exhibits.find((e) => inside(e.outline, place));
    if (hit) this.emit("exhibit-chosen", { id: hit.id });
    else this.emit("floor-chosen", { x: place[0], y: place[1] });
  }
  placed(from: Point, to: Point): void {
    if (!this.view) return;
    const a = toMap(this.view, from), b = toMap(this.view, to);
    const theta = Math.hypot(to[0] - from[0], to[1] - from[1]) > 8 ? Math.atan2(b[1] - a[1], b[0] - a[0]) : (this.placing?.theta ?? 0);
    this.emit("pose-placed", { pose: { x: a[0], y: a[1], theta } });
  }

  private key(e: KeyboardEvent): void {
    const v = this.view;
    if (!v || e.ctrlKey || e.metaKey || e.altKey) return;
    const step = Math.min(v.width, v.height) * 0.12;
    const keys: Record<string, () => void> = {
      ArrowLeft: () => this.nudge(step, 0), ArrowRight: () => this.nudge(-step, 0), ArrowUp: () => this.nudge(0, step), ArrowDown: () => this.nudge(0, -step),
      "+": () => this.zoom(1.3), "=": () => this.zoom(1.3), "-": () => this.zoom(1 / 1.3), "0": () => this.whole(), f: () => this.setFollow(!this.follow),
      Enter: () => this.placeMode ? this.placed([v.width / 2, v.height / 2], [v.width / 2, v.height / 2]) : this.clicked([v.width / 2, v.height / 2]),
    };
    const act = keys[e.key];
    if (!act) return;
    e.preventDefault();
    act();
  }
  private nudge(dx: number, dy: number): void {
    if (this.follow) this.setFollow(false);
    // At the whole plan there is nowhere to move: go closer first, so that the cross-hair can reach every place.
    if (this.atWhole()) this.zoom(1.6);
    this.aim(panBy(this.target!, dx, dy));
  }
  private badgeKey(e: KeyboardEvent): void {
    const badges = [...this.querySelectorAll<HTMLElement>(".badge")];
    const here = badges.indexOf(e.currentTarget as HTMLElement);
    const step = e.key === "ArrowRight" || e.key === "ArrowDown" ? 1 : e.key === "ArrowLeft" || e.key === "ArrowUp" ? -1 : 0;
    if (step === 0) return;
    e.preventDefault();
    const to = badges[(here + step + badges.length) % badges.length]!;
    to.hidden = false;
    badges.forEach((b) => (b.tabIndex = b === to ? 0 : -1));
    to.focus({ preventScroll: true });
  }
  private showExhibit(id: string): void {
    const shape = this.ground?.exhibits.find((e) => e.id === id);
    const v = this.target;
    if (!shape || !v) return;
    const [x, y] = toScreen(v, shape.centre);
    if (x > 20 && y > 20 && x < v.width - 20 && y < v.height - 20) return;
    if (this.follow) this.setFollow(false);
    this.aim({ ...v, x: shape.centre[0], y: shape.centre[1] });
  }
  private setCross(on: boolean): void {
    this.cross = on && (this.querySelector(".surface")?.matches(":focus-visible") ?? false);
    this.liveDirty = true;
  }

  private emit(name: string, detail: unknown): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true }));
  }
}
customElements.define("docent-plan", DocentPlan);
