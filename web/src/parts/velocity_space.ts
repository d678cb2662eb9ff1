// <docent-velocity-space>: how the local planner judged speed against turning, darker is better, with what it chose.
import { LitElement, html, nothing } from "lit";
import { store, t, lang, Watch } from "../app";
import { decimal } from "../i18n";
import { readColours, withAlpha } from "../plan/colours";

export class DocentVelocitySpace extends LitElement {
  private readonly themes = new MutationObserver(() => this.requestUpdate());

  constructor() {
    super();
    new Watch(this, (s) => [s.velocitySpace, s.prefs.lang]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override connectedCallback(): void {
    super.connectedCallback();
    this.themes.observe(document.documentElement, { attributes: true, attributeFilter: ["data-theme"] });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.themes.disconnect();
  }

  override render() {
    const v = store.state.velocitySpace, w = t().console;
    if (!v || v.linear.length < 2 || v.angular.length < 2) return html`<p class="small muted">${w.noVelocity}</p>`;
    const top = v.linear.at(-1)!, low = v.linear[0]!, side = Math.max(Math.abs(v.angular[0]!), v.angular.at(-1)!);
    return html`
      <div class="plot"><span class="y">${decimal(top, 1, lang())} m/s</span><span class="y0">${decimal(low, 1, lang())}</span>
        <canvas role="img" aria-label=${`${w.velocity}: ${w.chosen} ${decimal(v.chosen.linear, 2, lang())} m/s, ${decimal(v.chosen.angular, 2, lang())} rad/s`}></canvas>
        <span class="x0">${w.left} ${decimal(side, 1, lang())} rad/s</span><span class="x1">${w.right}</span></div>
      <p class="key"><span><i class="kh"></i>${w.wouldHit}</span><span><i class="kb"></i>${w.better}</span><span><i class="kc"></i>${w.chosen}</span>${nothing}</p>`;
  }

  override updated(): void {
    const v = store.state.velocitySpace, canvas = this.querySelector("canvas");
    const c = canvas?.getContext("2d");
    if (!v || !canvas || !c) return;
    const dpr = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return;
    canvas.width = Math.round(width * dpr);
    canvas.height = Math.round(height * dpr);
    c.scale(dpr, dpr);
    const colours = readColours();
    const rows = v.linear.length, columns = v.angular.length;
    const scores = v.score.filter((s): s is number => s !== null);
    const best = Math.max(...scores), worst = Math.min(...scores);
    // Turning left is positive and drawn on the left.
    const x = (angular: number) => width * (1 - (angular - v.angular[0]!) / (v.angular.at(-1)! - v.angular[0]!));
    const y = (linear: number) => height * (1 - (linear - v.linear[0]!) / (v.linear.at(-1)! - v.linear[0]!));
    for (let i = 0; i < rows; i++) {
      for (let k = 0; k < columns; k++) {
        const score = v.score[i * columns + k] ?? null;
        c.fillStyle = score === null ? withAlpha(colours.hazard, 0.3) : withAlpha(colours.robot, 0.08 + 0.72 * (best > worst ? (score - worst) / (best - worst) : 0));
        const w = width / columns, h = height / rows;
        c.fillRect(width - (k + 1) * w, height - (i + 1) * h, w + 0.5, h + 0.5);
      }
    }
    c.strokeStyle = colours.ink2;
    c.lineWidth = 1;
    c.beginPath();
    c.moveTo(x(0), 0);
    c.lineTo(x(0), height);
    c.stroke();
    const px = Math.max(7, Math.min(width - 7, x(v.chosen.angular))), py = Math.max(7, Math.min(height - 7, y(v.chosen.linear)));
    c.fillStyle = colours.goal;
    c.strokeStyle = colours.ink;
    c.lineWidth = 1.5;
    c.beginPath();
    c.arc(px, py, 5.5, 0, 2 * Math.PI);
    c.fill();
    c.stroke();
  }
}
customElements.define("docent-velocity-space", DocentVelocitySpace);
