// The colours of everything that is drawn: the page's own (page.css), light or dark as the reader's system
// has it, or as chosen.

import { element } from "../dom.js";

const TONES = ["ground", "ink", "frame", "scene", "earth", "mark", "data", "slide", "fly", "weight", "faint"];
export const tones = {}, toneListeners = [];

function readTones() {
  const style = getComputedStyle(document.documentElement);
  for (const name of TONES) tones[name] = style.getPropertyValue(`--${name}`).trim();
}

/** Red, green and blue of #rrggbb. */
export const rgbOf = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** repaint(): whenever colours are others. */
export const onTones = (repaint) => toneListeners.push(repaint);

export function tonesPart() {
  const system = window.matchMedia("(prefers-color-scheme: dark)"), button = element("tone");
  const isDark = () =>
    (document.documentElement.dataset.tone ?? (system.matches ? "dark" : "light")) === "dark";
  const changed = () => {
    readTones();
    button.textContent = isDark() ? "light" : "dark";
    for (const repaint of toneListeners) repaint();
  };
  system.addEventListener("change", changed);
  button.addEventListener("click",
    () => { document.documentElement.dataset.tone = isDark() ? "light" : "dark"; changed(); });
  changed();
}

// told apart by most eyes, on light and on dark; one a pin
export const PIN_COLOURS = ["#0072b2", "#cc79a7", "#e69f00", "#009e73"];
export const PIN_INKS = ["#ffffff", "#000000", "#000000", "#000000"];
