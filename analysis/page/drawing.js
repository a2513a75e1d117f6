// A hoop as a drawing has it: diameter, ring and masses, in millimetres and grams. leapmap reduces it to the
// three ratios; the drawing itself stays in the address.

const RING = [["diameter", "outer diameter [mm]", 1e-3], ["mass", "mass of the ring [g]", 1e-3],
  ["inertia", "its moment of inertia [kg m²]; empty: a thin ring", 1]];
const WEIGHT = [["mass", "mass [g]", 1e-3], ["at", "from the axis [mm]", 1e-3],
  ["angle", "angle [°]", Math.PI / 180], ["inertia", "own inertia [kg m²]", 1]];
const NEW_WEIGHT = { mass: 0.02, at: 0, angle: 0, inertia: 0 };

/** The usual name of a mass, by its place. */
const usualName = (k) => `mass${k + 1}`;

/** In words: "0.12:0.061:0.00019;0.085:0.047:0:0:slug;=drive_torque": the ring's numbers, then each mass's,
    in SI, and its name if that is not the usual one, then the parameters in the units of this hoop. */
const drawingWord = ({ ring, weights, held = [] }) => [
  ...[[RING, ring], ...weights.map((weight) => [WEIGHT, weight])]
    .map(([rows, part], k) => [...rows.map(([name]) => (Number.isFinite(part[name]) ? part[name] : "")),
      ...(k > 0 && part.name !== usualName(k - 1) ? [part.name] : [])].join(":")),
  ...(held.length > 0 ? [`=${held.join(",")}`] : [])].join(";");

/** And back; null if it is none. */
function drawingOf(word) {
  const words = (word ?? "").split(";"), isHeld = (part) => part.startsWith("="),
    held = words.filter(isHeld).flatMap((part) => part.slice(1).split(",")),
    [ring, ...weights] = words.filter((part) => !isHeld(part)).map((part) => part.split(":"));
  const numbers = (rows, texts) => Object.fromEntries(rows.map(([name], k) =>
    [name, texts[k] === "" ? NaN : Number(texts[k])]));
  const fits = ring?.length === RING.length && held.every((name) => Object.hasOwn(SAME_IN_SI, name))
    && weights.every(({ length }) => [WEIGHT.length, WEIGHT.length + 1].includes(length));
  const drawing = fits && { held, ring: numbers(RING, ring), weights: weights.map((texts, k) =>
    ({ name: texts[WEIGHT.length] ?? usualName(k), ...numbers(WEIGHT, texts) })) };
  return drawing && wrongIn(drawing) === null ? drawing : null;
}

/** What no hoop can have, in words; null: nothing. */
function wrongIn({ ring, weights }) {
  if (!(ring.diameter > 2e-9 && ring.diameter <= 200)) return "The diameter must be above 0, up to 200 m.";
  if (!(ring.mass > 1e-9 && ring.mass <= 1e6)) return "The mass of the ring must be above 0.";
  if (!(Number.isNaN(ring.inertia) || ring.inertia >= 0))
    return "The ring's moment of inertia must be empty, 0 or more.";
  for (const [k, { name, mass, at, angle, inertia }] of weights.entries()) {
    if (!/^[\p{L}\p{N}_-]+$/u.test(name) || weights.findIndex((other) => other.name === name) !== k)
      return `Mass ${k + 1} must have a name of its own, of letters and digits.`;
    if (!(mass >= 0)) return `Mass ${k + 1} must be 0 g or more.`;
    if (!(at >= 0 && at <= ring.diameter / 2))
      return `Mass ${k + 1} must be 0 to ${short(500 * ring.diameter)} mm from the axis, up to the radius.`;
    if (!(Math.abs(angle) <= 2 * Math.PI)) return `The angle of mass ${k + 1} must be -360° to 360°.`;
    if (!(inertia >= 0)) return `The own inertia of mass ${k + 1} must be 0 or more.`;
  }
  return null;
}

/** [hoop] as a spec has it. */
const specOf = ({ ring, weights }) => ["[hoop]", `diameter = "${short(1000 * ring.diameter, 12)} mm"`,
  `mass = "${short(1000 * ring.mass, 12)} g"`,
  ...(Number.isNaN(ring.inertia) ? [] : [`inertia = "${ring.inertia} kg m2"`]),
  ...weights.flatMap(({ name, mass, at, angle, inertia }) => ["[[hoop.weight]]", `name = "${name}"`,
    `mass = "${short(1000 * mass, 12)} g"`, `at = "${short(1000 * at, 12)} mm"`,
    `angle = "${short(angle * 180 / Math.PI, 12)} deg"`, `inertia = "${inertia} kg m2"`])].join("\n");

/** changed(body, drawing): the drawing is another; body: what it comes to, with its radius. */
function drawingPart(map, solver, changed) {
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
    now.drawing = drawing;
    tell(body);
    changed({ ...body, radius: drawing.ring.diameter / 2 }, drawing);
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

  function show(drawing) {
    now.typed = drawing;
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
        any more. */
    follow(design) {
      const ofMap = map.drawing && (Object.keys(design).some(isDrawn) || usesDrawing(map))
        ? drawingAt(map.drawing, design) : null;
      const fits = (drawing) => {
        const body = drawing && solver.reduce(drawing), near = (a, b) => Math.abs(a - b) <= 1e-9 * b;
        return drawing && RATIOS.every((name) => near(design[name], body[name]))
          && near(design.radius, drawing.ring.diameter / 2);
      };
      const drawing = [now.drawing, ofMap].find(fits);
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
