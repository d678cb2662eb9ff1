// <docent-exhibit-card exhibit="id">: an exhibit's picture and words. Before the robot is there: "Send me there"; when it is: what it
// tells, how long it stays, and for whoever asked, "more" or "move on". Event: close-card.
import { LitElement, html, nothing } from "lit";
import { api } from "../api";
import { problemWords, say, store, t, Ticking, Watch } from "../app";
import { countdown } from "../i18n";
import { atExhibit, exhibitById, secondsLeft, waiting } from "../store";
import type { Exhibit } from "../wire/types";
import { icon } from "./icons";
import { isMine, longestName, myWishFor, rename, standing, wish } from "./wishes";

export function pictureUrl(file: string): string {
  return `/site/${file.split("/").map(encodeURIComponent).join("/")}`;
}

export class DocentExhibitCard extends LitElement {
  static override properties = { exhibit: { type: String }, trouble: { state: true }, busy: { state: true }, whole: { state: true } };
  declare exhibit: string;
  declare trouble: string;
  declare busy: boolean;
  declare whole: boolean; // all texts, not only the one being told

  constructor() {
    super();
    this.exhibit = "";
    this.trouble = "";
    this.busy = this.whole = false;
    new Watch(this, (s) => [s.exhibits, s.status, s.speech, s.queue, s.prefs, s.link.state]);
    new Ticking(this, 500, () => this.here());
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override willUpdate(changed: Map<string, unknown>): void {
    if (changed.has("exhibit") && changed.get("exhibit") !== undefined) {
      this.trouble = "";
      this.whole = false;
    }
  }
  private here(): boolean {
    const { status } = store.state;
    return atExhibit(status) && status!.exhibit === this.exhibit;
  }
  // Which of the exhibit's texts is being told.
  private telling(e: Exhibit): number {
    const { speech } = store.state;
    return speech?.cue === "narration" && speech.exhibit === e.id ? Math.min(speech.narration, Math.max(0, e.narrations.length - 1)) : 0;
  }

  override render() {
    const e = exhibitById(store.state, this.exhibit);
    if (!e) return nothing;
    const w = t(), here = this.here();
    const narration = here ? e.narrations[this.telling(e)] : undefined;
    const picture = narration?.picture || e.picture || e.narrations.find((n) => n.picture)?.picture;
    return html`<article class="card plate" aria-labelledby="card-title">
      ${picture ? html`<img src=${pictureUrl(picture)} alt=${w.pictureOf(say(e.title))} @error=${(x: Event) => ((x.target as HTMLElement).hidden = true)}>` : nothing}
      <button class="sq shut" aria-label=${w.close} @click=${() => this.dispatchEvent(new CustomEvent("close-card", { bubbles: true }))}>${icon("close")}</button>
      <div class="in">
        ${here ? this.stay() : nothing}
        <h2 id="card-title"><span class=${store.state.status?.exhibit === e.id ? "no next" : "no"}>${e.number}</span>${say(e.title)}</h2>
        ${here ? this.told(e) : html`<p class="body">${say(e.summary)}</p>`}
        ${here ? this.answers() : this.sending(e)}
        <p class="trouble small" role="alert">${this.trouble}</p>
      </div></article>`;
  }

  private stay() {
    const s = store.state, w = t(), left = secondsLeft(s, Date.now());
    if (s.status!.activity === "asking") return html`<p class="stay">${icon("clock")}${w.askNow}${left ? html` <b>${countdown(left)}</b>` : nothing}</p>`;
    return html`<p class="stay">${icon("clock")}${left ? w.stayHere(countdown(left)) : w.robotHere}</p>`;
  }

  private told(e: Exhibit) {
    const w = t(), at = this.telling(e);
    const { speech } = store.state;
    const live = speech?.cue === "narration" && speech.exhibit === e.id ? say(speech.text) : "";
    const now = live || (e.narrations[at] ? say(e.narrations[at]!.text) : say(e.summary));
    const others = e.narrations.filter((_, i) => i !== at);
    return html`<p class="body" data-told>${now}</p>
      ${this.whole ? others.map((n) => html`<p class="body more">${say(n.text)}</p>`) : nothing}
      ${others.length > 0 ? html`<button class="btn quiet read" aria-expanded=${this.whole} @click=${() => (this.whole = !this.whole)}>${icon("book")}${this.whole ? w.readLess : w.readMore}</button>` : nothing}`;
  }

  // Whoever asked for this visit may say how it goes on.
  private answers() {
    const s = store.state, w = t();
    const asked = waiting(s.queue).some((r) => r.state === "active" && r.exhibit === this.exhibit && isMine(r));
    if (!asked || s.link.state !== "live") return nothing;
    return html`<div class="acts"><button class="btn main" ?disabled=${this.busy} @click=${() => this.answer("more")}>${w.more}</button>
      <button class="btn" ?disabled=${this.busy} @click=${() => this.answer("move_on")}>${w.moveOn}</button></div>`;
  }

  private sending(e: Exhibit) {
    const s = store.state, w = t();
    const mine = myWishFor(e.id);
    if (mine) return html`<p class="granted" role="status">${icon("check")}<span>${w.onYourList}. ${standing(mine)}</span></p>`;
    return html`<form class="send" @submit=${(x: Event) => this.send(x, e)}>
      <div class="field"><label for="card-name">${w.yourName}</label><input id="card-name" .value=${s.prefs.name} maxlength=${longestName} autocomplete="given-name"
        @input=${rename}></div>
      <button class="btn main" ?disabled=${this.busy || s.link.state !== "live"}>${w.sendMeThere}${icon("go")}</button></form>`;
  }

  private async send(event: Event, e: Exhibit): Promise<void> {
    event.preventDefault();
    this.busy = true;
    const sent = await wish({ exhibit: e.id });
    this.busy = false;
    this.trouble = sent.ok ? "" : sent.words;
  }
  private async answer(answer: "more" | "move_on"): Promise<void> {
    this.busy = true;
    this.trouble = "";
    try {
      await api.answer(answer);
    } catch (error) {
      this.trouble = problemWords(error);
    }
    this.busy = false;
  }
}
customElements.define("docent-exhibit-card", DocentExhibitCard);
