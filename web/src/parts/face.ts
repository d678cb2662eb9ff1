// <docent-face mood talks>: the robot's face. Its shapes live in face.css; the eyes look where the robot turns.
import { LitElement, svg } from "lit";
import { store, t, Ticking, Watch } from "../app";
import { moodOf, type Mood } from "../mood";
import { saying } from "../store";

const eye = svg`<g class="blink"><ellipse class="eye" cx="73" cy="100" rx="31" ry="38"/></g>`;
const lids = svg`<path class="lid up" d="M30 40L116 40L116 66L30 66Z"/><path class="lid lo" d="M30 160L116 160L116 148C98 148 48 148 30 148Z"/>`;
const pupil = (x: number) => svg`<g class="blink"><g class="gaze"><circle class="pupil" cx=${x} cy="102" r="16"/><circle class="glint" cx=${x + 6} cy="95" r="5"/></g></g>`;

export class DocentFace extends LitElement {
  static override properties = { fixed: { type: String } };
  declare fixed: Mood | ""; // a mood that does not follow the robot
  private waitingSince = 0;

  constructor() {
    super();
    this.fixed = "";
    new Watch(this, (s) => [s.status, s.speech, s.prefs.lang, s.link.state, Math.round((s.pose?.angular ?? 0) * 5)]);
    new Ticking(this, 1000, () => store.state.status?.activity === "waiting" || store.state.speech !== null);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  override render() {
    const s = store.state, now = Date.now();
    if (s.status?.activity !== "waiting") this.waitingSince = now;
    const live = s.link.state === "live";
    const mood = this.fixed || (live ? moodOf(s.status, s.speech, (now - this.waitingSince) / 1000) : "neutral");
    this.dataset.mood = mood;
    this.classList.toggle("talks", live && !this.fixed && saying(s, now) !== null);
    this.classList.toggle("alive", live);
    this.setAttribute("role", "img");
    this.setAttribute("aria-label", t().mood[mood]);
    // Seen from the front, the robot's left is on the right.
    this.style.setProperty("--gx", `${Math.max(-10, Math.min(10, Math.round((s.pose?.angular ?? 0) * 5) * 4))}px`);
    return svg`<svg viewBox="0 0 240 220" aria-hidden="true">${eye}<g transform="translate(240 0) scale(-1 1)">${eye}</g>${pupil(78)}${pupil(162)}
      ${lids}<g transform="translate(240 0) scale(-1 1)">${lids}</g><path class="brow bl" d="M44 46C60 40 86 39 104 44"/><path class="brow br"
      d="M196 46C180 40 154 39 136 44"/><path class="mouth" d="M92 172C108 176 132 176 148 172"/></svg>`;
  }
}
customElements.define("docent-face", DocentFace);
