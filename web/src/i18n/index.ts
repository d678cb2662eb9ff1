import type { Lang, Text } from "../wire/types";
import { de } from "./de";
import { en, type Words } from "./en";

export type { Words } from "./en";
export * from "./format";

const catalogues: Record<Lang, Words> = { en, de };
export function wordsOf(lang: Lang): Words {
  return catalogues[lang];
}

// A museum's text in the language wanted, or in English.
export function pick(text: Text, lang: Lang): string {
  return text[lang] || text.en;
}

export function isLang(value: unknown): value is Lang {
  return value === "en" || value === "de";
}
