// Pieces of every page's head: the state of the line, language, theme.
import { html, nothing } from "lit";
import { setPrefs, store, t } from "../app";
import type { Lang } from "../wire/types";
import { icon } from "./icons";

export function lineState(connectedWord: string, viewers: boolean) {
  const s = store.state, w = t();
  if (s.link.state === "lost") return html`<span class="live lost">${w.noLine}</span>`;
  if (s.link.state === "connecting") return html`<span class="live wait">${w.connecting}</span>`;
  const facts = [s.link.latency === null ? "" : w.milliseconds(s.link.latency), viewers && s.viewers ? w.watching(s.viewers) : ""].filter(Boolean);
  return html`<span class="live">${connectedWord}${facts.length > 0 ? html` <small>${facts.join(" · ")}</small>` : nothing}</span>`;
}

export function themeSwitch() {
  const dark = store.state.prefs.theme === "dark";
  return html`<button class="sq" aria-pressed=${dark} aria-label=${t().dark} @click=${() => setPrefs({ theme: dark ? "light" : "dark" })}>${icon("theme")}</button>`;
}

export function languageSwitch(long = false) {
  const w = t();
  const one = (lang: Lang, short: string, name: string) => html`<button lang=${lang} aria-pressed=${w.lang === lang} aria-label=${long ? name : `${short}: ${name}`}
    @click=${() => setPrefs({ lang })}>${long ? name : short}</button>`;
  return html`<div class=${long ? "lang" : "seg"} role="group" aria-label=${w.language}>${one("en", "EN", w.english)}${one("de", "DE", w.german)}</div>`;
}
