// <docent-exhibit-list>: all that the plan shows, as a list: where the robot is, every exhibit, what it keeps away from. Everything
// that can be picked on the plan can be asked for here by keyboard.
import { LitElement, html, nothing } from "lit";
import { loadMuseum, say, store, t, Watch } from "../app";
import { atExhibit, value } from "../store";
import type { Exhibit } from "../wire/types";
import { pictureUrl } from "./exhibit_card";
import { icon } from "./icons";
import { longestName, myWishFor, rename, standing, wish } from "./wishes";

export class DocentExhibitList extends LitElement {
  static override properties = { busy: { state: true }, trouble: { state: true } };
  declare busy: string;
  declare trouble: { id: string; words: string };

  constructor() {
    super();
    this.busy = "";
    this.trouble = { id: "", words: "" };
    new Watch(this, (s) => [s.exhibits, s.prefs, s.queue, s.link.state, s.status?.exhibit, s.status?.activity, s.people.length, s.site]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  focusFirst(): void {
    this.querySelector<HTMLElement>("input")?.focus();
  }

  override render() {
    const s = store.state, w = t();
    if (s.exhibits.state === "failed") {
      return html`<p>${w.listFailed}</p><button class="btn main" @click=${() => loadMuseum(["exhibits"])}>${w.loadAgain}</button><p class="xs muted">${w.code(s.exhibits.problem.code)}</p>`;
    }
    const exhibits = value(s.exhibits);
    if (!exhibits) return html`<div class="sk"></div><div class="sk"></div><div class="sk"></div>`;
    const hazards = (value(s.site)?.hazards ?? []).map((h) => say(h.title)).filter(Boolean);
    return html`
      <div class="ask"><h2>${w.where}</h2>
        <div class="field"><label for="list-name">${w.yourName}</label><input id="list-name" .value=${s.prefs.name} maxlength=${longestName} autocomplete="given-name"
          aria-describedby="list-name-hint" @input=${rename}><span id="list-name-hint" class="hint">${w.yourNameHint}</span></div></div>
      <ul class="exhibits">${exhibits.map((e) => this.row(e))}</ul>
      <p class="small muted facts">${w.peopleSeen(s.people.length)} ${hazards.length > 0 ? `${w.keepOut} ${[...new Set(hazards)].join(", ")}.` : nothing}</p>`;
  }

  private row(e: Exhibit) {
    const s = store.state, w = t();
    const mine = myWishFor(e.id);
    const next = s.status?.exhibit === e.id;
    const state = next ? (atExhibit(s.status) ? w.robotHere : w.onMyWay) : "";
    return html`<li data-exhibit=${e.id} class=${mine ? "me" : ""}>
      ${e.picture ? html`<img src=${pictureUrl(e.picture)} alt="" loading="lazy" @error=${(x: Event) => ((x.target as HTMLElement).hidden = true)}>` : html`<span class="nopic"></span>`}
      <div class="nm"><h3><span class=${next ? "no next" : "no"}>${e.number}</span>${say(e.title)}</h3><p class="small muted">${say(e.summary)}</p>
        ${state ? html`<p class="small state">${state}</p>` : nothing}</div>
      ${mine ? html`<p class="granted small" role="status">${icon("check")}<span>${standing(mine)}</span></p>`
        : html`<button class="btn" aria-label=${w.sendThere(say(e.title))} ?disabled=${this.busy !== "" || s.link.state !== "live"} @click=${() => this.send(e)}>${w.sendMeThere}</button>`}
      ${this.trouble.id === e.id && this.trouble.words ? html`<p class="trouble small" role="alert">${this.trouble.words}</p>` : nothing}
    </li>`;
  }

  private async send(e: Exhibit): Promise<void> {
    this.busy = e.id;
    const sent = await wish({ exhibit: e.id });
    this.busy = "";
    this.trouble = { id: e.id, words: sent.ok ? "" : sent.words };
  }
}
customElements.define("docent-exhibit-list", DocentExhibitList);
