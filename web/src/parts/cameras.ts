// <docent-cameras>: the robot's eyes large and a wall camera in the corner, or the other way round; side: one below the
// other. Each picture is decoded only when it is about to be shown, the newest of each camera.
import { LitElement, html, nothing } from "lit";
import { keyed } from "lit/directives/keyed.js";
import { onFrame, say, store, t, Watch, watchCameras } from "../app";
import { clock } from "../i18n";
import { value } from "../store";
import type { Camera, Frame } from "../wire/types";

export class DocentCameras extends LitElement {
  static override properties = { side: { type: Boolean }, large: { state: true }, small: { state: true }, seen: { state: true } };
  declare side: boolean;
  declare large: string; // id of the camera shown large
  declare small: string; // id of the one in the corner
  declare seen: number; // how many cameras have shown a picture
  private readonly newest = new Map<number, Frame>();
  private readonly busy = new Set<number>();
  private readonly shown = new Map<number, ImageBitmap>();
  private shownAt = 0;
  private stop: (() => void) | null = null;
  private scheduled = false;

  constructor() {
    super();
    this.side = false;
    this.large = this.small = "";
    this.seen = 0;
    new Watch(this, (s) => [s.cameras, s.prefs.lang, s.link.state]);
  }
  protected override createRenderRoot(): HTMLElement {
    return this;
  }
  override connectedCallback(): void {
    super.connectedCallback();
    this.stop = onFrame((frame) => {
      this.newest.set(frame.camera, frame);
      if (this.scheduled) return;
      this.scheduled = true;
      requestAnimationFrame(() => {
        this.scheduled = false;
        for (const camera of this.newest.keys()) void this.show(camera);
      });
    });
  }
  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stop?.();
  }

  private async show(camera: number): Promise<void> {
    const frame = this.newest.get(camera);
    if (!frame || this.busy.has(camera)) return;
    this.newest.delete(camera);
    this.busy.add(camera);
    try {
      const picture = await createImageBitmap(new Blob([frame.jpeg as Uint8Array<ArrayBuffer>], { type: "image/jpeg" }));
      this.shown.get(camera)?.close();
      this.shown.set(camera, picture);
      this.shownAt = Date.now();
      this.seen = this.shown.size;
      this.draw(camera);
    } catch {
      // a broken picture: the last one stays
    } finally {
      this.busy.delete(camera);
      if (this.newest.has(camera)) requestAnimationFrame(() => void this.show(camera));
    }
  }
  private draw(camera: number): void {
    const picture = this.shown.get(camera);
    const canvas = this.querySelector<HTMLCanvasElement>(`canvas[data-camera="${camera}"]`);
    if (!picture || !canvas) return;
    if (canvas.width !== picture.width || canvas.height !== picture.height) {
      canvas.width = picture.width;
      canvas.height = picture.height;
    }
    canvas.getContext("2d")?.drawImage(picture, 0, 0);
    canvas.classList.add("has-picture");
  }
  override updated(): void {
    for (const camera of this.shown.keys()) this.draw(camera);
  }

  // Two cameras are shown, so that a museum with many does not flood the line; the others wait by name.
  private chosen(): { main: Camera; inset: Camera | null; others: Camera[] } | null {
    const cameras = value(store.state.cameras) ?? [];
    const main = cameras.find((c) => c.id === this.large) ?? cameras.find((c) => c.kind === "onboard") ?? cameras[0];
    if (!main) return null;
    const rest = cameras.filter((c) => c !== main);
    const inset = rest.find((c) => c.id === this.small) ?? rest[0] ?? null;
    return { main, inset, others: rest.filter((c) => c !== inset) };
  }
  private swap(): void {
    const now = this.chosen();
    if (!now?.inset) return;
    this.large = now.inset.id;
    this.small = now.main.id;
  }

  override render() {
    const s = store.state, w = t();
    const cameras = value(s.cameras) ?? [];
    const now = this.chosen();
    if (s.cameras.state === "loading") return html`<div class="sk" aria-hidden="true"></div>`;
    if (!now) return html`<p class="none">${w.noCameras}</p>`;
    const { main, inset, others } = now;
    watchCameras(inset ? [main.id, inset.id] : [main.id]);
    const title = (c: Camera) => (c.kind === "onboard" ? (this.side ? w.console.onboard : w.eyes) : say(c.title) || w.wall);
    const canvas = (c: Camera) => html`<canvas data-camera=${cameras.indexOf(c)} data-id=${c.id} width=${c.width} height=${c.height} role="img" aria-label=${title(c)}></canvas>`;
    const others_ = others.length === 0 ? nothing : html`<div class="others" role="group" aria-label=${w.otherCameras}>${others.map((c) => html`<button class="tag" @click=${() => (this.small = c.id)}>${title(c)}</button>`)}</div>`;
    this.dataset.lost = String(s.link.state === "lost");
    if (this.side) {
      return html`<figure>${keyed(main.id, canvas(main))}<figcaption class="tag">${title(main)}</figcaption></figure>
        ${inset ? html`<figure>${keyed(inset.id, canvas(inset))}<figcaption class="tag">${title(inset)}</figcaption>${others_}</figure>` : nothing}`;
    }
    const lost = s.link.state === "lost" && this.shownAt > 0;
    return html`
      <div class="main">${keyed(main.id, canvas(main))}</div>
      <span class="tag">${lost ? w.lastPicture(clock(this.shownAt, s.prefs.lang)) : title(main)}</span>
      ${this.seen === 0 ? html`<span class="hint">${w.noPicture}</span>` : others_}
      ${inset ? html`<button class="pip" @click=${() => this.swap()} aria-label=${w.showLarge(title(inset))}>${keyed(inset.id, canvas(inset))}<span class="tag" aria-hidden="true">${title(inset)}</span></button>` : nothing}`;
  }
}
customElements.define("docent-cameras", DocentCameras);
