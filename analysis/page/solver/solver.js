// leapmap itself, compiled to WebAssembly (src/web).

import { unpacked } from "./decode.js";

/** The numbers of a drawing's ring, and of each of its weights, in the solver's order. */
export const RING_NUMBERS = ["diameter", "mass", "inertia"],
  WEIGHT_NUMBERS = ["mass", "at", "angle", "inertia"];

export const loadModule = async (text) => WebAssembly.compile(await unpacked(text));

export async function solverOf(module) {
  const imports = {
    env: { emscripten_notify_memory_growth() {} },
    wasi_snapshot_preview1: { proc_exit() { throw new Error("the solver gave up"); } },
  };
  const instance = await WebAssembly.instantiate(/** @type {WebAssembly.Module} */ (module), imports),
    leapmap = /** @type {any} */ (instance.exports);
  leapmap._initialize();
  const word = (pointer) => {
    if (!pointer) return null;
    const bytes = new Uint8Array(leapmap.memory.buffer);
    let end = pointer;
    while (bytes[end]) ++end;
    return new TextDecoder().decode(bytes.subarray(pointer, end));
  };
  const namesBy = (name) => {
    const names = [];
    for (let text; (text = word(name(names.length))) !== null;) names.push(text);
    return names;
  };
  const parameters = namesBy(leapmap.parameter_name), columns = namesBy(leapmap.column_name);
  const fields = namesBy(leapmap.field_name), liftOffColumns = namesBy(leapmap.lift_off_name),
    rowNames = namesBy(leapmap.row_name), madeNames = namesBy(leapmap.made_name);
  const doubles = (pointer, n) => new Float64Array(leapmap.memory.buffer, pointer, n);
  // The mass is the page's own: it changes no motion.
  const { mass: unknown, ...defaults } = Object.fromEntries(parameters.map((name, i) =>
    [name, doubles(leapmap.parameter_values(), parameters.length)[i]]));
  const rows = (names, pointer, n) => {
    const values = doubles(pointer, n * names.length).slice();
    return Object.fromEntries(names.map((name, k) =>
      [name, Float64Array.from({ length: n }, (_, i) => values[i * names.length + k])]));
  };
  const ranges = Object.fromEntries(parameters.map((name, i) =>
    [name, [leapmap.parameter_least(i), leapmap.parameter_most(i)]]));
  const codes = Object.fromEntries(fields.map((name, i) =>
    [name, namesBy((code) => leapmap.code_name(i, code))]));
  const reducedNames = namesBy(leapmap.reduced_name);
  const putDrawing = ({ ring, weights }) => {
    const numbers = [...RING_NUMBERS.map((key) => ring[key]),
      ...weights.flatMap((weight) => WEIGHT_NUMBERS.map((key) => weight[key]))];
    doubles(leapmap.body_numbers(weights.length), numbers.length).set(numbers);
  };
  /** The design that the solver has from now on, with the `drawing` that it follows from, if it has one. */
  const give = (design) => {
    doubles(leapmap.parameter_values(), parameters.length)
      .set(parameters.map((name) => design[name] ?? defaults[name] ?? unknown));
    if (design.drawing) putDrawing(design.drawing);
    leapmap.take_drawing(design.drawing ? 1 : 0);
    for (const name of design.drawing?.held ?? []) leapmap.hold(parameters.indexOf(name));
  };
  /** The solver's number of a parameter or, as "hoop.slug.mass", of a number of a design's drawing. */
  const numberOf = (name, design) => {
    const [section, ...path] = name.split("."), after = parameters.length + RING_NUMBERS.length;
    if (section !== "hoop") return parameters.indexOf(name);
    if (path.length === 1) return parameters.length + RING_NUMBERS.indexOf(path[0]);
    const weight = design.drawing.weights.findIndex((each) => each.name === path[0]);
    if (weight < 0) throw new RangeError(`its drawing has no ${name}`);
    return after + weight * WEIGHT_NUMBERS.length + WEIGHT_NUMBERS.indexOf(path[1]);
  };
  const ask = ({ jumps = 1, settle = 0, growth = false }) => leapmap.ask(jumps, settle, Number(growth));
  return {
    defaults, ranges, codes,
    /**
     * One design in full: {outcome, motion, liftOffs}, in SI but for forces, in weights, and heights, in
     * diameters. interval: of the motion's samples [s]; 0: as fine as a picture needs. asked: how many
     * `jumps` it is followed for, the gait after `settle` of them, if that is above zero, and whether the
     * `growth` of errors is told.
     */
    solve(design, slips, tolerance, interval = 0, asked = {}) {
      give(design);
      ask(asked);
      leapmap.solve(slips ? 1 : 0, tolerance, interval);
      const outcome = Object.fromEntries(fields.map((name, i) =>
        [name, word(leapmap.field_text(i)) ?? leapmap.field_value(i)]));
      return {
        outcome,
        motion: rows(columns, leapmap.points(), leapmap.point_count()),
        liftOffs: rows(liftOffColumns, leapmap.lift_offs(), leapmap.lift_off_count()),
      };
    },
    /** The derivatives of a field by every parameter, {name: number}: in the field's unit over the
        parameter's; NaN where there is none. */
    gradient(design, slips, tolerance, field) {
      give(design);
      const values = doubles(leapmap.gradient(slips ? 1 : 0, tolerance, fields.indexOf(field)),
        parameters.length);
      return Object.fromEntries(parameters.map((name, i) => [name, values[i]]));
    },
    /** What a hoop from a drawing comes to, {total_mass, mass_ratio, ...}: {ring: {diameter, mass, inertia},
        weights: [{mass, at, angle, inertia}]}, in SI; an inertia of NaN: a thin ring's. */
    reduce(drawing) {
      putDrawing(drawing);
      const values = doubles(leapmap.reduce_body(), reducedNames.length);
      return Object.fromEntries(reducedNames.map((name, k) => [name, values[k]]));
    },
    /** What solvePlaces tells of a design, in order. */
    rowNames,
    /**
     * Designs that differ in two numbers, parameters or of the drawing, in full: rows of numbers and codes of
     * each, one after the other.
     * places: the two numbers of each by turns. asked: as of solve.
     */
    solvePlaces(design, slips, tolerance, first, second, places, asked = {}) {
      give(design);
      ask(asked);
      const count = places.length / 2;
      doubles(leapmap.places(count), places.length).set(places);
      leapmap.solve_places(slips ? 1 : 0, tolerance, numberOf(first, design), numberOf(second, design),
        count);
      return doubles(leapmap.rows(), count * rowNames.length).slice();
    },
    /**
     * The same designs as made: of each what `asked` names as fields, one after the other. asked: {fields,
     * samples, seed, spreads: [{name, law, width, percent}], goals: [{field, least, most}], jumps, settle,
     * growth}.
     */
    solveMade(design, slips, tolerance, first, second, places, asked) {
      give(design);
      ask(asked);
      leapmap.ask_made(asked.samples, asked.seed);
      for (const { name, law, width, percent } of asked.spreads)
        leapmap.ask_spread(numberOf(name, design), law === "uniform" ? 1 : 0, width, Number(percent));
      for (const { field, least, most } of asked.goals)
        leapmap.ask_goal(fields.indexOf(field), least ?? -Infinity, most ?? Infinity);
      for (const name of asked.fields) leapmap.ask_field(madeNames.indexOf(name));
      const count = places.length / 2;
      doubles(leapmap.places(count), places.length).set(places);
      leapmap.solve_made(slips ? 1 : 0, tolerance, numberOf(first, design), numberOf(second, design),
        count);
      return doubles(leapmap.rows(), count * asked.fields.length).slice();
    },
    /**
     * Heights of the jumps that `count` hoops go on making, which differ in one parameter: after `settle`
     * jumps `keep` of each, hoop by hoop [diameters]; NaN: it makes none.
     */
    bifurcate(design, slips, tolerance, { parameter, from, to, count, settle, keep }) {
      give(design);
      leapmap.bifurcate(slips ? 1 : 0, tolerance, parameters.indexOf(parameter), from, to, count, settle,
        keep);
      return doubles(leapmap.heights(), count * keep).slice();
    },
  };
}
