// <docent-place-card>: a place on the floor that was picked on the plan, and "Come here". Event: close-card.
import { LitElement, html, nothing } from "lit";
import { say, store, t, lang, Watch } from "../app";
import { metres } from "../i18n";
import { value } from "../store";
import { distance } from "../plan/view";
import type { Point } from "../wire/types";
import { icon } from "./icons";
import { longestName, rename, wish } from "./wishes";

export type PlaceVerdict = "free" | "wall" | "hazard";

export class DocentPlaceCard extends LitElement {
  static override properties = { place: { attribute: false }, verdict: { type: String }, trouble: { state: true }, busy: { state: true } };
  declare place: Point | null;
  declare verdict: PlaceVerdict;
  declare trouble: string;
  declare busy: boolean;

  constructor() {
    super();
    this.place = null;
    this.verdict = "free";
    this.trouble = "";
    this.busy = false;
    new Watch(this, (s) => [s.prefs, s.link.state, s.exhibits, s.status?.activity]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override willUpdate(changed: Map<string, unknown>): void {
    if (changed.has("place")) this.trouble = "";
  }

  override render() {
    const { place } = this, s = store.state, w = t();
    if (!place) return nothing;
    const robot = s.pose ?? s.status?.pose;
    const near = this.near(place);
    const far = robot ? w.fromMe(metres(distance(place, [robot.x, robot.y]), lang())) : "";
    return html`<article class="card place plate" aria-labelledby="place-title">
      <button class="sq shut" aria-label=${w.close} @click=${() => this.close()}>${icon("close")}</button>
      <div class="in"><h2 id="place-title">${near ? w.placeNear(near) : w.thisPlace}</h2><p class="muted">${far}</p>
      ${this.verdict !== "free" ? html`<p class="refused">${icon("warning")}${this.verdict === "wall" ? w.wallThere : w.hazardThere}</p>`
        : html`<form class="send" @submit=${(e: Event) => this.send(e, place)}>
          <div class="field"><label for="place-name">${w.yourName}</label><input id="place-name" .value=${s.prefs.name} maxlength=${longestName}
            autocomplete="given-name" @input=${rename}></div>
          <button class="btn main" ?disabled=${this.busy || s.link.state !== "live"}>${w.comeHere}${icon("go")}</button></form>`}
      <p class="trouble small" role="alert">${this.trouble}</p></div></article>`;
  }

  private near(place: Point): string {
    const places: { name: string; d: number }[] = [
      ...(value(store.state.exhibits) ?? []).map((e) => ({ name: say(e.title), d: distance(place, [e.x, e.y]) })),
      ...(value(store.state.site)?.areas ?? []).map((a) => ({ name: say(a.title), d: distance(place, [a.x, a.y]) })),
    ];
    const best = places.sort((a, b) => a.d - b.d)[0];
    return best && best.d < 8 ? best.name : "";
  }
  private close(): void {
    this.dispatchEvent(new CustomEvent("close-card", { bubbles: true }));
  }
  private async send(event: Event, [x, y]: Point): Promise<void> {
    event.preventDefault();
    this.busy = true;
    const sent = await wish({ x, y });
    this.busy = false;
    if (sent.ok) this.close();
    else this.trouble = sent.words;
  }
}
customElements.define("docent-place-card", DocentPlaceCard);
