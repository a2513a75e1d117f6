// The numbers of the drawing that hoops of a map are of, such as "hoop.slug.mass": what they are called,
// where they may lie, and what hoops they come to. All in SI; the solver's own list of them is in solver.js.

import { LIVE_RANGES } from "./ranges.js";
import { RING_NUMBERS, WEIGHT_NUMBERS } from "../solver/solver.js";
import { short, units } from "./units.js";

/** What a number is called, and its unit as shown. */
const DRAWN_WORDS = { diameter: ["diameter", "mm"], mass: ["mass", "g"],
  inertia: ["moment of inertia", "kg mm²"], at: ["distance from the axis", "mm"],
  angle: ["direction", "°"] };
/** What follows from a drawing. */
export const RATIOS = ["mass_ratio", "offset_ratio", "inertia_factor"];

export const isDrawn = (name) => name.startsWith("hoop.");
/** The part of a drawing that a number is of, and its name there. */
export function partOf(drawing, name) {
  const [, ...path] = name.split(".");
  return [path.length === 1 ? drawing.ring : drawing.weights.find((weight) => weight.name === path[0]),
    path.at(-1)];
}

/** A drawing with all its numbers, from one of which some are null, as the explorer writes it. */
export const wholeDrawing = ({ ring, weights, held = [] }) => ({ held,
  ring: { ...ring, inertia: ring.inertia ?? NaN },
  weights: weights.map((weight) =>
    ({ ...weight, angle: weight.angle ?? 0, inertia: weight.inertia ?? 0 })) });

/** The drawing with the numbers that a design has of its own. */
export function drawingAt(drawing, design) {
  const own = { ...drawing, ring: { ...drawing.ring },
    weights: drawing.weights.map((weight) => ({ ...weight })) };
  for (const [name, value] of Object.entries(design)) {
    if (!isDrawn(name)) continue;
    const [part, key] = partOf(own, name);
    if (part) part[key] = value;
  }
  return own;
}

/** The names of all numbers that a drawing gives. */
export const drawnNames = (drawing) => (drawing === null ? [] : [
  ...RING_NUMBERS.filter((key) => Number.isFinite(drawing.ring[key])).map((key) => `hoop.${key}`),
  ...drawing.weights.flatMap(({ name }) => WEIGHT_NUMBERS.map((key) => `hoop.${name}.${key}`))]);

/** How each of them is called and shown, as parameters are. */
export const drawnParameters = (drawing) => Object.fromEntries(drawnNames(drawing).map((name) => {
  const [, ...path] = name.split("."), [words, unit] = DRAWN_WORDS[path.at(-1)],
    label = `${words} of ${path.length > 1 ? path[0] : path[0] === "diameter" ? "hoop" : "ring"}`;
  return [name, { label, symbol: label, unit }];
}));

/** Between what a number may lie. */
export function drawnRange(drawing, name) {
  const [, key] = partOf(drawing, name), isOfRing = name.split(".").length === 2;
  return { diameter: [2e-9, 200], mass: [isOfRing ? 1e-9 : 0, 1e6], inertia: [0, 1e6],
    at: [0, drawing.ring.diameter / 2], angle: [-2 * Math.PI, 2 * Math.PI] }[key];
}

/** Between what it is moved at first. */
function drawnSpan(drawing, name) {
  const [part, key] = partOf(drawing, name), value = part[key], { ring, weights } = drawing;
  if (key === "diameter") return [Math.max(value / 2, ...weights.map(({ at }) => 2 * at)), 2 * value];
  if (key === "at") return [0, ring.diameter / 2];
  if (key === "angle") return [-Math.PI, Math.PI];
  const most = { mass: ring.mass, inertia: ring.mass * ring.diameter ** 2 / 4 }[key];
  return value > 0 ? [value / 4, 2 * value] : [0, most];
}

export const rangeOf = (map, name) =>
  (isDrawn(name) ? drawnRange(map.drawing, name) : map.solver.ranges[name]);
export const spanOf = (map, name) => (isDrawn(name) ? drawnSpan(map.drawing, name) : LIVE_RANGES[name]);

/** Whether hoops of the map differ in a number of the drawing, or are made so. */
export const usesDrawing = (map) => [...map.axes, ...map.spreads].some(({ name }) => isDrawn(name));
/** What may be drawn to the right: the columns of a list, the axes of a grid. */
export const choicesOf = (map) => map.columns ?? map.axes;
/** Whether hoops of the map differ in mass, and in size. */
const differInMass = (map) => choicesOf(map).some(({ name }) => isDrawn(name) && name.endsWith(".mass"));
export const differInSize = (map) => choicesOf(map).some(({ name }) => name === "hoop.diameter");
/** Whether a number of the drawing with such a name has a tolerance. */
const scatterIn = (map, fits) => map.spreads.some(({ name }) => isDrawn(name) && fits(name));
/** By what a quantity of the whole map is shown in SI: NaN where its hoops have none in common. */
export const scaleOf = (map, field = null) => ({ gravity: map.fixed.gravity,
  radius: differInSize(map) || (field?.made && scatterIn(map, (name) => name === "hoop.diameter")) ? NaN
    : map.fixed.radius,
  mass: differInMass(map) || (field?.made && scatterIn(map, (name) => name.endsWith(".mass"))) ? NaN
    : units.mass });
/** The tolerances of a map that are of numbers which a drawing lacks. */
export const lackedBy = (drawing, spreads) => {
  const names = drawnNames(drawing);
  return spreads.filter(({ name }) => isDrawn(name) && !names.includes(name)).map(({ name }) => name);
};

/** Parameters that hoops may have the same of in the SI, and the powers of a hoop's mass and size as which it
    has them in its own units: as leapmap's same_in_si. */
const SAME_IN_SI = { drive_torque: [-1, -1], resisting_torque: [-1, -1], release_spin: [0, 0.5] };
const inOwnUnits = (design, names, heavier, larger) =>
  Object.fromEntries(names.filter((name) => name in design).map((name) =>
    [name, design[name] * heavier ** SAME_IN_SI[name][0] * larger ** SAME_IN_SI[name][1]]));

/** How many of one hoop's own unit of a parameter are one of another's: 1 unless hoops share it in the SI.
    Each hoop is a drawing. */
export function heldUnit(solver, name, from, to) {
  if (!from?.held?.includes(name) || !to) return 1;
  const heavier = solver.reduce(to).total_mass / solver.reduce(from).total_mass;
  return inOwnUnits({ [name]: 1 }, [name], heavier, to.ring.diameter / from.ring.diameter)[name];
}

/** Tolerances as they are of a hoop of another drawing. */
export const spreadsOf = (solver, spreads, from, to) => spreads.map((spread) =>
  (spread.percent ? spread : { ...spread, width: spread.width * heldUnit(solver, spread.name, from, to) }));

/** A design of a map over numbers of the drawing with what they come to, its radius and its mass among it. */
export function shapedBy(map, design) {
  if (!map.drawing || !Object.keys(design).some(isDrawn)) return design;
  const drawing = drawingAt(map.drawing, design), nominal = map.solver.reduce(map.drawing).total_mass,
    { total_mass, mass_ratio, offset_ratio, inertia_factor } = map.solver.reduce(drawing);
  return { ...design, mass_ratio, offset_ratio, inertia_factor, radius: drawing.ring.diameter / 2,
    mass: total_mass, ...inOwnUnits(design, map.drawing.held ?? [], total_mass / nominal,
      drawing.ring.diameter / map.drawing.ring.diameter) };
}

/** A hoop as made after another drawing than its own: as leapmap's MadeHoops::take_body. */
export function madeBy(solver, hoop, drawing, made) {
  const nominal = solver.reduce(drawing), body = solver.reduce(made), balanced = 1e-12,
    turn = body.direction - nominal.direction, larger = made.ring.diameter / drawing.ring.diameter;
  const turns = nominal.eccentricity > balanced && body.eccentricity > balanced;
  return { ...hoop, mass_ratio: body.mass_ratio, offset_ratio: body.offset_ratio,
    inertia_factor: body.inertia_factor,
    release_angle: hoop.release_angle + (turns ? turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)) : 0),
    radius: hoop.radius * larger,
    ...inOwnUnits(hoop, Object.keys(SAME_IN_SI), body.total_mass / nominal.total_mass, larger) };
}

export const NEW_WEIGHT = { mass: 0.02, at: 0, angle: 0, inertia: 0 };

/** The usual name of a mass, by its place. */
export const usualName = (k) => `mass${k + 1}`;

/** In words: "0.12:0.061:0.00019;0.085:0.047:0:0:slug;=drive_torque": the ring's numbers, then each mass's,
    in SI, and its name if that is not the usual one, then the parameters in the units of this hoop. */
export const drawingWord = ({ ring, weights, held = [] }) => [
  ...[[RING, ring], ...weights.map((weight) => [WEIGHT, weight])]
    .map(([rows, part], k) => [...rows.map(([name]) => (Number.isFinite(part[name]) ? part[name] : "")),
      ...(k > 0 && part.name !== usualName(k - 1) ? [part.name] : [])].join(":")),
  ...(held.length > 0 ? [`=${held.join(",")}`] : [])].join(";");

/** And back; null if it is none. */
export function drawingOf(word) {
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
export function wrongIn({ ring, weights }) {
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

export const WEIGHT = [["mass", "mass [g]", 1e-3], ["at", "from the axis [mm]", 1e-3],
  ["angle", "angle [°]", Math.PI / 180], ["inertia", "own inertia [kg m²]", 1]];

export const RING = [["diameter", "outer diameter [mm]", 1e-3], ["mass", "mass of the ring [g]", 1e-3],
  ["inertia", "its moment of inertia [kg m²]; empty: a thin ring", 1]];
