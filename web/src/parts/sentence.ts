// <docent-sentence>: what the robot does and why, in words; what it says; the page opens with it. A polite live region that changes
// at most once in five seconds.
import { LitElement, html, nothing } from "lit";
import { say, store, t, Ticking, Watch } from "../app";
import { clock } from "../i18n";
import { atExhibit, exhibitById, saying } from "../store";
import { icon } from "./icons";
import "./face";

const calm = 5000; // ms between two changes read aloud

export class DocentSentence extends LitElement {
  private aloud = "";
  private aloudAt = 0;

  constructor() {
    super();
    new Watch(this, (s) => [s.status, s.speech, s.prefs.lang, s.link.state, s.exhibits]);
    new Ticking(this, 1000, () => store.state.speech !== null || this.aloud !== this.words().sentence);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  private words(): { sentence: string; detail: string } {
    const s = store.state, w = t();
    if (s.link.state === "lost") {
      const heard = s.link.heardAt;
      if (!heard) return { sentence: w.neverHeard, detail: w.neverHeardDetail };
      const last = s.status ? `${w.lastSaid(say(s.status.sentence))} ` : "";
      return { sentence: w.lastHeard(clock(heard, s.prefs.lang)), detail: last + w.goesOn };
    }
    if (!s.status) return { sentence: w.opening, detail: w.openingDetail };
    return { sentence: say(s.status.sentence), detail: say(s.status.detail) };
  }

  override render() {
    const s = store.state, now = Date.now();
    const { sentence, detail } = this.words();
    if (this.aloud !== sentence && now - this.aloudAt > calm) {
      this.aloud = sentence;
      this.aloudAt = now;
    }
    const speech = s.link.state === "live" ? saying(s, now) : null;
    // At an exhibit the text stands on its card; only what is said beside it is shown here.
    const quoted = speech && !(speech.cue === "narration" && atExhibit(s.status)) ? say(speech.text) : "";
    return html`
      <docent-face></docent-face>
      <div class="what">
        <h1 class="voice">${sentence}</h1>
        <p class="why">${this.emphasised(detail)}</p>
        ${quoted ? html`<p class="said">${icon("captions")}<span class="sr">${t().said}: </span><q class="voice">${s.prefs.lang === "de" ? `„${quoted}“` : `“${quoted}”`}</q></p>` : nothing}
      </div>
      <p class="sr" aria-live="polite" data-aloud>${this.aloud}</p>`;
  }

  // The name of the exhibit it is about stands out.
  private emphasised(detail: string) {
    const exhibit = exhibitById(store.state, store.state.status?.exhibit ?? null);
    const title = exhibit ? say(exhibit.title) : "";
    const at = title ? detail.toLowerCase().indexOf(title.toLowerCase()) : -1;
    if (at < 0) return detail;
    return html`${detail.slice(0, at)}<b>${detail.slice(at, at + title.length)}</b>${detail.slice(at + title.length)}`;
  }
}
customElements.define("docent-sentence", DocentSentence);
