// The robot's touch-screen, 1080 x 1920: the stage above is for looking, the desk below for hands. It shows what the robot does;
// a touch lets people choose a tour or one exhibit, hear more, or move on.
import { LitElement, html, nothing, svg, type TemplateResult } from "lit";
import { api } from "../api";
import { problemWords, say, start, store, t, Ticking, Watch } from "../app";
import { about, countdown, metres } from "../i18n";
import { exhibitById, saying, secondsLeft, value, waiting } from "../store";
import { pictureUrl } from "../parts/exhibit_card";
import { icon, mark } from "../parts/icons";
import { languageSwitch } from "../parts/top";
import type { Exhibit, Tour } from "../wire/types";
import { gaveUp, goodbyeAfter, idleAfter, screenOf, type Moment, type Screen, type Wanted } from "./kiosk_flow";
import "../parts/face";
import "../parts/plan";

const perPage = 6;
const layers = { people: true, fan: false, beams: false, belief: false, path: true, hazards: true };

class DocentKiosk extends LitElement {
  static override properties = { wanted: { state: true }, page: { state: true }, trouble: { state: true }, busy: { state: true }, larger: { state: true } };
  declare wanted: Wanted;
  declare page: number;
  declare trouble: string;
  declare busy: boolean;
  declare larger: boolean;
  private touchedAt = Date.now();
  private lostAt: number | null = null;
  private waitingAt: number | null = null;
  private farthest = 0; // m, the way when it began
  private goal: string | null = null;
  private shown: Screen = "attract";

  constructor() {
    super();
    this.wanted = "nothing";
    this.page = 0;
    this.trouble = "";
    this.busy = this.larger = false;
    new Watch(this, (s) => [s.prefs.lang, s.link.state, s.status, s.speech, s.exhibits, s.tours, s.queue]);
    new Ticking(this, 250, () => true);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override connectedCallback(): void {
    super.connectedCallback();
    addEventListener("pointerdown", () => (this.touchedAt = Date.now()), { capture: true });
    addEventListener("keydown", (e) => this.pushButton(e));
  }
  // The four push buttons below the screen send the keys 1 to 4.
  private pushButton(e: KeyboardEvent): void {
    this.touchedAt = Date.now();
    this.querySelector<HTMLButtonElement>(`button[data-key="${e.key}"]`)?.click();
  }

  private moment(): Moment {
    const s = store.state, now = Date.now();
    this.lostAt = s.link.state === "live" ? null : (this.lostAt ?? now);
    const blocked = s.status?.activity === "waiting" && s.status.why === "people_in_the_way";
    this.waitingAt = blocked ? (this.waitingAt ?? now) : null;
    return { now, touchedAt: this.touchedAt, lostAt: this.lostAt, waitingAt: this.waitingAt };
  }

  override render() {
    const m = this.moment();
    if (gaveUp(this.wanted, m)) this.wanted = "nothing";
    const screen = screenOf(store.state, this.wanted, m);
    if (screen !== this.shown) {
      this.shown = screen;
      this.trouble = "";
    }
    const screens: Record<Screen, () => TemplateResult> = {
      attract: () => this.attract(), choose: () => this.choose(), pick: () => this.pick(), idle: () => this.idle(m), way: () => this.way(),
      exhibit: () => this.exhibit(), makeway: () => this.makeWay(), halt: () => this.halt(), offline: () => this.offline(),
    };
    const dark = ["attract", "idle", "makeway", "halt", "offline"].includes(screen);
    return html`<main class=${`screen ${screen} ${dark ? "dark" : ""}`} data-screen=${screen} ?data-larger=${this.larger}>${screens[screen]()}${this.bar()}</main>`;
  }

  private bar() {
    return html`<footer class="bar-b"><span class="brand">${mark}Docent</span>
      <button class="k icon" aria-pressed=${this.larger} aria-label=${t().kiosk.larger} @click=${() => (this.larger = !this.larger)}><span class="a1">A</span><span class="a2">A</span></button>
      ${languageSwitch(true)}</footer>`;
  }
  private desk(content: unknown) {
    return html`<div class="desk">${content}<p class="trouble" role="alert">${this.trouble}</p></div>`;
  }
  private async act(run: () => Promise<unknown>, then: Wanted = "nothing"): Promise<void> {
    this.busy = true;
    this.trouble = "";
    try {
      await run();
      this.wanted = then;
    } catch (error) {
      this.trouble = problemWords(error);
    }
    this.busy = false;
  }

  // ---- Nobody is being shown anything ------------------------------------------------------------------------------------

  private attract() {
    const w = t().kiosk;
    const tour = value(store.state.tours)?.[0];
    return html`<div class="stage"><div class="facebox"><docent-face fixed="happy"></docent-face></div><h1 class="say">${w.show}</h1>
      ${tour ? html`<p class="sub">${w.tours(w.exhibits(tour.exhibits.length), w.minutes(Math.max(1, Math.round(tour.minutes))))}</p>` : nothing}</div>
      <div class="go"><button class="k light huge" data-key="1" @click=${() => this.openChoose()}>${w.touch}</button></div>`;
  }

  private choose() {
    const w = t().kiosk;
    const all = value(store.state.tours) ?? [];
    const from = (this.page % Math.max(1, Math.ceil(all.length / 4))) * 4;
    return html`<div class="stage"><div class="lookup"><docent-face fixed="happy"></docent-face></div><h1 class="say">${w.whereTo}</h1></div>
      ${this.desk(html`<div class="four">${all.slice(from, from + 4).map((tour, i) => this.tourChoice(tour, i))}</div>
        <div class="row-k"><button class="k" @click=${() => (this.wanted = "nothing")}>${w.back}</button>
          ${all.length > 4 ? html`<button class="k" @click=${() => this.page++}>${w.moreTours}</button>` : nothing}
          <button class="k wide" data-one @click=${() => this.openPick()}>${icon("plan")}${w.one}</button></div>`)}`;
  }
  private tourChoice(tour: Tour, index: number) {
    const w = t().kiosk;
    return html`<button class="choice" data-key=${index + 1} data-tour=${tour.id} ?disabled=${this.busy} @click=${() => this.act(() => api.startTour(tour.id, ""))}>
      <span class="n">${index + 1}</span>${tourPicture(tour.exhibits.map((id) => exhibitById(store.state, id)?.number ?? 0), index)}
      <span class="t"><b>${say(tour.title)}</b><span class="s">${w.minutesShort(Math.max(1, Math.round(tour.minutes)))}, ${w.exhibitsShort(tour.exhibits.length)}</span></span></button>`;
  }
  private openChoose(): void {
    this.page = 0;
    this.wanted = "choose";
  }
  private openPick(): void {
    this.page = 0;
    this.wanted = "pick";
  }

  private pick() {
    const w = t().kiosk;
    const all = value(store.state.exhibits) ?? [];
    const pages = Math.max(1, Math.ceil(all.length / perPage));
    const shown = all.slice((this.page % pages) * perPage, (this.page % pages) * perPage + perPage);
    return html`<div class="stage"><h1 class="say mid">${w.which}</h1><div class="mapbox">${this.plan(false)}</div></div>
      ${this.desk(html`<div class="six">${shown.map((e) => html`<button class="one" data-exhibit=${e.id} ?disabled=${this.busy} @click=${() => this.act(() => api.sendTo(e.id, ""))}>
          <span class="no">${e.number}</span><span>${say(e.title)}</span></button>`)}</div>
        <div class="two"><button class="k" @click=${() => this.openChoose()}>${w.back}</button>
        ${pages > 1 ? html`<button class="k" @click=${() => this.page++}>${w.moreExhibits}<span class="pageno">${(this.page % pages) + 1}/${pages}</span></button>` : html`<span></span>`}</div>`)}`;
  }

  private idle(m: Moment) {
    const w = t().kiosk;
    const left = Math.max(1, Math.ceil((m.touchedAt + idleAfter + goodbyeAfter - m.now) / 1000));
    return html`<div class="stage"><docent-face fixed="sad"></docent-face><h1 class="say">${w.still}</h1><p class="sub">${w.stillDetail(left)}</p></div>
      <div class="go"><button class="k light huge" data-key="1" @click=${() => this.requestUpdate()}>${w.yes}</button></div>`;
  }

  // ---- It is on its way ----------------------------------------------------------------------------------------------------

  private plan(follow: boolean) {
    return html`<docent-plan class="map" .unit=${1.9} .span=${13} .follow=${follow} .layers=${layers} .active=${false}></docent-plan>`;
  }

  private way() {
    const s = store.state, w = t().kiosk, status = s.status!;
    const exhibit = exhibitById(s, status.exhibit);
    const toGo = status.distanceToGo ?? 0;
    if (this.goal !== (status.exhibit ?? "")) {
      this.goal = status.exhibit ?? "";
      this.farthest = toGo;
    }
    this.farthest = Math.max(this.farthest, toGo);
    const done = this.farthest > 0 ? Math.round(100 * (1 - toGo / this.farthest)) : 0;
    const speech = saying(s, Date.now());
    const heard = speech ? say(speech.text) : "";
    const seconds = secondsLeft(s, Date.now());
    return html`<div class="stage"><div class="row"><docent-face></docent-face><div><h1 class="say mid">${say(status.sentence)}</h1>
        ${status.tour ? html`<p class="sub">${w.stopOf(status.tour.stop, status.tour.stops)}</p>` : nothing}</div></div><div class="mapbox">${this.plan(true)}</div></div>
      ${this.desk(html`<p class="heard" ?data-empty=${!heard}>${heard ? (s.prefs.lang === "de" ? `„${heard}“` : `“${heard}”`) : exhibit ? say(exhibit.summary) : say(status.detail)}</p>
        <div class="far"><b>${metres(toGo, s.prefs.lang)}</b><span class="bar" role="img" aria-label=${`${done} %`}><i .style=${`width: ${done}%`}></i></span><span>${seconds ? about(seconds, s.prefs.lang) : ""}</span></div>
        <div class="two"><button class="k" @click=${() => this.act(() => this.endAll())} ?disabled=${this.busy}>${icon("close")}${status.tour ? w.end : w.stopGoing}</button>
        <button class="k" @click=${() => this.openChoose()}>${icon("plan")}${w.elsewhere}</button></div>`)}`;
  }

  // Ends the tour, or takes back the wish it is driving for.
  private async endAll(): Promise<void> {
    const active = waiting(store.state.queue).find((r) => r.state === "active");
    if (store.state.status?.tour) await api.endTour();
    else if (active) await api.leave(active.id);
  }

  private makeWay() {
    const w = t().kiosk, waited = (Date.now() - (this.waitingAt ?? Date.now())) / 1000;
    const mood = waited > 16 && waited < 22 ? "angry" : waited > 9 ? "sad" : "neutral";
    return html`<div class="stage" data-mood=${mood}><div class="mood"><docent-face .fixed=${mood}></docent-face></div><h1 class="say">${w.letMeThrough}</h1><p class="sub">${w.twoSteps}</p></div>
      <div class="foot"><div class="two"><button class="k" @click=${() => this.openChoose()}>${w.elsewhere}</button>
        <button class="k" ?disabled=${this.busy} @click=${() => this.act(() => this.endAll())}>${store.state.status?.tour ? w.end : w.stopGoing}</button></div><p class="trouble" role="alert">${this.trouble}</p></div>`;
  }

  // ---- It is there ---------------------------------------------------------------------------------------------------------

  private exhibit() {
    const s = store.state, status = s.status!;
    const e = exhibitById(s, status.exhibit);
    if (!e) return this.way();
    const { speech } = s;
    const mine = speech?.cue === "narration" && speech.exhibit === e.id;
    const narration = e.narrations[mine ? Math.min(speech.narration, e.narrations.length - 1) : 0];
    const text = mine ? say(speech.text) : narration ? say(narration.text) : say(e.summary);
    const picture = narration?.picture || e.picture || e.narrations.find((n) => n.picture)?.picture;
    return html`<div class="pic">${picture ? html`<img src=${pictureUrl(picture)} alt=${t().pictureOf(say(e.title))}>` : html`<div class="mapbox">${this.plan(true)}</div>`}<docent-face></docent-face></div>
      ${this.desk(html`<h1><span class="no">${e.number}</span>${say(e.title)}</h1><p class="yr">${say(e.summary)}</p><p class="tale">${text}</p>${this.answers(e)}`)}`;
  }

  private answers(e: Exhibit) {
    const s = store.state, w = t();
    const asking = s.status!.activity === "asking";
    const left = secondsLeft(s, Date.now()) ?? 0;
    const { speech } = s;
    const told = speech?.cue === "narration" && speech.exhibit === e.id ? speech.narration + 1 : 1;
    const more = told < e.narrations.length;
    const share = asking ? Math.min(1, left / 8) : 1;
    return html`<div class="two">
      ${more ? html`<button class="k main" data-key="1" ?disabled=${this.busy} @click=${() => this.act(() => api.answer("more"))}>${w.more}</button>`
        : html`<p class="k quiet">${left > 0 ? w.stayHere(countdown(left)) : ""}</p>`}
      <button class=${more ? "k" : "k main"} data-key="2" ?disabled=${this.busy} @click=${() => this.act(() => api.answer("move_on"))}>
        ${asking ? svg`<svg class="ring" viewBox="0 0 40 40" aria-hidden="true"><circle class="t" cx="20" cy="20" r="16"/><circle class="v" cx="20" cy="20" r="16" stroke-dasharray="100.5"
          stroke-dashoffset=${100.5 * (1 - share)}/><text x="20" y="25.4" text-anchor="middle">${Math.ceil(left)}</text></svg>` : icon("go")}${w.moveOn}</button></div>`;
  }

  // ---- It cannot -----------------------------------------------------------------------------------------------------------

  private halt() {
    const { status } = store.state;
    return html`<div class="stage"><docent-face></docent-face><h1 class="say mid">${status ? say(status.sentence) : ""}</h1><p class="sub">${status ? say(status.detail) : ""}</p></div>`;
  }
  private offline() {
    const w = t().kiosk;
    return html`<div class="stage"><docent-face fixed="sad"></docent-face><h1 class="say">${w.lostThread}</h1><p class="sub">${w.lostThreadDetail}</p></div>`;
  }
}
customElements.define("docent-kiosk", DocentKiosk);

// A way with the numbers of the tour's exhibits; each tour swings another way.
function tourPicture(numbers: number[], index: number) {
  const n = Math.min(6, Math.max(2, numbers.length));
  const at = Array.from({ length: n }, (_, k) => {
    const up = (k + index) % 2 === 0 ? 1 : -1;
    return [24 + (k * 228) / (n - 1), 60 + up * (k === 0 || k === n - 1 ? 14 : 26)] as const;
  });
  const way = at.slice(1).map(([x, y], k) => `C${at[k]![0] + 228 / (n - 1) / 2} ${at[k]![1]} ${x - 228 / (n - 1) / 2} ${y} ${x} ${y}`).join("");
  return svg`<svg class="pic" viewBox="0 0 280 120" aria-hidden="true"><path class="rd" d=${`M${at[0]![0]} ${at[0]![1]}${way}`}/>${at.map(([x, y], k) => svg`<circle class="y" cx=${x} cy=${y} r="16"/><text x=${x} y=${y + 6} text-anchor="middle">${numbers[k] || ""}</text>`)}</svg>`;
}
start(["path", "people"]);
