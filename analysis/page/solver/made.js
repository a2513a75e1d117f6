// Hoops as made after a drawing, for a picture: plain random numbers, of which leapmap's own statistics need
// none.

import { notice } from "../dom.js";
import { drawingAt, drawnRange, isDrawn, madeBy, partOf } from "../state/drawn.js";

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
export function madeAfter(solver, design, drawing, scatter, count, seed = 1) {
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
export function reachesAll(outcome, goals, codes) {
  return goals.every(({ field, least, most }) => {
    const number = (value) =>
      (Object.hasOwn(codes, field) && codes[field].includes(value) ? codes[field].indexOf(value) : value);
    const value = number(outcome[field]);
    return (least === null || value >= number(least)) && (most === null || value <= number(most));
  });
}

export const USUAL_SPREADS =
  ["mass_ratio", "offset_ratio", "inertia_factor"].map((name) =>
  ({ name, law: "normal", width: 1, percent: true }));

/** Goals as the solver takes them: by numbers, where a map's goals are words that a code stands for. Null:
    the page's solver knows one of them not. */
export function numberedGoals(goals, codes) {
  const number = (field, value) =>
    (Object.hasOwn(codes, field) && codes[field].includes(value) ? codes[field].indexOf(value) : value);
  const numbered = goals.map(({ field, least, most }) =>
    ({ field, least: number(field, least), most: number(field, most) }));
  return numbered.every(({ field, least, most }) => Object.hasOwn(codes, field)
    && [least, most].every((v) => v === null || Number.isFinite(v))) ? numbered : null;
}

/** The goal to jump. */
export function jumping(map) {
  const jumped = map.solver.codes.status.indexOf("jumped");
  return { field: "status", least: jumped, most: jumped };
}

/**
 * What the solver is to be asked of hoops as made, so that all such fields of a map have numbers. goals:
 * {field, least, most} that a hoop is to reach, null: no such bound; without any it is to jump. yields:
 * whether the yield is among them, which goals are for.
 */
export function madeAsked(map, goals, yields = true) {
  const fields = map.fields.filter((field) => field.made && (yields || field.name !== "yield"))
    .map(({ name }) => name);
  return {
    fields, samples: map.samples, seed: map.seed, spreads: map.spreads.map((spread) => ({ ...spread })),
    goals: goals.length > 0 ? goals : [jumping(map)],
    jumps: goals.some(({ field }) => ["jumps", "sequence_condition"].includes(field)) ? map.jumps : 1,
    settle: goals.some(({ field }) => field.startsWith("gait_")) ? map.settle : 0,
    growth: map.jumps > 1 && goals.some(({ field }) => field === "sequence_condition"),
  };
}

/**
 * A thread that tells what becomes of hoops made after one design, as that may take long: tell(order, done)
 * calls done(row), null if it cannot be told, unless something else is asked, or drop() called, before that.
 */
export function madeTeller(module, workerText) {
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  let worker = null;
  const drop = () => { worker?.terminate(); worker = null; };
  function tell(order, done) {
    drop();
    worker = new Worker(url);
    const fail = (error) =>
      { drop(); notice(`Manufactured hoops cannot be solved: ${error.message ?? error}`); done(null); };
    worker.onmessage = ({ data }) => {
      if (data.ready) worker.postMessage(order);
      else if (data.error) fail(data.error);
      else { drop(); done(data.rows); }
    };
    worker.onerror = fail;
    worker.postMessage({ module });
  }
  return { tell, drop };
}
