// The hoop shown, number by number: each of its parameters to type, and what a small increase of each
// changes.

import { element, notice, stepsOf } from "../dom.js";
import { LIVE_RANGES, SLIPPING } from "../state/ranges.js";
import { perUnit, short, shownIn, withUnit } from "../state/units.js";

/** What is differentiated, with its name and the unit of the table.
    @type {[string, string, string][]} */
const DIFFERENTIATED = [["jump_height", "jump height", "diameters"], ["jump_time", "lift-off after", "s"]];

/** changed(design): the hoop typed. Returns show(design). */
export function hoopInputs(map, solver, changed) {
  const box = element("hoop-inputs"), now = { design: null }, inputs = new Map();
  const factor = (name) => perUnit(map.parameters[name].unit);
  const wanted = () => Object.keys(map.parameters)
    .filter((name) => name in solver.defaults && name !== "radius"
    && (map.slips || !SLIPPING.includes(name)));

  function build() {
    inputs.clear();
    box.replaceChildren(...wanted().map((name) => {
      const { label, unit } = map.parameters[name], row = document.createElement("label"),
        input = document.createElement("input"), words = document.createElement("span");
      words.textContent = withUnit(label, unit ? `[${unit}]` : "");
      Object.assign(input, { type: "number", step: "any" });
      input.dataset.parameter = name;
      input.addEventListener("change", () => {
        const [least, most] = solver.ranges[name], follows = name === "mu_kinetic" && input.value === "",
          value = input.value === "" ? NaN : Number(input.value) / factor(name);
        const good = follows || (value >= least && value <= most);
        input.setAttribute("aria-invalid", String(!good));
        notice(good ? "" : `${label} must be between ${short(least * factor(name))} and ` +
          `${short(most * factor(name))}.`);
        if (good && now.design) changed({ ...now.design, [name]: value });
      });
      const [low, high] = LIVE_RANGES[name] ?? [0, 1];
      stepsOf(input, () => (high - low) * factor(name));
      inputs.set(name, input);
      row.append(words, input);
      return row;
    }));
  }
  build();

  return (design) => {
    if (wanted().length !== inputs.size) build();
    now.design = { ...design };
    for (const [name, input] of inputs) {
      input.value = Number.isFinite(design[name]) ? Number((design[name] * factor(name)).toPrecision(15))
        : "";
      input.removeAttribute("aria-invalid");
    }
  };
}

/** A table of derivatives, to rounding as leapmap tells them, once it is opened. Returns show(design). */
export function gradientPart(map, solver) {
  const part = element("gradient"), table = element("gradient-table"), now = { design: null };
  const cell = (kind, text) =>
    { const made = document.createElement(kind); made.textContent = text; return made; };

  function draw() {
    if (!part.open || !now.design) return;
    const head = document.createElement("tr");
    head.append(cell("th", "small increase"),
      ...DIFFERENTIATED.map(([, words, unit]) =>
      { const th = cell("th", `${words} [${shownIn(unit, now.design)[1]}]`); th.scope = "col"; return th; }));
    const slopes = DIFFERENTIATED.map(([name]) =>
      solver.gradient(now.design, map.slips, map.tolerance, name));
    const rows = Object.entries(map.parameters)
      .filter(([name]) => slopes.some((slope) => Number.isFinite(slope[name])))
      .map(([name, { label, unit }]) => {
      // Of an angle and of what may be zero a step, of the rest a hundredth: what a workshop's tolerance is.
      /** @type {[number, string]} */
      const steps = unit === "°" ? [Math.PI / 180, "+ 1°"]
        : name.endsWith("_torque") || ["release_spin", "restitution"].includes(name) ? [0.01, "+ 0.01"]
        : [0.01 * now.design[name], "+ 1 %"];
      const tr = document.createElement("tr"), th = cell("th", `${label.split(" [")[0]} ${steps[1]}`);
      th.scope = "row";
      tr.dataset.name = name;
      tr.append(th, ...slopes.map((slope, k) => {
        const change = slope[name] * steps[0] * shownIn(DIFFERENTIATED[k][2], now.design)[0],
          td = cell("td", Number.isFinite(change)
          ? `${change > 0 ? "▲ +" : change < 0 ? "▼ " : ""}${short(change, 3)}` : "none");
        td.dataset.of = DIFFERENTIATED[k][0];
        td.dataset.value = String(slope[name]);
        return td;
      }));
      return tr;
    });
    table.replaceChildren(head, ...rows);
  }
  part.addEventListener("toggle", draw);
  return (design) => { now.design = { ...design }; draw(); };
}
