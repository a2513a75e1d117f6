// A hoop as a drawing has it: diameter, ring and masses, in millimetres and grams. leapmap reduces it to the
// three ratios; the drawing itself stays in the address.

import { noteAddress } from "../state/address.js";
import { element, notice, stepsOf } from "../dom.js";
import { drawingPicture } from "./drawing_picture.js";
import {
  NEW_WEIGHT, RATIOS, RING, WEIGHT, drawingAt, drawingOf, drawingWord, isDrawn, usesDrawing, usualName,
  wrongIn,
} from "../state/drawn.js";
import { short } from "../state/units.js";

/** [hoop] as a spec has it. */
const specOf = ({ ring, weights }) => ["[hoop]", `diameter = "${short(1000 * ring.diameter, 12)} mm"`,
  `mass = "${short(1000 * ring.mass, 12)} g"`,
  ...(Number.isNaN(ring.inertia) ? [] : [`inertia = "${ring.inertia} kg m2"`]),
  ...weights.flatMap(({ name, mass, at, angle, inertia }) => ["[[hoop.weight]]", `name = "${name}"`,
    `mass = "${short(1000 * mass, 12)} g"`, `at = "${short(1000 * at, 12)} mm"`,
    `angle = "${short(angle * 180 / Math.PI, 12)} deg"`, `inertia = "${inertia} kg m2"`])].join("\n");

/** changed(body, drawing, before): the drawing is another than before, if there was one; body: what it comes
    to, with its radius. */
export function drawingPart(map, solver, changed) {
  const box = element("drawing-numbers"), now = { drawing: null };
  const paperHoop = () => ({ ring: { diameter: 0.082, mass: 0.0082, inertia: NaN },
    weights: [{ name: usualName(0), mass: 0.02, at: 0.041, angle: 0, inertia: 0 }] });

  /** Takes what is typed, and says what is wrong with it. */
  function take(drawing) {
    const wrong = wrongIn(drawing), body = wrong ? null : solver.reduce(drawing);
    const beyond = body && RATIOS.find((name) =>
      !(body[name] >= solver.ranges[name][0] && body[name] <= solver.ranges[name][1]));
    notice(wrong ?? (beyond ? `This hoop's ${beyond.replace("_", " ")} is ${short(body[beyond])}, which is ` +
      `not between ${solver.ranges[beyond].map((v) => short(v)).join(" and ")}.` : ""));
    if (wrong || beyond) return;
    picture(drawing, body);
    const before = now.drawing;
    now.drawing = structuredClone(drawing);  // typing goes on in the other
    tell(body);
    changed({ ...body, radius: drawing.ring.diameter / 2 }, now.drawing, before);
    noteAddress();
  }

  function tell(body) {
    const R = now.drawing.ring.diameter / 2;
    element("drawing-told").textContent = `${short(1000 * body.total_mass, 5)} g in all; centre of mass ` +
      `${short(1000 * body.eccentricity * R, 4)} mm from the axis; moment of inertia about the axis ` +
      `${short(body.inertia * body.total_mass * R * R, 4)} kg m²`;
    element("drawing-spec").textContent = specOf(now.drawing);
  }

  /** The inputs stay as they were typed. */
  function forget() {
    now.drawing = null;
    element("drawing-told").textContent = element("drawing-spec").textContent = "";
  }

  function input(part, [name, words, unit], label) {
    const made = document.createElement("input");
    Object.assign(made, { type: "number", step: "any",
      value: Number.isFinite(part[name]) ? Number((part[name] / unit).toPrecision(12)) : "" });
    made.setAttribute("aria-label", `${label}: ${words}`);
    made.dataset.drawn = `${label}.${name}`;
    stepsOf(made, () => Number(made.value) || 1);
    made.addEventListener("change", () => {
      part[name] = made.value === "" ? NaN : Number(made.value) * unit;
      take(now.typed);
    });
    return made;
  }

  const picture = drawingPicture((k, at, angle, isDone) => {
    Object.assign(now.typed.weights[k], { at, angle });
    show(now.typed);
    // The first drawing takes sliders away: not from under the hand.
    if (isDone || now.drawing) take(now.typed);
  });

  function show(given) {
    const drawing = now.typed = structuredClone(given);
    picture(drawing, wrongIn(drawing) ? null : solver.reduce(drawing));
    const row = (label, rows, part, ...more) => {
      const line = document.createElement("fieldset"), name = document.createElement("legend");
      name.textContent = label;
      line.append(name, ...rows.map((each) => {
        const words = document.createElement("label");
        words.append(each[1], input(part, each, label));
        return words;
      }), ...more);
      return line;
    };
    box.replaceChildren(row("ring", RING, drawing.ring), ...drawing.weights.map((weight, k) => {
      const remove = document.createElement("button");
      Object.assign(remove, { type: "button", textContent: "remove" });
      remove.setAttribute("aria-label", `remove mass ${k + 1}`);
      remove.addEventListener("click", () => { drawing.weights.splice(k, 1); show(drawing); take(drawing); });
      return row(weight.name.replace(/^mass(\d+)$/, "mass $1"), WEIGHT, weight, remove);
    }));
  }
  element("drawing-add").addEventListener("click", () => {
    const names = now.typed.weights.map(({ name }) => name);
    const free = [...names, ""].map((_, k) => usualName(k)).find((name) => !names.includes(name));
    now.typed.weights.push({ name: free, ...NEW_WEIGHT });
    show(now.typed);
    take(now.typed);
  });
  show(paperHoop());

  return {
    /** The drawing of the hoop shown; null: there is none. */
    drawn: () => now.drawing,
    /** The hoop shown is another: of the map's drawing with numbers of its own, or the drawing is none of it
        any more. isOfMap: it is one of the map's designs. */
    follow(design, isOfMap) {
      const ofMap = map.drawing && (Object.keys(design).some(isDrawn) || usesDrawing(map))
        ? drawingAt(map.drawing, design) : null;
      const fits = (drawing) => {
        const body = drawing && solver.reduce(drawing), near = (a, b) => Math.abs(a - b) <= 1e-9 * b;
        return drawing && RATIOS.every((name) => near(design[name], body[name]))
          && near(design.radius, drawing.ring.diameter / 2)
          && !(design.mass > 0 && !near(design.mass, body.total_mass));
      };
      const drawing = (isOfMap ? [ofMap, now.drawing] : [now.drawing, ofMap]).find(fits);
      if (!drawing) { forget(); return; }
      if (drawing === now.drawing) return;
      now.drawing = drawing;
      show(drawing);
      tell(solver.reduce(drawing));
    },
    write(words) {
      // That of a map's hoop follows from the map's own, by the hoop's place.
      const drawing = (map.live ? map.drawing : null) ?? now.drawing;
      if (drawing) words.set("drawing", drawingWord(drawing));
    },
    /** The hoop itself is told by other words. */
    read(words) {
      forget();
      now.drawing = drawingOf(words.get("drawing"));
      if (!now.drawing) show(paperHoop());
      if (words.has("drawing") && !now.drawing)
        notice("The address describes a drawing that is not possible.");
      if (now.drawing) { show(now.drawing); tell(solver.reduce(now.drawing)); }
    },
  };
}
