// Hoops as made after a drawing, for a picture: plain random numbers, of which leapmap's own statistics need
// none.

/** A generator of numbers inside (0, 1), the same for the same seed (mulberry32). */
function randomNumbers(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = Math.imul(state ^ (state >>> 15), state | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return (((t ^ (t >>> 14)) >>> 0) + 0.5) / 4294967296;
  };
}

/** Designs that were made after one, by scatter: [{name, law, width, percent}]. drawing: that it follows
    from, or null: then numbers of a drawing do not scatter. */
function madeAfter(solver, design, drawing, scatter, count, seed = 1) {
  const random = randomNumbers(seed), made = [];
  const normal = () => Math.sqrt(-2 * Math.log(random())) * Math.cos(2 * Math.PI * random());
  const drawn = (name) => {
    if (!isDrawn(name)) return Number.isFinite(design[name]) ? design[name] : design.mu_static;
    const [part, key] = partOf(drawing, name);
    return part[key];
  };
  const some = drawing ? scatter : scatter.filter(({ name }) => !isDrawn(name));
  for (let i = 0; i < count; ++i) {
    const hoop = { ...design }, numbers = {};
    for (const { name, law, width, percent } of some) {
      const [least, most] = isDrawn(name) ? drawnRange(drawing, name) : solver.ranges[name],
        about = drawn(name), scale = percent ? 0.01 * width * Math.abs(about) : width;
      for (let tries = 0; tries < 1000; ++tries) {
        const value = about + scale * (law === "normal" ? normal() : 2 * random() - 1);
        if (value >= least && value <= most) { (isDrawn(name) ? numbers : hoop)[name] = value; break; }
      }
    }
    made.push(Object.keys(numbers).length > 0
      ? madeBy(solver, hoop, drawing, drawingAt(drawing, numbers)) : hoop);
  }
  return made;
}

/** Whether an outcome reaches every goal: [{field, least, most}]; codes: {field: names in the order of its
    codes}. */
function reachesAll(outcome, goals, codes) {
  return goals.every(({ field, least, most }) => {
    const number = (value) =>
      (Object.hasOwn(codes, field) && codes[field].includes(value) ? codes[field].indexOf(value) : value);
    const value = number(outcome[field]);
    return (least === null || value >= number(least)) && (most === null || value <= number(most));
  });
}
