// The line icons, 24 units square, drawn with the text's colour; class f is filled. Always beside words or with a name of its own.
import { svg, type SVGTemplateResult } from "lit";

const drawings = {
  stop: svg`<path class="f" d="M8.3 2.5h7.4l5.8 5.8v7.4l-5.8 5.8H8.3l-5.8-5.8V8.3z"/>`,
  go: svg`<path d="M4 12h14"/><path d="M12.5 5.5L19 12l-6.5 6.5"/>`,
  vote: svg`<path d="M4 11.5V20h16v-8.5"/><path d="M2.5 11.5h19"/><path d="M8 11.5l1.2-8h7.3l-1.2 8"/><path d="M10.6 7.4l1.3 1.3 2.4-2.7"/>`,
  camera: svg`<path d="M3 7.5h4l1.6-2.5h6.8L17 7.5h4V19H3z"/><circle cx="12" cy="13" r="3.4"/>`,
  "hand-over": svg`<path d="M3 8.5h12.5"/><path d="M12 5l3.5 3.5L12 12"/><path d="M21 15.5H8.5"/><path d="M12 12l-3.5 3.5L12 19"/>`,
  language: svg`<circle cx="12" cy="12" r="9"/><path d="M3 12h18"/><path d="M12 3c-5.2 5.6-5.2 12.4 0 18 5.2-5.6 5.2-12.4 0-18z"/>`,
  captions: svg`<path d="M3 5h18v12.5h-8.5L8 21v-3.5H3z"/><path d="M6.5 9.5h6M15 9.5h2.5M6.5 13.2h2.5M11.5 13.2h6"/>`,
  sound: svg`<path d="M3.5 9.5v5H7l5 4.5V5L7 9.5z"/><path d="M15.5 9a4.2 4.2 0 0 1 0 6"/><path d="M18.2 6.2a8.2 8.2 0 0 1 0 11.6"/>`,
  "sound-off": svg`<path d="M3.5 9.5v5H7l5 4.5V5L7 9.5z"/><path d="M15.8 9.5l5 5M20.8 9.5l-5 5"/>`,
  battery: svg`<path d="M2.5 7h16v10h-16z"/><path d="M21.5 10.5v3"/><path class="f" d="M5 9.5h8.5v5H5z"/>`,
  warning: svg`<path d="M12 3.2L22 20.5H2z"/><path d="M12 9.5v5.2"/><path d="M12 17.4v.3"/>`,
  edit: svg`<path d="M4 20l1-4.6L16.2 4.2l3.6 3.6L8.6 19z"/><path d="M13.6 6.8l3.6 3.6"/>`,
  undo: svg`<path d="M4 9h10.5a5.25 5.25 0 0 1 0 10.5H8"/><path d="M8 4.8L3.8 9 8 13.2"/>`,
  redo: svg`<path d="M20 9H9.5a5.25 5.25 0 0 0 0 10.5H16"/><path d="M16 4.8L20.2 9 16 13.2"/>`,
  list: svg`<path d="M9 6h12M9 12h12M9 18h12M4 6h.5M4 12h.5M4 18h.5"/>`,
  plan: svg`<path d="M3 4h18v16H3z"/><path d="M3 10h6V7M12 4v3M12 20v-6h5M21 14h-1.5"/>`,
  plus: svg`<path d="M12 5v14M5 12h14"/>`,
  minus: svg`<path d="M5 12h14"/>`,
  close: svg`<path d="M5.5 5.5l13 13M18.5 5.5l-13 13"/>`,
  check: svg`<path d="M4.5 12.5l5 5L19.5 6.5"/>`,
  follow: svg`<circle cx="12" cy="12" r="3.2"/><circle cx="12" cy="12" r="8"/><path d="M12 1.5V6M12 18v4.5M1.5 12H6M18 12h4.5"/>`,
  clock: svg`<circle cx="12" cy="12" r="9"/><path d="M12 6.5V12l3.8 2.4"/>`,
  person: svg`<circle cx="12" cy="7.5" r="4"/><path d="M4 21c.6-5 4-7 8-7s7.400 2 8 7"/>`,
  play: svg`<path class="f" d="M7 4.500l12.500 7.500L7 19.500z"/>`,
  pause: svg`<path d="M8 5v14M16 5v14"/>`,
  theme: svg`<circle cx="12" cy="12" r="9"/><path class="f" d="M12 3a9 9 0 0 1 0 18z"/>`,
  book: svg`<path d="M12 6.500C9.500 4.600 6.500 4.200 3 4.500V19c3.500-.3 6.500.1 9 2 2.500-1.900 5.500-2.300 9-2V4.500c-3.500-.3-6.500.1-9 2zM12 6.500V21"/>`,
  trash: svg`<path d="M4 6.500h16M9 6.500V4h6v2.500M6 6.500L7 21h10l1-14.500M10 10.500v6.500M14 10.500v6.500"/>`,
  "link-lost": svg`<path d="M2.500 9.500A14 14 0 0 1 8 6.400M12.500 5.600a14 14 0 0 1 9 3.900M6 13.300a9 9 0 0 1 4-2.300M15.500 11.600a9 9 0 0 1 2.500 1.700M12 18.700v.3"/><path d="M4 3l16 18"/>`,
  layers: svg`<path d="M12 3l9.500 5L12 13 2.500 8z"/><path d="M2.500 12.500L12 17.500l9.500-5M2.500 16.500L12 21.500l9.500-5"/>`,
  look: svg`<circle cx="12" cy="12" r="2.200"/><path d="M12 2.500v4M12 17.500v4M2.500 12h4M17.500 12h4M9.800 4.500L12 2.300l2.200 2.200M9.800 19.500L12 21.700l2.200-2.200M4.500 9.800L2.300 12l2.200 2.200M19.500 9.800l2.200 2.200-2.200 2.200"/>`,
  dock: svg`<path d="M13 2.500L5 13.500h6l-1 8 8.500-11.500h-6z"/>`,
};

export type IconName = keyof typeof drawings;

export function icon(name: IconName): SVGTemplateResult {
  return svg`<svg class="ic" viewBox="0 0 24 24" aria-hidden="true">${drawings[name]}</svg>`;
}

// The robot seen from above, on its way.
export const mark = svg`<svg class="mark" viewBox="-1.5 -1.5 3.6 3" aria-hidden="true"><path class="b" d="M1.85 0L.86 .93A1.27 1.27 0 1 1 .86 -.93Z"/><circle class="e" cx=".42" cy="-.46" r=".27"/><circle class="e" cx=".42" cy=".46" r=".27"/></svg>`;
