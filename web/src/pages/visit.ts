// The page for visitors on the web: the sentence, the plan, the cameras and the waiting list.
import { LitElement, html, nothing } from "lit";
import { connection, loadMuseum, say, start, store, t, Ticking, Watch } from "../app";
import { atExhibit, value } from "../store";
import { icon, mark } from "../parts/icons";
import { languageSwitch, lineState, themeSwitch } from "../parts/top";
import type { DocentExhibitList } from "../parts/exhibit_list";
import type { DocentPlan } from "../parts/plan";
import type { PlaceVerdict } from "../parts/place_card";
import type { Point } from "../wire/types";
import "../parts/cameras";
import "../parts/exhibit_card";
import "../parts/exhibit_list";
import "../parts/place_card";
import "../parts/plan";
import "../parts/queue";
import "../parts/sentence";

type Card = { kind: "exhibit"; id: string; opened: "hand" | "arrival" } | { kind: "place"; at: Point; verdict: PlaceVerdict };

const phone = matchMedia("(max-width: 620px)");
const followBelow = 11; // px a metre: smaller than this the whole hall says too little

class DocentVisit extends LitElement {
  static override properties = { view: { state: true }, card: { state: true }, follow: { state: true } };
  declare view: "plan" | "list";
  declare card: Card | null;
  declare follow: boolean;
  private arrivedAt: string | null = null; // the exhibit whose card was opened on arrival
  private settled = false;

  constructor() {
    super();
    this.view = "plan";
    this.card = null;
    this.follow = false;
    new Watch(this, (s) => [s.prefs, s.link, s.viewers, s.site, s.map, s.exhibits.state, s.status?.activity, s.status?.exhibit, s.status === null]);
    new Ticking(this, 1000, () => store.state.link.state === "lost");
    phone.addEventListener("change", () => this.requestUpdate());
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  protected override willUpdate(): void {
    const s = store.state;
    const title = value(s.site)?.title;
    document.title = title ? `Docent · ${say(title)}` : "Docent";
    this.openOnArrival();
  }
  // The explanation opens when the robot arrives and closes when it leaves, unless somebody is reading something else.
  private openOnArrival(): void {
    const { status } = store.state;
    const here = atExhibit(status) ? status!.exhibit : null;
    if (here === this.arrivedAt) return;
    this.arrivedAt = here;
    const free = this.card === null || (this.card.kind === "exhibit" && (this.card.opened === "arrival" || this.card.id === here));
    if (!free) return;
    this.card = here ? { kind: "exhibit", id: here, opened: "arrival" } : null;
  }

  private plan(): DocentPlan | null {
    return this.querySelector<DocentPlan>("docent-plan");
  }
  // The card covers part of the plan; what it is about stays in sight beside it.
  private roomFor: Card | null = null;
  private makeRoom(): void {
    const plan = this.plan(), at = this.placeOf(this.card);
    if (this.roomFor === this.card || (this.card && (!at || !plan?.pageOf(at)))) return;
    this.roomFor = this.card;
    const card = this.querySelector<HTMLElement>("docent-exhibit-card, docent-place-card");
    const wide = plan && card && plan.clientWidth > card.offsetWidth * 1.5;
    plan?.makeRoom(wide ? at : null, card?.classList.contains("at-left") ? "left" : "right", (card?.offsetWidth ?? 0) + 12);
  }
  protected override updated(): void {
    this.makeRoom();
    const site = value(store.state.site);
    if (site && !this.settled) {
      this.settled = true;
      this.follow = phone.matches && innerWidth / (site.width * site.resolution) < followBelow;
    }
  }

  override render() {
    const s = store.state, w = t();
    const lost = s.link.state === "lost";
    return html`
      <a class="skip btn main" href="#queue">${w.skip}</a>
      <header class="top" data-line=${s.link.state}>
        <a class="brand" href="/">${mark}Docent${s.site.state === "ready" ? html`<span class="house">${say(s.site.value.title)}</span>` : nothing}</a>
        <nav><button class="link" @click=${() => this.querySelector("dialog")!.showModal()}>${w.howItWorks}</button></nav>
        <div class="end">${lineState(w.live, true)}${themeSwitch()}${languageSwitch()}</div>
      </header>
      <main data-line=${s.link.state}>
        <docent-sentence class="say"></docent-sentence>
        <section class="plan plate" id="plan" aria-label=${w.plan} data-view=${this.view}>${this.planPart(lost)}</section>
        <div class="side">
          <section class="watch plate" id="watch" aria-label=${w.cameras}><docent-cameras></docent-cameras></section>
          <section class="queue plate" id="queue" aria-label=${w.waitingList}>
            <docent-queue @choose-place=${() => this.choosePlace()} @choose-exhibit=${(e: CustomEvent) => this.openExhibit(e.detail.id)}></docent-queue>
          </section>
        </div>
      </main>
      <footer class="foot"><button class="link" @click=${() => this.querySelector("dialog")!.showModal()}>${w.howItWorks}</button></footer>
      <nav class="tabbar" aria-label=${w.partsOfPage}><a href="#plan">${icon("plan")}${w.anchors.plan}</a><a href="#watch">${icon("camera")}${w.anchors.watch}</a>
        <a href="#queue">${icon("clock")}${w.anchors.waiting}</a></nav>
      <dialog class="how plate" aria-labelledby="how-title"><h2 id="how-title">${w.howItWorks}</h2>${w.how.map((line) => html`<p>${line}</p>`)}
        <form method="dialog"><button class="btn main">${w.close}</button></form></dialog>`;
  }

  private planPart(lost: boolean) {
    const w = t(), s = store.state;
    const failed = s.map.state === "failed" ? s.map.problem : s.site.state === "failed" ? s.site.problem : null;
    return html`
      <div class="seg kind" role="group" aria-label=${`${w.plan}, ${w.list}`}>
        <button aria-pressed=${this.view === "plan"} @click=${() => (this.view = "plan")}>${icon("plan")}<span>${w.plan}</span></button>
        <button aria-pressed=${this.view === "list"} @click=${() => this.showList()}>${icon("list")}<span>${w.list}</span></button>
      </div>
      ${failed && this.view === "plan" ? html`<div class="fail"><div>${icon("warning")}<h2>${w.planFailed}</h2><p>${w.planFailedDetail}</p>
        <div class="acts"><button class="btn main" @click=${() => loadMuseum()}>${w.loadAgain}</button><button class="btn" @click=${() => this.showList()}>${icon("list")}${w.openList}</button></div>
        <p class="xs muted">${w.code(failed.code)}</p></div></div>` : nothing}
      <docent-plan class="win" ?hidden=${this.view !== "plan" || failed !== null} .follow=${this.follow} .span=${phone.matches ? 26 : 16} .active=${!lost}
        .marker=${this.card?.kind === "place" ? this.card.at : null}
        @exhibit-chosen=${(e: CustomEvent) => this.openExhibit(e.detail.id)} @floor-chosen=${(e: CustomEvent) => this.openPlace([e.detail.x, e.detail.y])}
        @follow-changed=${(e: CustomEvent) => (this.follow = e.detail.on)} @plan-ready=${() => this.requestUpdate()}></docent-plan>
      ${this.view === "plan" && !failed && s.map.state === "ready" ? html`
        <div class="tools"><button class="sq" aria-label=${w.closer} @click=${() => this.plan()?.zoom(1.5)}>${icon("plus")}</button>
          <button class="sq" aria-label=${w.farther} @click=${() => this.plan()?.zoom(1 / 1.5)}>${icon("minus")}</button>
          <button class="sq wide" aria-label=${w.whole} @click=${() => this.plan()?.whole()}>${icon("plan")}<span class="lbl">${w.whole}</span></button>
          <button class="sq wide" aria-pressed=${this.follow} aria-label=${w.follow} @click=${() => this.plan()?.setFollow(!this.follow)}>${icon("follow")}<span class="lbl">${w.follow}</span></button></div>
        <div class="legend" aria-hidden="true"><span><i class="lr"></i>${w.legend.robot}</span><span><i class="ln"></i>${w.legend.next}</span>
          <span><i class="lp"></i>${w.legend.people}</span><span><i class="lh"></i>${w.legend.hazard}</span></div>` : nothing}
      ${this.view === "list" ? html`<docent-exhibit-list></docent-exhibit-list>` : nothing}
      ${lost ? this.lineNote() : nothing}
      ${this.view === "plan" ? this.cardPart() : nothing}`;
  }

  private lineNote() {
    const w = t(), { retryAt } = store.state.link;
    const left = retryAt ? Math.max(0, Math.ceil((retryAt - Date.now()) / 1000)) : 0;
    return html`<div class="note plate" role="status">${icon("link-lost")}<div><p>${w.lineDown}</p><p class="small muted"><span aria-hidden="true">${w.tryingAgain(left)}</span> ${w.placeKept}</p></div>
      <button class="btn" @click=${() => connection.retryNow()}>${w.tryNow}</button></div>`;
  }

  private cardPart() {
    const { card } = this;
    if (!card) return nothing;
    const close = () => this.closeCard();
    const keys = (e: KeyboardEvent) => e.key === "Escape" && close();
    return card.kind === "exhibit"
      ? html`<docent-exhibit-card class=${this.sideOf(card)} .exhibit=${card.id} @close-card=${close} @keydown=${keys}></docent-exhibit-card>`
      : html`<docent-place-card class=${this.sideOf(card)} .place=${card.at} .verdict=${card.verdict} @close-card=${close} @keydown=${keys}></docent-place-card>`;
  }
  // The card opens on the side away from what it is about, so that it covers neither the robot nor the exhibit.
  private sideOf(card: Card): string {
    if (this.roomFor === card) return this.side;
    const plan = this.plan(), at = this.placeOf(card);
    const page = at && plan?.pageOf(at);
    const box = plan?.getBoundingClientRect();
    this.side = page && box && page[0] > box.left + box.width / 2 ? "at-left" : "at-right";
    return this.side;
  }
  private side = "at-right";
  private placeOf(card: Card | null): Point | null {
    if (!card) return null;
    if (card.kind === "place") return card.at;
    const exhibit = value(store.state.exhibits)?.find((e) => e.id === card.id);
    return exhibit ? [exhibit.x, exhibit.y] : null;
  }

  private openExhibit(id: string): void {
    this.card = { kind: "exhibit", id, opened: "hand" };
    this.view = "plan";
    void this.updateComplete.then(() => phone.matches || this.querySelector<HTMLElement>("docent-exhibit-card .shut")?.focus({ preventScroll: true }));
  }
  private openPlace(at: Point): void {
    const plan = this.plan()!;
    this.card = { kind: "place", at, verdict: plan.isHazard(at) ? "hazard" : plan.isOpenFloor(at) ? "free" : "wall" };
  }
  private closeCard(): void {
    this.card = null;
  }
  // From the waiting list: hands and eyes go on to the list of places. Not on a phone, where the keyboard would cover it.
  private async choosePlace(): Promise<void> {
    this.showList();
    await this.updateComplete;
    const list = this.querySelector<DocentExhibitList>("docent-exhibit-list");
    await list?.updateComplete;
    if (!phone.matches) list?.focusFirst();
  }
  private showList(): void {
    this.view = "list";
    this.card = null;
    if (phone.matches) this.querySelector("#plan")?.scrollIntoView({ behavior: "auto", block: "start" });
  }
}
customElements.define("docent-visit", DocentVisit);

start(["path", "people", "scan"]);
