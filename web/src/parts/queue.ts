// <docent-queue>: who waits for what, in the order in which the robot goes there. Events: choose-place, choose-exhibit {id}.
import { LitElement, html, nothing } from "lit";
import { store, t, Watch } from "../app";
import { say } from "../app";
import { value, waiting, exhibitById } from "../store";
import type { Request } from "../wire/types";
import { icon } from "./icons";
import { isMine, placeName, takeBack, waitWords } from "./wishes";

const outcomeShown = 30; // s

export class DocentQueue extends LitElement {
  static override properties = { staff: { type: Boolean }, trouble: { state: true } };
  declare staff: boolean;
  declare trouble: string;
  private readonly ended = new Map<string, number>(); // own request to when it was seen to end
  private begun = false; // what had ended before the page was opened is no news

  constructor() {
    super();
    this.staff = false;
    this.trouble = "";
    new Watch(this, (s) => [s.queue, s.exhibits, s.prefs.lang, s.link.state, s.status?.exhibit]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  override render() {
    const s = store.state, w = t();
    const list = waiting(s.queue);
    const lost = s.link.state !== "live";
    const own = list.find(isMine);
    return html`
      <header><h2>${w.waitingList}</h2>${s.queue && list.length > 0 ? html`<span class="small muted">${w.requests(list.length)}</span>` : nothing}</header>
      ${this.outcome()}
      ${s.queue === null ? html`<div class="sk"></div><div class="sk"></div>`
        : list.length === 0 ? this.empty(lost)
        : html`<ol>${list.map((r, i) => this.row(r, i, list))}</ol>`}
      <p class="trouble small" role="alert">${this.trouble}</p>
      ${this.staff ? nothing : html`<div class="acts">
        <button class="btn main" ?disabled=${lost} @click=${() => this.emit("choose-place")}>${w.choosePlace}</button>
        ${own ? html`<button class="btn" ?disabled=${lost} @click=${() => this.leave(own)}>${w.leave}</button>` : nothing}
      </div>`}`;
  }

  private row(r: Request, index: number, list: Request[]) {
    const w = t();
    const exhibit = exhibitById(store.state, r.exhibit);
    const mine = isMine(r), next = r.state === "active";
    const first = index === 0 || (index === 1 && list[0]!.state === "active");
    const name = mine ? w.thatIsYou(r.name) : r.name || w.visitor;
    return html`<li class=${mine ? "me" : ""}>
      <span class=${next ? "no next" : "no"}>${exhibit ? exhibit.number : icon("follow")}</span>
      <span class="nm"><b>${placeName(r)}</b><span class="muted small">${name}${this.staff ? ` (${w.console.by[r.channel] ?? r.channel})` : ""}</span></span>
      <span class="wt">${waitWords(r, first)}</span>
      ${this.staff ? html`<button class="sq" aria-label=${`${w.console.cancelRequest}: ${placeName(r)}`} @click=${() => this.leave(r)}>${icon("close")}</button>` : nothing}
    </li>`;
  }

  // Nobody waits: say so and offer one step.
  private empty(lost: boolean) {
    const w = t();
    const some = (value(store.state.exhibits) ?? []).filter((e) => e.id !== store.state.status?.exhibit).slice(0, 3);
    return html`<div class="emptyq"><p>${w.nobodyWaits}</p>
      ${this.staff ? nothing : html`<p class="muted">${w.nobodyWaitsDetail}</p>
      ${some.length > 0 ? html`<h3>${w.tryOneOf}</h3>
      <ul class="often">${some.map((e) => html`<li><button class="btn quiet" ?disabled=${lost} @click=${() => this.emit("choose-exhibit", { id: e.id })}><span class="no">${e.number}</span>
        <span>${say(e.title)}</span>${icon("go")}</button></li>`)}</ul>` : nothing}`}</div>`;
  }

  // How one's own last wish ended, for a while.
  private outcome() {
    const w = t(), now = Date.now() / 1000;
    for (const r of store.state.queue ?? []) {
      if (!isMine(r) || r.state === "pending" || r.state === "active" || this.ended.has(r.id)) continue;
      this.ended.set(r.id, this.begun ? now : -Infinity);
      setTimeout(() => this.requestUpdate(), outcomeShown * 1000);
    }
    this.begun ||= store.state.queue !== null;
    const last = (store.state.queue ?? []).filter((r) => isMine(r) && now - (this.ended.get(r.id) ?? -Infinity) < outcomeShown).at(-1);
    if (!last || last.state === "cancelled") return nothing;
    const place = last.exhibit ? placeName(last) : w.somewhere;
    return last.state === "failed"
      ? html`<p class="outcome bad" role="status">${icon("warning")}<span>${w.yoursFailed(place)} ${last.reason && w.lang === "en" ? last.reason : ""}</span></p>`
      : html`<p class="outcome" role="status">${icon("check")}<span>${w.yoursDone(place)}</span></p>`;
  }

  private async leave(r: Request): Promise<void> {
    this.trouble = await takeBack(r);
  }
  private emit(name: string, detail: unknown = null): void {
    this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true }));
  }
}
customElements.define("docent-queue", DocentQueue);
