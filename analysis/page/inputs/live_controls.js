// What one may turn on a live map: axes with their bounds, the model, and a slider with a number for every
// other parameter.

import { noteAddress } from "../state/address.js";
import { element, notice, option, stepsOf } from "../dom.js";
import {
  RATIOS, drawingOf, drawnNames, drawnParameters, heldUnit, isDrawn, partOf, rangeOf, spanOf, spreadsOf,
  usesDrawing,
} from "../state/drawn.js";
import { liveAxis } from "../solver/live.js";
import { LIVE_SHAPE } from "../solver/live_cliffs.js";
import { LIVE_RANGES, NO_LIVE_AXIS, SLIPPING } from "../state/ranges.js";
import { perUnit, short, withUnit } from "../state/units.js";

/** State as the address has it, x=slope:0.1:0.8&y=mass_ratio:0.5:10&friction=coulomb&mu_static=0.4, with what
    is missing by default. */
export function liveState(words, solver) {
  const state = { slips: words.get("friction") === "coulomb", fixed: {},
    drawing: drawingOf(words.get("drawing")) };
  const drawn = drawnNames(state.drawing);
  const numbers = (text) => (text ?? "").split(":").map((word, i) => (i === 0 ? word : Number(word)));
  const refuse = (key) =>
    notice(`The address asks for ${key}=${words.get(key)}, which is not possible and is ignored.`);
  const axis = (key, fallback, count) => {
    const [name, from, to] = numbers(words.get(key)),
      known = drawn.includes(name) || (name in LIVE_RANGES && !NO_LIVE_AXIS.includes(name)),
      [least, most] = known ? rangeOf({ ...state, solver }, name) : [NaN, NaN];
    const good = known && from >= least && to <= most && from < to;
    if (!good && words.has(key)) refuse(key);
    return good ? { name, from, to, count } : { ...fallback, count };
  };
  state.x = axis("x", { name: "slope", from: 2 * Math.PI / 180, to: 50 * Math.PI / 180 }, LIVE_SHAPE[0]);
  state.y = axis("y", { name: "mass_ratio", from: 0.1, to: 12 }, LIVE_SHAPE[1]);
  if (state.x.name === state.y.name && words.has("y")) refuse("y");
  if (state.x.name === state.y.name)
    state.y = { name: state.x.name === "slope" ? "mass_ratio" : "slope", from: 0.1, to: 0.8,
      count: LIVE_SHAPE[1] };
  if (isDrawn(state.x.name) && RATIOS.includes(state.y.name)) {
    if (words.has("y")) refuse("y");
    state.y = { name: "slope", from: 0.1, to: 0.8, count: LIVE_SHAPE[1] };
  }
  if (RATIOS.includes(state.x.name) && isDrawn(state.y.name)) {
    refuse("x");
    state.x = { name: "slope", from: 0.1, to: 0.8, count: LIVE_SHAPE[0] };
  }
  for (const name of Object.keys(solver.defaults)) {
    if (!words.has(name)) continue;
    const value = Number(words.get(name)), [least, most] = solver.ranges[name];
    if (words.get(name) !== "" && value >= least && value <= most) state.fixed[name] = value;
    else refuse(name);
  }
  return state;
}

/** Writes it into the address. */
function writeLive(words, map, defaults) {
  const axisText = ({ name, from, to }) => `${name}:${from}:${to}`;
  words.set("live", "");
  words.set("x", axisText(map.axes[0]));
  words.set("y", axisText(map.axes[1]));
  if (map.slips) words.set("friction", "coulomb");
  for (const [name, value] of Object.entries(map.fixed))
    if (value !== defaults[name] && Number.isFinite(value) && !map.axes.some((axis) => axis.name === name))
      words.set(name, String(value));
}

/** What belongs together, as the page has it. */
/** @type {[string, string[]][]} */
const GROUPS = [["Hoop", ["mass_ratio", "offset_ratio", "inertia_factor", "radius"]],
  ["Ground", ["slope", "mu_static", "mu_kinetic", "restitution", "rest_speed", "gravity"]],
  ["Release", ["release_angle", "release_spin", "runway", "hop_height", "clear_height"]],
  ["Motor", ["drive_torque", "resisting_torque"]]];

/** The parameters that a live map's model has, and those of them that are of the design itself. */
const liveParameters = (map) => Object.keys(LIVE_RANGES)
  .filter((name) => name in map.parameters && (map.slips || !SLIPPING.includes(name)));
export const designParameters = (map) => liveParameters(map).filter((name) => !NO_LIVE_AXIS.includes(name));
/** What may vary along an axis, where the other is of that name: a hoop has a drawing's numbers or ratios. */
const axisNames = (map, other) => {
  const scatters = map.spreads.some(({ name }) => isDrawn(name));
  return [...designParameters(map).filter((name) =>
    !((isDrawn(other) || scatters) && RATIOS.includes(name))),
  ...(RATIOS.includes(other) ? [] : drawnNames(map.drawing))];
};

/** Builds the controls. changed(what): "map" if the map is another, "model" if the model is. Returns what the
    address wants of them. */
export function liveControls(map, solver, changed) {
  const box = element("live-controls"), sliders = element("live-sliders"), model = element("live-model");
  const axisInputs = ["x", "y"].map((key) =>
    ({ name: element(`live-${key}`), from: element(`live-${key}-from`), to: element(`live-${key}-to`) }));
  box.hidden = false;
  const factor = (name) => perUnit(map.parameters[name].unit);

  function showAxes() {
    axisInputs.forEach((inputs, k) => {
      const axis = map.axes[k];
      inputs.name.replaceChildren();
      axisNames(map, map.axes[1 - k].name).forEach((name) =>
        option(inputs.name, name, map.parameters[name].label));
      inputs.name.value = axis.name;
      inputs.from.value = Number((axis.from * factor(axis.name)).toPrecision(6));
      inputs.to.value = Number((axis.to * factor(axis.name)).toPrecision(6));
    });
    map.showSpreads?.();  // what may scatter hangs on the axes
  }

  /** Takes the axes as they stand in the inputs; says so if they cannot be. */
  function takeAxes(k) {
    const inputs = axisInputs[k], name = inputs.name.value,
      [from, to] = [inputs.from, inputs.to].map((input) =>
      (input.value === "" ? NaN : Number(input.value) / factor(name)));
    const [least, most] = rangeOf(map, name), good = from < to && from >= least && to <= most;
    for (const input of [inputs.from, inputs.to]) input.setAttribute("aria-invalid", String(!good));
    notice(good ? "" : `${map.parameters[name].label}: from must be below to, both between ` +
      `${short(least * factor(name))} and ${short(most * factor(name))}.`);
    if (!good) return;
    Object.assign(map.axes[k], liveAxis(map, { name, from, to, count: LIVE_SHAPE[k] }));
    changed("map");
  }
  axisInputs.forEach((inputs, k) => {
    inputs.name.addEventListener("change", () => {
      const other = map.axes[1 - k], before = { ...map.axes[k] }, name = inputs.name.value;
      if (name === other.name)
        Object.assign(map.axes[1 - k], liveAxis(map, { ...before, count: LIVE_SHAPE[1 - k] }));
      else if (!isDrawn(before.name)) map.fixed[before.name] = (before.from + before.to) / 2;
      const [from, to] = name === other.name ? [other.from, other.to] : spanOf(map, name);
      Object.assign(map.axes[k], liveAxis(map, { name, from, to, count: LIVE_SHAPE[k] }));
      followDrawing();
      showAxes();
      showSliders();
      changed("map");
    });
    for (const input of [inputs.from, inputs.to]) {
      input.addEventListener("change", () => takeAxes(k));
      stepsOf(input, () =>
        { const name = inputs.name.value, [low, high] = spanOf(map, name); return (high - low) * factor(name);
        });
    }
  });

  function showSliders() {
    const follows = (name) => usesDrawing(map) && (RATIOS.includes(name) || name === "radius");
    const shown = liveParameters(map)
      .filter((name) => !follows(name) && !map.axes.some((axis) => axis.name === name));
    const rowOf = (name) => {
      const { label, unit } = map.parameters[name], [low, high] = LIVE_RANGES[name];
      const row = document.createElement("label"), words = document.createElement("span"),
        slider = document.createElement("input"), number = document.createElement("input");
      words.textContent = withUnit(label, unit ? `[${unit}]` : "");
      row.title = label;
      slider.type = "range";
      number.type = "number";
      number.step = slider.step = "any";
      [slider.min, slider.max] = [low, high];
      slider.dataset.parameter = number.dataset.parameter = name;
      slider.setAttribute("aria-label", label);
      number.setAttribute("aria-label", `${label}, as a number`);
      const show = () => {
        const value = map.fixed[name];
        number.value = Number.isFinite(value) ? String(Number((value * factor(name)).toPrecision(6))) : "";
        slider.value = Number.isFinite(value) ? value : map.fixed.mu_static;
        slider.setAttribute("aria-valuetext", withUnit(number.value || "as static friction", unit));
      };
      const take = (value) => {
        const [least, most] = solver.ranges[name], follows = name === "mu_kinetic" && number.value === "";
        const good = follows || (Number.isFinite(value) && value >= least && value <= most);
        number.setAttribute("aria-invalid", String(!good));
        notice(good ? "" : `${label} must be between ${short(least * factor(name))} and ` +
          `${short(most * factor(name))}.`);
        if (!good) return;
        // Quantities of the wall are offered where there is one.
        const offersOthers = name === "clear_height" && (value > 0) !== (map.fixed.clear_height > 0);
        map.fixed[name] = follows ? NaN : value;
        changed(offersOthers ? "model" : "map");
      };
      slider.addEventListener("input",
        () => { number.value = String(Number((Number(slider.value) * factor(name)).toPrecision(6)));
        slider.setAttribute("aria-valuetext", withUnit(number.value, unit)); take(Number(slider.value)); });
      stepsOf(number, () => (high - low) * factor(name));
      number.addEventListener("change",
        () => { take(number.value === "" ? NaN : Number(number.value) / factor(name));
        if (number.getAttribute("aria-invalid") !== "true") show(); });
      show();
      row.append(words, number, slider);
      return row;
    };
    sliders.replaceChildren(...GROUPS.flatMap(([title, names]) => {
      const some = names.filter((name) => shown.includes(name));
      if (some.length === 0) return [];
      const group = document.createElement("fieldset"), legend = document.createElement("legend");
      legend.textContent = title;
      group.append(legend, ...some.map(rowOf));
      return [group];
    }));
  }

  model.value = map.slips ? "coulomb" : "sticking";
  model.addEventListener("change", () => {
    map.slips = model.value === "coulomb";
    map.axes.forEach((axis, k) => {
      if (map.slips || !SLIPPING.includes(axis.name)) return;
      freeAxis(k);
    });
    showAxes();
    showSliders();
    changed("model");
  });
  showAxes();
  showSliders();
  /** Gives an axis another name, as what it had is no more to be had. */
  function freeAxis(k, name = ["slope", "mass_ratio", "offset_ratio"].find((each) =>
    each !== map.axes[1 - k].name)) {
    const [from, to] = spanOf(map, name);
    Object.assign(map.axes[k], liveAxis(map, { name, from, to, count: LIVE_SHAPE[k] }));
  }
  /** What follows from the drawing does so where hoops differ in its numbers. */
  function followDrawing() {
    if (!map.drawing || !usesDrawing(map)) return;
    const body = solver.reduce(map.drawing);
    for (const name of RATIOS) map.fixed[name] = body[name];
    map.fixed.radius = map.drawing.ring.diameter / 2;
  }
  function takeDrawing(drawing) {
    map.drawing = drawing;
    for (const name of Object.keys(map.parameters)) if (isDrawn(name)) delete map.parameters[name];
    Object.assign(map.parameters, drawnParameters(drawing));
    const names = drawnNames(drawing);
    map.axes.forEach(({ name }, k) => { if (isDrawn(name) && !names.includes(name)) freeAxis(k); });
    map.dropSpreads?.(({ name }) => isDrawn(name) && !names.includes(name));
  }
  /** The drawing is another: the map is of its kind. values: what it comes to. The first one's mass takes the
      place of a ratio along an axis. */
  map.redraw = (drawing, values) => {
    const isFirst = map.drawing === null, [weight] = drawing.weights, before = map.drawing;
    const held = (name) => heldUnit(solver, name, before, drawing);
    for (const name of before?.held ?? []) map.fixed[name] *= held(name);
    map.spreads = spreadsOf(solver, map.spreads, before, drawing);
    map.axes.forEach((axis) => {
      const unit = held(axis.name), { name, values: { length: count } } = axis;
      if (unit !== 1)
        Object.assign(axis, liveAxis(map, { name, from: axis.from * unit, to: axis.to * unit, count }));
    });
    takeDrawing({ ...drawing, held: before?.held ?? [] });
    // The hoop drawn is on its map.
    map.axes.forEach(({ name, from, to }, k) => {
      const [part, key] = isDrawn(name) ? partOf(drawing, name) : [{}, ""];
      if (isDrawn(name) && !(part[key] >= from && part[key] <= to)) freeAxis(k, name);
    });
    const ratio = map.axes.findIndex(({ name }) => RATIOS.includes(name));
    if (isFirst && weight && ratio >= 0 && !RATIOS.includes(map.axes[1 - ratio].name))
      freeAxis(ratio, `hoop.${weight.name}.mass`);
    for (const [name, value] of Object.entries(values))
      if (!map.axes.some((axis) => axis.name === name)) map.fixed[name] = value;
    showAxes();
    showSliders();
    changed("map");
  };
  /** Other tolerances: what may be turned may be others. */
  map.respread = () => { followDrawing(); showAxes(); showSliders(); };
  return {
    write: (words) => writeLive(words, map, solver.defaults),
    read(words, first) {
      if (first) return;
      const state = liveState(words, solver);
      Object.assign(map, { slips: state.slips, fixed: { ...solver.defaults, ...state.fixed } });
      takeDrawing(state.drawing);
      [state.x, state.y].forEach((axis, k) => Object.assign(map.axes[k], liveAxis(map, axis)));
      model.value = map.slips ? "coulomb" : "sticking";
      showAxes();
      showSliders();
      changed("model");
    },
  };
}

/** A whole number that the map, its input and the address's word call alike; what: what it counts, changed():
    it is another. */
export function countPart(map, name, what, changed) {
  const input = element(name), usual = map[name];
  input.addEventListener("change", () => {
    const good = input.value !== "" && input.checkValidity();
    input.setAttribute("aria-invalid", String(!good));
    notice(good ? "" : `${what} must be ` +
      `${input.step > 1 ? `a multiple of ${input.step}` : "a whole number"} from ${input.min} to ` +
      `${input.max}.`);
    if (!good) return;
    map[name] = Number(input.value);
    changed();
    noteAddress();
  });
  return {
    write(words) { if (map[name] !== usual) words.set(name, map[name]); },
    read(words) {
      input.value = words.get(name) ?? usual;
      input.setAttribute("aria-invalid", "false");
      if (input.value === "" || !input.checkValidity()) { input.value = usual;
          notice(`The address asks for ${name}=${words.get(name)}, which is not possible and is ignored.`); }
      map[name] = Number(input.value);
    },
  };
}

/** How many jumps a live map lets go by before it looks for gaits. */
export const settlePart = (map) =>
  countPart(map, "settle", "The transient before a gait is searched for", () => map.refresh());
