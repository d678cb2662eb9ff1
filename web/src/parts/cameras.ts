// <docent-cameras>: the robot's eyes large and the wall camera in the corner, or the other way round; side="true": both beside each
// other. Each picture is decoded only when it is about to be shown, the newest of each camera.
import { LitElement, html, nothing } from "lit";
import { onFrame, say, store, t, Watch } from "../app";
import { clock } from "../i18n";
import { value } from "../store";
import type { Camera, Frame } from "../wire/types";

export class DocentCameras extends LitElement {
  static override properties = { side: { type: Boolean }, large: { state: true }, seen: { state: true } };
  declare side: boolean;
  declare large: string; // id of the camera shown large
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
    this.large = "";
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

  override render() {
    const s = store.state, w = t();
    const cameras = value(s.cameras) ?? [];
    if (s.cameras.state === "loading") return html`<div class="sk" aria-hidden="true"></div>`;
    if (cameras.length === 0) return html`<p class="none">${w.noCameras}</p>`;
    const indexOf = (c: Camera) => cameras.indexOf(c);
    const title = (c: Camera) => (c.kind === "onboard" ? w.eyes : say(c.title) || w.wall);
    const canvas = (c: Camera) => html`<canvas data-camera=${indexOf(c)} data-id=${c.id} width=${c.width} height=${c.height} role="img" aria-label=${title(c)}></canvas>`;
    this.dataset.lost = String(s.link.state === "lost");
    if (this.side) return cameras.map((c) => html`<figure>${canvas(c)}<figcaption class="tag">${c.kind === "onboard" ? w.console.onboard : title(c)}</figcaption></figure>`);
    const main = cameras.find((c) => c.id === this.large) ?? cameras.find((c) => c.kind === "onboard") ?? cameras[0]!;
    const others = cameras.filter((c) => c !== main);
    const lost = s.link.state === "lost" && this.shownAt > 0;
    return html`
      <div class="main">${canvas(main)}</div>
      <span class="tag">${lost ? w.lastPicture(clock(this.shownAt, s.prefs.lang)) : title(main)}</span>
      ${this.seen === 0 ? html`<span class="hint">${w.noPicture}</span>` : nothing}
      <div class="pips">${others.map((c) => html`<button class="pip" @click=${() => (this.large = c.id)} aria-label=${w.showLarge(title(c))}>${canvas(c)}
        <span class="tag" aria-hidden="true">${c.kind === "onboard" ? w.eyes : title(c)}</span></button>`)}</div>`;
  }
}
customElements.define("docent-cameras", DocentCameras);
