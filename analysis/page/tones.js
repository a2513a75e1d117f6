// The colours of everything that is drawn: the page's own (page.css), light or dark as the reader's system
// has it, or as chosen.

const TONES = ["ground", "ink", "frame", "scene", "earth", "mark", "data", "slide", "fly", "weight", "faint"];
const tones = {}, toneListeners = [];

function readTones() {
  const style = getComputedStyle(document.documentElement);
  for (const name of TONES) tones[name] = style.getPropertyValue(`--${name}`).trim();
}

/** Red, green and blue of #rrggbb. */
const rgbOf = (colour) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));

/** repaint(): whenever colours are others. */
const onTones = (repaint) => toneListeners.push(repaint);

function tonesPart() {
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
