// What an address asks for, and the address of a live map that begins at a file's.

import { element, notice } from "./dom.js";
import { drawingAt, drawingWord, isDrawn, shapedBy, wholeDrawing } from "./state/drawn.js";
import { costOf } from "./solver/live.js";
import { madeAsked, numberedGoals } from "./solver/made.js";
import { LIVE_RANGES, NO_LIVE_AXIS } from "./state/ranges.js";
import { spreadWord } from "./inputs/tolerances.js";

/** What the solver is to be asked of a hoop of one's own beside a file's map, so that all its fields are
    told. */
export function askedOfFile(map) {
  const has = (cost) => map.fields.some((f) => costOf(f) === cost), { beyond_page: beyond = [] } = map;
  const goals = has("made") && beyond.length === 0 ? numberedGoals(map.goals, map.solver.codes) : null;
  return { jumps: map.jumps, settle: has("settle") ? map.settle : 0, growth: has("growth"), made: goals
    && madeAsked(map, goals) };
}

/** The address of the live map that a file's map begins at: its two longest axes, the rest as it stands. */
export function liveFrom(map) {
  const words = new URLSearchParams(), fit = (axis) => axis.values.length > 1
    && (isDrawn(axis.name) || (axis.name in LIVE_RANGES && !NO_LIVE_AXIS.includes(axis.name)));
  const axes = map.columns ? [] : map.axes.filter(fit)
    .sort((a, b) => b.values.length - a.values.length).slice(0, 2)
    .sort((a, b) => Number(b.name === "slope") - Number(a.name === "slope"));
  const rest = (map.columns ? [] : map.axes).filter((axis) => !axes.includes(axis))
    .map((axis) => [axis.name, axis.values[Math.floor(axis.values.length / 2)]]);
  const here = shapedBy(map, { ...map.fixed, ...Object.fromEntries(rest) });
  const unit = (name) => (map.drawing?.held?.includes(name)
    ? shapedBy(map, { ...Object.fromEntries(rest), [name]: 1 })[name] : 1);
  axes.forEach(({ name, values }, k) => words.set(k === 0 ? "x" : "y",
    `${name}:${values[0] * unit(name)}:${values.at(-1) * unit(name)}`));
  for (const [name] of rest) if (!isDrawn(name)) words.set(name, here[name]);
  if (map.drawing)
    words.set("drawing", drawingWord(drawingAt(wholeDrawing(map.drawing), Object.fromEntries(rest))));
  for (const name of Object.keys(map.fixed)) if (Number.isFinite(here[name])) words.set(name, here[name]);
  if (map.slips) words.set("friction", "coulomb");
  if (map.settle > 0) words.set("settle", String(Math.min(map.settle, element("settle").max)));
  for (const spread of map.spreads)
    words.append("made",
      spreadWord({ ...spread, width: spread.width * (spread.percent ? 1 : unit(spread.name)) }));
  if (map.beyond_page?.length) words.append("made", "none");  // others than the map's would mislead
  if (map.spreads.length > 0) words.set("samples", String(Math.min(map.samples, element("samples").max)));
  if (map.spreads.length > 0 && map.seed !== 1) words.set("seed", map.seed);
  for (const { field, least, most } of map.goals) {
    if (field === "spurious_first_jump" && least === "first_lift_off_is_the_jump") words.set("real", "");
    // What any other goal takes, and what counts where there is none.
    else if (field === "status" && least === "jumped") continue;
    // A live map says that it leaves such a goal out.
    else if (typeof (least ?? most) === "string") words.append("goal", `${field}:is:${least}`);
    else for (const [sign, bound] of [["least", least], ["most", most]]) if (bound !== null)
      words.append("goal", `${field}:${sign}:${bound}`);
  }
  return `live&${words.toString().replaceAll("%3A", ":")}`;
}

/** What the address asks for, as #design=20,30,1&time=0.5: a design by its place along each axis, and a
    moment to stop at [s]. */
export function addressed(map, words) {
  const asked = {}, index = (words.get("design") ?? "").split(",")
    .map((word) => (/^\d+$/.test(word) ? Number(word) : -1));
  if (words.has("design")
      && !(index.length === map.axes.length
      && map.axes.every((axis, k) => index[k] >= 0 && index[k] < axis.values.length)))
    notice(`The address asks for a design that is not on this map; there are ` +
      `${map.axes.map((axis) => axis.values.length).join(" x ")}.`);
  else if (words.has("design"))
    asked.index = index;
  if (words.get("time") && Number.isFinite(Number(words.get("time")))) asked.time = Number(words.get("time"));
  return asked;
}
