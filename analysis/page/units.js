// Lengths, times and forces as people read them: in SI, or as pure numbers in radii, weights and √(R/g).

const units = { pure: false };

/** How measures of one hoop are told. design: with its radius and gravity; kg: of hoop and point mass. All are given in SI, forces in weights. */
function measuresOf(design, kg) {
  const R = design.radius, g = design.gravity, second = Math.sqrt(R / g);
  const told = (value, digits, unit) => `${short(value, digits)} ${unit}`, tidy = (metres) => (Math.abs(metres) < 1e-9 * R ? 0 : metres);
  if (units.pure) return {
    length: (metres, digits = 4) => told(tidy(metres) / R, digits, "R"), time: (s, digits = 4) => told(s / second, digits, "√(R/g)"),
    speed: (v) => told(v / Math.sqrt(R * g), 4, "√(g R)"), spin: (radians) => told(radians * second, 4, "√(g/R)"), force: (weights) => told(weights, 4, "weights"),
    energy: (part) => told(part, 4, "(m + mₚ) g R"),
    plots: { t: [1 / second, "√(R/g)"], y: [1 / R, "R"], force: [1, "weights"] },
  };
  return {
    length: (metres, digits = 4) => (Math.abs(metres) >= 1 ? told(metres, digits, "m") : told(1000 * tidy(metres), digits, "mm")), time: (s, digits = 4) => told(s, digits, "s"),
    speed: (v) => told(v, 4, "m/s"), spin: (radians) => told(radians, 4, "rad/s"), force: (weights) => told(weights * kg * g, 4, "N"), energy: (part) => told(1000 * part * kg * g * R, 4, "mJ"),
    plots: { t: [1, "s"], y: [1000, "mm"], force: [kg * g, "N"] },
  };
}

/** A field's value in the units chosen, where those are not the field's own: "= 99 mm"; "" else. */
function alsoAs(field, value, scene) {
  const R = scene.radius, second = Math.sqrt(R / scene.gravity);
  const rows = units.pure ? { s: [1 / second, "√(R/g)"], "m/s": [second / R, "√(g R)"] }
    : { "hoop diameters": [2000 * R, "mm"], R: [1000 * R, "mm"], "√(g/R)": [1 / second, "rad/s"], rad: [180 / Math.PI, "°"] };
  const row = rows[field.unit];
  return row && value === value ? ` = ${withUnit(short(value * row[0]), row[1])}` : "";
}

/** The switch; changed(): everything is told anew. */
function unitsPart(changed) {
  const select = element("units");
  select.addEventListener("change", () => { units.pure = select.value === "pure"; changed(); });
  return {
    write(words) { if (units.pure) words.set("units", "pure"); },
    read(words) { units.pure = words.get("units") === "pure"; select.value = units.pure ? "pure" : "si"; changed(); },
  };
}
