// Lengths, times and forces as people read them: in SI, or as pure numbers in radii, weights and √(R/g).

import { element } from "../dom.js";

export const units = { pure: false, mass: NaN };  // kg, of hoop and point mass; NaN: unknown

/** How measures of one hoop are told. design: with its radius and gravity; kg: of hoop and point mass, NaN if
    nobody weighed it: then forces are in weights. All are given in SI, forces in weights. */
export function measuresOf(design, kg) {
  const R = design.radius, g = design.gravity, second = Math.sqrt(R / g);
  const told = (value, digits, unit) => `${short(value, digits)} ${unit}`, tidy = (metres) =>
    (Math.abs(metres) < 1e-9 * R ? 0 : metres);
  const force = (weights) => told(weights, 4, "weights"), energy = (part) => told(part, 4, "(m + mₚ) g R");
  if (units.pure) return {
    length: (metres, digits = 4) => told(tidy(metres) / R, digits, "R"), time: (s, digits = 4) =>
      told(s / second, digits, "√(R/g)"),
    speed: (v) => told(v / Math.sqrt(R * g), 4, "√(g R)"), spin: (radians) =>
      told(radians * second, 4, "√(g/R)"), force, energy,
    plots: { t: [1 / second, "√(R/g)"], y: [1 / R, "R"], force: [1, "weights"] },
  };
  return {
    length: (metres, digits = 4) =>
      (Math.abs(metres) >= 1 ? told(metres, digits, "m") : told(1000 * tidy(metres), digits, "mm")),
      time: (s, digits = 4) => told(s, digits, "s"),
    speed: (v) => told(v, 4, "m/s"), spin: (radians) => told(radians, 4, "rad/s"),
    force: kg > 0 ? (weights) => told(weights * kg * g, 4, "N") : force,
    energy: kg > 0 ? (part) => told(1000 * part * kg * g * R, 4, "mJ") : energy,
    plots: { t: [1, "s"], y: [1000, "mm"], force: kg > 0 ? [kg * g, "N"] : [1, "weights"] },
  };
}

/** How many of a parameter's unit as shown are one of the solver's. */
export const perUnit = (unit) => ({ "°": 180 / Math.PI, mm: 1e3, g: 1e3, "kg mm²": 1e6 })[unit] ?? 1;

/** What values of a unit are shown in: [factor, unit], in SI or as pure numbers. scene: with the radius and
    gravity they belong to, and the mass if that is another than the hoop's shown; a radius or mass of NaN:
    they have none in common. */
export function shownIn(unit, { radius: R, gravity: g, mass = units.mass }) {
  const second = Math.sqrt(R / g), rows = units.pure
    ? (R > 0 ? { s: [1 / second, "√(R/g)"], "m/s": [second / R, "√(g R)"] } : {})
    : !(R > 0) ? { rad: [180 / Math.PI, "°"] }
    : { "hoop diameters": [2000 * R, "mm"], diameters: [2000 * R, "mm"], R: [1000 * R, "mm"],
      "√(g/R)": [1 / second, "rad/s"], rad: [180 / Math.PI, "°"], "√(g R)": [R / second, "m/s"],
      ...(mass > 0 ? { "(m + mₚ) √(g R)": [1000 * mass * R / second, "mN s"],
        "(m + mₚ) g R": [1000 * mass * g * R, "mJ"] } : {}) };
  return rows[unit] ?? [1, unit];
}

/** A value in the units shown, with the unit. */
export function toldIn(value, unit, scene, digits = 4) {
  const [factor, shown] = shownIn(unit, scene);
  return withUnit(short(value * factor, digits), shown);
}

/** A field's value in the units shown, where those are not the field's own: " = 99 mm"; "" else. */
export const alsoAs = (field, value, scene) =>
  (shownIn(field.unit, scene)[1] === field.unit || value !== value ? ""
  : ` = ${toldIn(value, field.unit, scene)}`);

/** A field's name with the unit it is shown in. */
export const fieldLabel = (field, scene, label = field.label) =>
  { const [, unit] = shownIn(field.unit, scene); return unit ? `${label} [${unit}]` : label; };

/** The switch; changed(): everything is told anew. */
export function unitsPart(changed) {
  const select = element("units");
  select.addEventListener("change", () => { units.pure = select.value === "pure"; changed(); });
  return {
    write(words) { if (units.pure) words.set("units", "pure"); },
    read(words) { units.pure = words.get("units") === "pure"; select.value = units.pure ? "pure" : "si";
      changed(); },
  };
}

/** Numbers as people read them: four digits, no needless zeros. */
export function short(value, digits = 4) {
  if (!Number.isFinite(value)) return "none";
  return String(Number(value.toPrecision(digits)));
}

export const withUnit = (text, unit) => (unit === "°" ? `${text}°` : unit ? `${text} ${unit}` : text);
export const inShownUnit = (axis, value) => value * perUnit(axis.unit);
