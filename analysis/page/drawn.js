// The numbers of the drawing that hoops of a map are of, such as "hoop.slug.mass": what they are called,
// where they may lie, and what hoops they come to. All in SI; the solver's own list of them is in solver.js.

/** What a number is called, and its unit as shown. */
const DRAWN_WORDS = { diameter: ["diameter", "mm"], mass: ["mass", "g"],
  inertia: ["moment of inertia", "kg mm²"], at: ["distance from the axis", "mm"], angle: ["direction", "°"] };
/** What follows from a drawing. */
const RATIOS = ["mass_ratio", "offset_ratio", "inertia_factor"];

const isDrawn = (name) => name.startsWith("hoop.");
/** The part of a drawing that a number is of, and its name there. */
function partOf(drawing, name) {
  const [, ...path] = name.split(".");
  return [path.length === 1 ? drawing.ring : drawing.weights.find((weight) => weight.name === path[0]),
    path.at(-1)];
}

/** A drawing with all its numbers, from one of which some are null, as the explorer writes it. */
const wholeDrawing = ({ ring, weights, held = [] }) => ({ held,
  ring: { ...ring, inertia: ring.inertia ?? NaN },
  weights: weights.map((weight) =>
    ({ ...weight, angle: weight.angle ?? 0, inertia: weight.inertia ?? 0 })) });

/** The drawing with the numbers that a design has of its own. */
function drawingAt(drawing, design) {
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
const drawnNames = (drawing) => (drawing === null ? [] : [
  ...RING_NUMBERS.filter((key) => Number.isFinite(drawing.ring[key])).map((key) => `hoop.${key}`),
  ...drawing.weights.flatMap(({ name }) => WEIGHT_NUMBERS.map((key) => `hoop.${name}.${key}`))]);

/** How each of them is called and shown, as parameters are. */
const drawnParameters = (drawing) => Object.fromEntries(drawnNames(drawing).map((name) => {
  const [, ...path] = name.split("."), [words, unit] = DRAWN_WORDS[path.at(-1)],
    label = `${words} of ${path.length > 1 ? path[0] : path[0] === "diameter" ? "hoop" : "ring"}`;
  return [name, { label, symbol: label, unit }];
}));

/** Between what a number may lie. */
function drawnRange(drawing, name) {
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

const rangeOf = (map, name) => (isDrawn(name) ? drawnRange(map.drawing, name) : map.solver.ranges[name]);
const spanOf = (map, name) => (isDrawn(name) ? drawnSpan(map.drawing, name) : LIVE_RANGES[name]);

/** Whether hoops of the map differ in a number of the drawing, or are made so. */
const usesDrawing = (map) => [...map.axes, ...map.spreads].some(({ name }) => isDrawn(name));
/** What may be drawn to the right: the columns of a list, the axes of a grid. */
const choicesOf = (map) => map.columns ?? map.axes;
/** Whether hoops of the map differ in mass, and in size. */
const differInMass = (map) => choicesOf(map).some(({ name }) => isDrawn(name) && name.endsWith(".mass"));
const differInSize = (map) => choicesOf(map).some(({ name }) => name === "hoop.diameter");
/** Whether a number of the drawing with such a name has a tolerance. */
const scatterIn = (map, fits) => map.spreads.some(({ name }) => isDrawn(name) && fits(name));
/** By what a quantity of the whole map is shown in SI: NaN where its hoops have none in common. */
const scaleOf = (map, field = null) => ({ gravity: map.fixed.gravity,
  radius: differInSize(map) || (field?.made && scatterIn(map, (name) => name === "hoop.diameter")) ? NaN
    : map.fixed.radius,
  mass: differInMass(map) || (field?.made && scatterIn(map, (name) => name.endsWith(".mass"))) ? NaN
    : units.mass });
/** The tolerances of a map that are of numbers which a drawing lacks. */
const lackedBy = (drawing, spreads) => {
  const names = drawnNames(drawing);
  return spreads.filter(({ name }) => isDrawn(name) && !names.includes(name)).map(({ name }) => name);
};

/** Parameters that hoops may have the same of in the SI, and the powers of a hoop's mass and size as which it
    has them in its own units: as leapmap's same_in_si. */
const SAME_IN_SI = { drive_torque: [-1, -1], resisting_torque: [-1, -1], release_spin: [0, 0.5] };
const inOwnUnits = (design, names, heavier, larger) =>
  Object.fromEntries(names.filter((name) => name in design).map((name) =>
    [name, design[name] * heavier ** SAME_IN_SI[name][0] * larger ** SAME_IN_SI[name][1]]));

/** A design of a map over numbers of the drawing with what they come to, its radius and its mass among it. */
function shapedBy(map, design) {
  if (!map.drawing || !Object.keys(design).some(isDrawn)) return design;
  const drawing = drawingAt(map.drawing, design), nominal = map.solver.reduce(map.drawing).total_mass,
    { total_mass, mass_ratio, offset_ratio, inertia_factor } = map.solver.reduce(drawing);
  return { ...design, mass_ratio, offset_ratio, inertia_factor, radius: drawing.ring.diameter / 2,
    mass: total_mass, ...inOwnUnits(design, map.drawing.held ?? [], total_mass / nominal,
      drawing.ring.diameter / map.drawing.ring.diameter) };
}

/** A hoop as made after another drawing than its own: as leapmap's MadeHoops::take_body. */
function madeBy(solver, hoop, drawing, made) {
  const nominal = solver.reduce(drawing), body = solver.reduce(made), balanced = 1e-12,
    turn = body.direction - nominal.direction, larger = made.ring.diameter / drawing.ring.diameter;
  const turns = nominal.eccentricity > balanced && body.eccentricity > balanced;
  return { ...hoop, mass_ratio: body.mass_ratio, offset_ratio: body.offset_ratio,
    inertia_factor: body.inertia_factor,
    release_angle: hoop.release_angle + (turns ? turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI)) : 0),
    radius: hoop.radius * larger,
    ...inOwnUnits(hoop, Object.keys(SAME_IN_SI), body.total_mass / nominal.total_mass, larger) };
}
