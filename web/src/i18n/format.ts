// Numbers, lengths and times in words people use.
import type { Lang } from "../wire/types";

const locales: Record<Lang, string> = { en: "en-GB", de: "de-DE" };

export function count(n: number, lang: Lang): string {
  return Math.round(n).toLocaleString(locales[lang]);
}
export function decimal(n: number, digits: number, lang: Lang): string {
  return n.toLocaleString(locales[lang], { minimumFractionDigits: digits, maximumFractionDigits: digits });
}

// "14 m", "2.1 km"
export function metres(m: number, lang: Lang): string {
  return m >= 1000 ? `${decimal(m / 1000, 2, lang)} km` : m >= 9.5 ? `${Math.round(m)} m` : `${decimal(m, 1, lang)} m`;
}

// "about 40 s", "4 min", "1 h 10 min"
export function about(seconds: number, lang: Lang): string {
  if (seconds < 5) return lang === "de" ? "gleich" : "in a moment";
  if (seconds < 90) return `${lang === "de" ? "etwa" : "about"} ${Math.max(5, Math.round(seconds / 5) * 5)} s`;
  return minutes(seconds);
}
function minutes(seconds: number): string {
  const m = Math.round(seconds / 60);
  return m < 60 ? `${m} min` : `${Math.floor(m / 60)} h ${m % 60 === 0 ? "" : `${m % 60} min`}`.trim();
}

// "1:40"
export function countdown(seconds: number): string {
  const s = Math.max(0, Math.ceil(seconds));
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, "0")}`;
}

// "12:04:06"
export function clock(ms: number, lang: Lang): string {
  return new Date(ms).toLocaleTimeString(locales[lang], { hour: "2-digit", minute: "2-digit", second: "2-digit" });
}

const words: Record<Lang, string[]> = {
  en: ["None", "One", "Two", "Three", "Four", "Five", "Six", "Seven", "Eight", "Nine", "Ten", "Eleven", "Twelve"],
  de: ["Kein", "Ein", "Zwei", "Drei", "Vier", "Fünf", "Sechs", "Sieben", "Acht", "Neun", "Zehn", "Elf", "Zwölf"],
};
export function inWords(n: number, lang: Lang): string {
  return words[lang][n] ?? String(n);
}
