// The page in five steps, for who comes first: each part in turn is outlined and said what it is for.

import { element } from "./dom.js";

/** A part of the page, what it is and what one does with it. */
const STEPS = [
  ["map-part", "The map", "Each point is a hoop. Colour is how high it jumps; lines are where its outcome " +
    "changes. Point to read a design, click to see it jump. Another quantity is a choice above."],
  ["hop-part", "One hoop", "The design clicked, solved in this page: play it, step through it, read its " +
    "numbers and copy the command that gives the same."],
  ["inputs-part", "Inputs", "Every number of hoop, ground, release and motor. The map follows while you " +
    "drag. A hoop from CAD goes into “This hoop from a drawing”, in grams and millimetres."],
  ["bar-brush", "Goals", "Drag along the colour bar: only designs in that stretch stay in full colour. " +
    "Goals of several quantities add up, and “show” finds the best design left."],
  ["tools", "Keep it", "The address holds all you see: a link is a finding. Undo goes back, pictures are " +
    "saved as PNG or SVG, and pinned designs are compared in a table."],
];

/** The button that begins it. */
export function tourPart() {
  const box = element("tour"), title = element("tour-title"), text = element("tour-text"),
    next = element("tour-next"), back = element("tour-back"), begin = element("tour-begin");
  let at = 0;
  function end() {
    box.hidden = true;
    document.querySelector(".toured")?.classList.remove("toured");
    document.body.classList.remove("inputs-open");
    begin.focus();
  }
  function show(step) {
    if (step < 0 || step >= STEPS.length) { end(); return; }
    at = step;
    const [id, name, words] = STEPS[at];
    document.querySelector(".toured")?.classList.remove("toured");
    const part = element(id);
    part.classList.add("toured");
    document.body.classList.toggle("inputs-open", id === "inputs-part");
    part.scrollIntoView({ block: "nearest" });
    title.textContent = `${at + 1} of ${STEPS.length}: ${name}`;
    text.textContent = words;
    back.disabled = at === 0;
    next.textContent = at + 1 === STEPS.length ? "Done" : "Next";
    box.hidden = false;
    next.focus();
  }
  begin.addEventListener("click", () => show(0));
  next.addEventListener("click", () => show(at + 1));
  back.addEventListener("click", () => show(at - 1));
  element("tour-end").addEventListener("click", end);
  box.addEventListener("keydown", (event) => { if (event.key === "Escape") end(); });
}
