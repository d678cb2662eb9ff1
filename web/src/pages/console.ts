// The staff's console: Stop first, then what the robot knows and why it does what it does.
import { LitElement, html, nothing } from "lit";
import { api } from "../api";
import { connection, lang, problemWords, say, start, store, t, Ticking, Watch } from "../app";
import { clock, count, decimal, metres } from "../i18n";
import { value } from "../store";
import { icon, mark } from "../parts/icons";
import { languageSwitch, lineState, themeSwitch } from "../parts/top";
import type { DocentPlan, Layers } from "../parts/plan";
import type { Device, Mode, Note, Pose } from "../wire/types";
import "../parts/cameras";
import "../parts/plan";
import "../parts/queue";
import "../parts/velocity_space";

const shownLayers = ["belief", "beams", "path", "people", "hazards"] as const;
const statisticsEvery = 15_000; // ms
const staleAfter = 2; // s without a word from a device

class DocentConsole extends LitElement {
  static override properties = {
    layers: { state: true }, placing: { state: true }, placeMode: { state: true }, trouble: { state: true }, stopWord: { state: true }, badPassword: { state: true },
    follow: { state: true }, known: { state: true },
  };
  declare layers: Layers;
  declare placing: Pose | null;
  declare placeMode: boolean;
  declare trouble: string;
  declare stopWord: string;
  declare badPassword: string;
  declare follow: boolean;
  declare known: boolean; // who is at the console

  constructor() {
    super();
    this.layers = { people: true, fan: false, beams: true, belief: true, path: true, hazards: true };
    this.placing = null;
    this.placeMode = this.follow = this.known = false;
    this.trouble = this.stopWord = this.badPassword = "";
    new Watch(this, (s) => [s.prefs, s.link, s.session, s.site, s.status, s.health, s.notes, s.statistics, s.viewers, s.map.state]);
    new Ticking(this, 1000, () => store.state.link.state === "lost");
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("keydown", (e) => this.spaceStops(e), { capture: true });
    api.session().then((session) => {
      store.set({ session });
      this.known = true;
    }, () => (this.known = true));
    void this.readStatistics();
    setInterval(() => void this.readStatistics(), statisticsEvery);
    api.health().then((health) => {
      const notes: Note[] = [...health.notes].sort((a, b) => b.time - a.time).map((n, i) => ({ ...n, seq: -i }));
      store.set({ health, notes: store.state.notes.length > 0 ? store.state.notes : notes });
    }, () => {});
  }
  private async readStatistics(): Promise<void> {
    if (document.hidden) return;
    try {
      store.set({ statistics: await api.statistics() });
    } catch {
      // the old figures stay
    }
  }

  // Space stops wherever the focus is, but for text being typed.
  private spaceStops(e: KeyboardEvent): void {
    if (e.code !== "Space" || e.repeat || !store.state.session.staff) return;
    const at = e.target as HTMLElement;
    if (at instanceof HTMLInputElement && at.type !== "radio" && at.type !== "checkbox") return;
    e.preventDefault();
    e.stopPropagation();
    void this.stopNow();
  }
  private async stopNow(): Promise<void> {
    this.stopWord = t().console.stopSent;
    try {
      await api.stop();
      this.stopWord = "";
    } catch (error) {
      this.stopWord = `${t().console.stopFailed} ${problemWords(error)}`;
    }
  }
  private async act(run: () => Promise<unknown>): Promise<void> {
    this.trouble = "";
    try {
      await run();
    } catch (error) {
      this.trouble = problemWords(error);
    }
  }

  override render() {
    const s = store.state, w = t();
    document.title = `Docent · ${w.console.title}`;
    return html`
      <header class="top"><a class="brand" href="/console">${mark}Docent<span class="house">${w.console.title}</span></a>
        <div class="end">${lineState(w.console.connected, false)}
          ${s.status?.battery === null || !s.status ? nothing : html`<span class="kv" aria-label=${`${w.console.battery} ${Math.round(s.status.battery * 100)} %`}>${icon("battery")}<b>${Math.round(s.status.battery * 100)} %</b></span>`}
          ${themeSwitch()}${languageSwitch()}</div>
        <div class="stopbox">${this.known && !s.session.staff ? nothing : this.stopPart()}</div></header>
      ${this.known && !s.session.staff ? this.signIn() : html`<main data-line=${s.link.state}>
        ${this.nowPart()}<div class="col a">${this.healthPart()}${this.modePart()}${this.figures()}</div>
        ${this.planPart()}
        <section class="plate q"><docent-queue staff></docent-queue></section>
        ${this.eventsPart()}
        <div class="col s"><section class="plate"><header><h2>${w.console.velocity}</h2><span class="small muted">${w.console.velocityHint}</span></header><docent-velocity-space></docent-velocity-space></section>
          <section class="cams" aria-label=${w.cameras}><docent-cameras side></docent-cameras></section></div>
      </main>`}`;
  }

  private stopPart() {
    const w = t().console, stopped = store.state.status?.stopped ?? false;
    return html`${stopped
      ? html`<div class="halted"><p><b>${w.stopped}</b><span>${w.resumeHint}</span></p><button class="btn main" @click=${() => this.act(api.resume)}>${icon("play")}${w.resume}</button></div>`
      : html`<button class="bigstop" @click=${() => this.stopNow()}>${icon("stop")}<span>${w.stop}</span><small>${w.orSpace}</small></button>`}
      <p class="stopword" role="alert">${this.stopWord}</p>`;
  }

  private signIn() {
    const w = t().console;
    return html`<main class="door"><form class="plate" @submit=${(e: Event) => this.signInNow(e)}><h1>${w.signIn}</h1><p class="muted">${w.signInDetail}</p>
      <input class="sr" type="text" name="username" value="staff" autocomplete="username" tabindex="-1" aria-hidden="true" readonly>
      <div class="field"><label for="password">${w.password}</label><input id="password" type="password" name="password" required autocomplete="current-password"></div>
      <p class="trouble small" role="alert">${this.badPassword}</p><button class="btn main">${w.signIn}</button></form></main>`;
  }
  private async signInNow(e: Event): Promise<void> {
    e.preventDefault();
    const input = this.querySelector<HTMLInputElement>("#password")!;
    try {
      store.set({ session: await api.signIn(input.value) });
      location.reload(); // the line has to be opened anew as staff
    } catch (error) {
      const status = (error as { problem?: { status?: number } }).problem?.status;
      this.badPassword = status === 401 ? t().console.wrongPassword : problemWords(error);
    }
  }

  private nowPart() {
    const s = store.state, w = t();
    const lost = s.link.state === "lost";
    return html`<section class="plate nowbox"><h1>${s.status ? say(s.status.sentence) : w.opening}</h1><p>${s.status ? say(s.status.detail) : ""}</p>
      ${lost ? html`<p class="trouble" role="status">${w.lineDown} <button class="btn" @click=${() => connection.retryNow()}>${w.tryNow}</button></p>` : nothing}
      <p class="trouble" role="alert">${this.trouble}</p></section>`;
  }

  private healthPart() {
    const s = store.state, w = t(), c = w.console, health = s.health;
    if (!health) return html`<section class="plate"><header><h2>${c.health}</h2></header><div class="sk"></div><div class="sk"></div></section>`;
    const where = health.localization;
    const silent = health.devices.filter((d) => deviceTrouble(d)).length;
    const sigma = where.sigmaPosition === null ? "" : c.within(`${decimal(where.sigmaPosition * 100, 0, lang())} cm`, `${decimal(((where.sigmaTheta ?? 0) * 180) / Math.PI, 1, lang())}°`);
    return html`<section class="plate"><header><h2>${c.health}</h2><span class="small muted">${silent === 0 ? c.allHeard : c.someSilent(silent)}</span></header><ul class="health">
      <li class=${where.localized ? "ok" : "warn"}><i></i><span>${c.knows}</span><span class="w">${where.localized ? sigma : c.notLocalized}</span></li>
      ${health.devices.map((d) => {
        const trouble = deviceTrouble(d);
        const figure = d.rateHz !== null && d.rateHz > 0 ? c.perSecond(decimal(d.rateHz, d.rateHz < 10 ? 1 : 0, lang())) : c.answering;
        return html`<li class=${trouble ? "warn" : "ok"}><i></i><span>${c.devices[d.device] ?? d.device}</span><span class="w">${trouble ? trouble : figure}</span></li>`;
      })}
      <li class="ok"><i></i><span>${c.viewers}</span><span class="w">${count(health.viewers, lang())}</span></li></ul></section>`;
  }

  private modePart() {
    const s = store.state, c = t().console;
    const speed = value(s.site)?.speed;
    const modes: Mode[] = ["open", "web_only", "staff"];
    return html`<section class="plate"><header><h2>${c.mode}</h2></header><div class="modes" role="radiogroup" aria-label=${c.mode}>
      ${modes.map((mode) => html`<label><input type="radio" name="mode" .checked=${s.status?.mode === mode} @change=${() => this.act(() => api.setMode(mode))}>${c.modes[mode]}
        <span class="w">${speed ? `${decimal(speed[mode], 2, lang())} m/s` : ""}</span></label>`)}</div>
      <p class="lim"><span>${c.speedNow}</span><b>${s.status ? `${decimal(s.status.speedLimit, 2, lang())} m/s` : ""}</b></p></section>`;
  }

  private figures() {
    const s = store.state.statistics, c = t().console;
    if (!s) return nothing;
    return html`<section class="plate"><header><h2>${c.today}</h2></header><dl class="mini"><div><dt>${c.driven}</dt><dd>${metres(s.distanceM, lang())}</dd></div>
      <div><dt>${c.asked}</dt><dd>${count(s.requests, lang())}</dd></div>
      <div><dt>${c.fulfilled}</dt><dd>${s.successRate === null ? count(s.fulfilled, lang()) : `${decimal(s.successRate * 100, s.successRate === 1 ? 0 : 1, lang())} %`}</dd></div></dl></section>`;
  }

  private planPart() {
    const w = t(), c = w.console;
    return html`<section class="plate mapplate" aria-label=${w.plan}>
      <div class="layers">${shownLayers.map((name) => html`<button class="chip" aria-pressed=${this.layers[name]} @click=${() => (this.layers = { ...this.layers, [name]: !this.layers[name] })}>${c.layers[name]}</button>`)}
        <span class="zoom"><button class="sq" aria-label=${w.closer} @click=${() => this.plan()?.zoom(1.5)}>${icon("plus")}</button><button class="sq" aria-label=${w.farther} @click=${() => this.plan()?.zoom(1 / 1.5)}>${icon("minus")}</button>
        <button class="sq" aria-pressed=${this.follow} aria-label=${w.follow} @click=${() => this.plan()?.setFollow(!this.follow)}>${icon("follow")}</button></span>
        <button class="btn" aria-pressed=${this.placeMode} @click=${() => this.togglePlace()}>${icon("edit")}${c.setPose}</button></div>
      ${this.placeMode ? html`<div class="placebar"><p>${c.setPoseHint}</p>
        <button class="sq" aria-label=${c.turnLeft} ?disabled=${!this.placing} @click=${() => this.turn(Math.PI / 12)}>${icon("undo")}</button><button class="sq" aria-label=${c.turnRight} ?disabled=${!this.placing} @click=${() => this.turn(-Math.PI / 12)}>${icon("redo")}</button>
        <button class="btn main" ?disabled=${!this.placing} @click=${() => this.place()}>${c.setPoseHere}</button><button class="btn" @click=${() => this.lookEverywhere()}>${icon("look")}${c.lookEverywhere}</button>
        <button class="btn quiet" @click=${() => this.togglePlace()}>${w.cancel}</button></div>` : nothing}
      ${store.state.map.state === "failed" ? html`<p class="trouble mapfail" role="alert">${w.planFailed} ${w.code(store.state.map.problem.code)}</p>` : nothing}
      <docent-plan class="map" ?data-place=${this.placeMode} .layers=${this.layers} .follow=${this.follow} .placeMode=${this.placeMode} .placing=${this.placing} .active=${false}
        @pose-placed=${(e: CustomEvent) => (this.placing = e.detail.pose)} @follow-changed=${(e: CustomEvent) => (this.follow = e.detail.on)}></docent-plan></section>`;
  }
  private plan(): DocentPlan | null {
    return this.querySelector<DocentPlan>("docent-plan");
  }
  private togglePlace(): void {
    this.placeMode = !this.placeMode;
    this.placing = null;
  }
  private turn(by: number): void {
    if (this.placing) this.placing = { ...this.placing, theta: this.placing.theta + by };
  }
  private place(): void {
    const pose = this.placing;
    if (!pose) return;
    this.togglePlace();
    void this.act(() => api.setPose(pose));
  }
  private lookEverywhere(): void {
    this.togglePlace();
    void this.act(api.lookEverywhere);
  }

  private eventsPart() {
    const s = store.state, c = t().console;
    // Server times run from its start; the newest pose or status tells when that was.
    const epochMs = s.pose ? s.poseAt - s.pose.time * 1000 : s.status ? s.statusAt - s.status.time * 1000 : null;
    return html`<section class="plate log"><header><h2>${c.happened}</h2></header>${s.notes.length === 0 ? html`<p class="muted">${c.nothingYet}</p>` : nothing}
      <ol tabindex="0" aria-label=${c.happened}>${s.notes.slice(0, 60).map((n) => html`<li class=${n.severity === "incident" ? "e" : n.severity === "warning" ? "w" : ""}><time>${epochMs === null ? "" : clock(epochMs + n.time * 1000, lang())}</time>
        <span>${n.text}</span></li>`)}</ol></section>`;
  }
}
customElements.define("docent-console", DocentConsole);

// In words what is wrong with a device, or nothing.
function deviceTrouble(d: Device): string {
  if (!d.connected) return d.reason || t().noLine;
  return d.ageSeconds !== null && d.ageSeconds > staleAfter ? t().console.silentFor(`${Math.round(d.ageSeconds)} s`) : "";
}

start(["path", "people", "scan", "belief", "velocity_space", "health", "note"]);
