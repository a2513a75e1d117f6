// Questions to a map: only designs that reach every goal are shown in full, and the best of them is marked.

import { noteAddress } from "../state/address.js";
import { isOfFirstJump } from "../map/axes.js";
import { applies, stridesOf } from "../map/described.js";
import { element, notice, option, stepsOf } from "../dom.js";
import { scaleOf } from "../state/drawn.js";
import { jumping } from "../solver/made.js";
import { fieldLabel, shownIn } from "../state/units.js";

const LOWER_IS_BETTER = ["jump_time", "first_jump_time", "jump_distance", "energy_lost", "slip_distance",
  "candidates", "gait_energy_lost", "sequence_condition",
  "jump_time_mean", "jump_time_q05", "jump_time_q50", "jump_time_q95", "jump_time_sd", "jump_height_sd"];

/** How many steps along the axes each design is away from what one avoids: the nearest design that is `out`,
    or the nearest of `cliffs`, on either side. Infinity: there is neither. */
function stepsToCliffs(map, cliffs, out) {
  const lengths = map.axes.map(({ values }) => values.length), strides = stridesOf(map),
    steps = Float64Array.from(cliffs, (_, k) => (out(k) ? 0 : Infinity));
  const isAt = (k, axis, end) => Math.floor(k / strides[axis]) % lengths[axis] === end;
  cliffs.forEach((bits, k) => strides.forEach((stride, axis) => {
    if (bits >> axis & 1 && !isAt(k, axis, lengths[axis] - 1)) steps[k] = steps[k + stride] = 0;
  }));
  for (let k = 0; k < steps.length; ++k)
    strides.forEach((stride, axis) =>
      { if (!isAt(k, axis, 0)) steps[k] = Math.min(steps[k], steps[k - stride] + 1); });
  for (let k = steps.length - 1; k >= 0; --k)
    strides.forEach((stride, axis) =>
      { if (!isAt(k, axis, lengths[axis] - 1)) steps[k] = Math.min(steps[k], steps[k + stride] + 1); });
  return steps;
}

/** Builds the goals' part; changed(): another picture is due, best(index): the best design left is to be
    shown. */
export function filtersPart(map, view, changed, best) {
  const list = element("goals"), told = element("goals-told"), goals = [];  // bounds in the fields' own units
  const real = element("goal-real"), find = element("goal-best"), by = element("goal-by");
  by.querySelector("[value=steadiest]").hidden = !map.codes.cliffs || map.axes.length > 8;

  /** Where a quantity jumps; statistics and gaits have no discontinuities of their own on the map. */
  const cliffsOf = (field) => (isOfFirstJump(field) ? map.codes.cliffs.values
    : new Uint8Array(map.codes.cliffs.values.length));

  /** Whether a hoop as made can be asked to reach a goal of it: agility is none of the solver's, and some are
      of the other model. */
  const isOfHoop = (field) => !field.made && field.name !== "agility" && applies(map, field);
  /** Of a live map's yield the goals of a hoop are a part: it is shown whether the hoop as drawn reaches them
      or not. */
  const isInYield = () => map.live && view.view.field.name === "yield";

  function keeps(k) {
    if (real.checked && !isInYield() && map.codes.spurious_first_jump?.values[k] !== 0) return false;
    return goals.every(({ field, sign, bound }) => {
      if (isInYield() && isOfHoop(field)) return true;
      const v = field.values[k];
      return v === v && (sign === "most" ? v <= bound : v >= bound);
    });
  }

  function update() {
    const any = real.checked || goals.length > 0;
    map.keeps = any ? keeps : null;
    tell();
    changed();
    noteAddress();
  }

  // Of multipliers the least by size is the most stable.
  const isMultiplier = () => view.view.field.name === "gait_multiplier";
  const better = (a, b) =>
    (isMultiplier() ? Math.abs(a) < Math.abs(b) : LOWER_IS_BETTER.includes(view.view.field.name) ? a < b
    : a > b);

  function tell() {
    for (const { show } of goals) show();
    by.options[0].textContent = `the ${isMultiplier() ? "most stable" : better(0, 1) ? "best, the lowest"
      : "best, the highest"}`;
    if (!map.keeps) { told.textContent = ""; return; }
    const n = map.fields[0].values.length;
    let left = 0;
    for (let k = 0; k < n; ++k) if (keeps(k)) ++left;
    const inYield = isInYield() && (real.checked || goals.some(({ field }) => isOfHoop(field)))
      ? "; goals are part of the yield and do not dim designs" : "";
    const others = map.asked.made ? goals.filter(({ field }) => !field.made && !isOfHoop(field))
      .map(({ field }) => field.label.split(":")[0]) : [];
    const without = others.length > 0
      ? `; not a goal for manufactured hoops: ${[...new Set(others)].join(", ")}` : "";
    told.textContent = `${left.toLocaleString("en")} of ${n.toLocaleString("en")} designs ` +
      `remain${inYield}${without}`;
  }

  function drop(goal) {
    goals.splice(goals.indexOf(goal), 1);
    goal.item.remove();
  }

  function row(asked = {}) {
    const item = document.createElement("li"), select = document.createElement("select"),
      sign = document.createElement("select"), number = document.createElement("input"),
      away = document.createElement("button"),
      goal = { field: view.view.field, sign: "least", bound: NaN, show() {}, item: null, ...asked };
    map.fields.forEach((field, k) => option(select, k, ""));
    select.value = map.fields.indexOf(goal.field);
    const factor = () => shownIn(goal.field.unit, scaleOf(map, goal.field))[0];
    /** In the units shown, but for a number that is being typed. */
    goal.show = () => {
      map.fields.forEach((field, k) =>
        { select.options[k].textContent = fieldLabel(field, scaleOf(map, field)); });
      if (document.activeElement !== number)
        number.value = String(Number((goal.bound * factor()).toPrecision(6)));
    };
    option(sign, "least", "at least");
    option(sign, "most", "at most");
    number.type = "number";
    number.step = "any";
    if (Number.isNaN(goal.bound))
      goal.bound = Number((factor() * (goal.field.low + goal.field.high) / 2).toPrecision(2)) / factor();
    sign.value = goal.sign;
    away.type = "button";
    away.textContent = "×";
    select.setAttribute("aria-label", "goal: which quantity");
    sign.setAttribute("aria-label", "goal: which side");
    number.setAttribute("aria-label", "goal: bound");
    away.setAttribute("aria-label", "remove this goal");
    select.addEventListener("change", () => { goal.field = map.fields[select.value]; update(); });
    sign.addEventListener("change", () => { goal.sign = sign.value; update(); });
    stepsOf(number, () => factor() * (goal.field.high - goal.field.low || 1));
    number.addEventListener("input",
      () => { if (number.value !== "") { goal.bound = Number(number.value) / factor(); update(); } });
    away.addEventListener("click", () => { drop(goal); update(); });
    item.append(select, sign, number, away);
    list.append(item);
    goal.item = item;
    goals.push(goal);
  }
  element("goal-add").addEventListener("click", () => { row(); update(); });
  real.addEventListener("change", update);
  find.addEventListener("click", () => {
    const { values } = view.view.field, has = (k) => keeps(k) && values[k] === values[k],
      steps = by.value === "steadiest" ? stepsToCliffs(map, cliffsOf(view.view.field), (k) => !has(k)) : null;
    const beats = (a, b) =>
      (steps && steps[a] !== steps[b] ? steps[a] > steps[b] : by.value === "highest" ? values[a] > values[b]
      : by.value === "lowest" ? values[a] < values[b] : better(values[a], values[b]));
    let at = -1;
    for (let k = 0; k < values.length; ++k) if (has(k) && (at < 0 || beats(k, at))) at = k;
    if (at < 0) { told.textContent = "no design solved on this map reaches every goal"; return; }
    const index = [];
    for (let k = map.axes.length - 1, rest = at; k >= 0; --k) { const length = map.axes[k].values.length;
        index[k] = rest % length; rest = Math.floor(rest / length); }
    best(index);
  });
  return {
    tell,
    /** What a hoop as made is to reach; to jump, too, as some goals are reached without. */
    ofHoops() {
      const all = [...goals.filter(({ field, bound }) => isOfHoop(field) && Number.isFinite(bound))
        .map(({ field, sign, bound }) =>
        ({ field: field.name, least: sign === "least" ? bound : null, most: sign === "most" ? bound
        : null })),
        ...(real.checked ? [{ field: "spurious_first_jump", least: 0, most: 0 }] : [])];
      return all.length > 0 ? [...all, jumping(map)] : [];
    },
    fields: () => goals.map(({ field }) => field),
    /** The goals of a quantity as [least, most]; infinite where there is none. */
    range(wanted) {
      const bounds = (side) => goals.filter(({ field, sign }) => field === wanted && sign === side)
        .map(({ bound }) => bound);
      return [Math.max(...bounds("least")), Math.min(...bounds("most"))];
    },
    /** Makes those the goals of a quantity, in round numbers; an infinite one is none. */
    setRange(field, least, most) {
      goals.filter((each) => each.field === field).forEach(drop);
      const [factor] = shownIn(field.unit, scaleOf(map, field)),
        step = 10 ** (Math.floor(Math.log10(factor * (field.high - field.low) || 1)) - 2);
      for (const [sign, bound] of [["least", least], ["most", most]])
        if (Number.isFinite(bound))
          row({ field, sign,
            bound: Number((Math.round(bound * factor / step) * step).toPrecision(6)) / factor });
      element("filters").open = true;
      update();
    },
    write(words) {
      for (const { field, sign, bound } of goals)
        words.append("goal", `${field.name}:${sign}:${Number(bound.toPrecision(12))}`);
      if (real.checked) words.set("real", "");
    },
    read(words) {
      goals.length = 0;
      list.replaceChildren();
      real.checked = words.has("real");
      const unknown = [];
      for (const [name, sign, bound] of words.getAll("goal").map((text) => text.split(":"))) {
        const field = map.fields.find((each) => each.name === name);
        if (field && ["least", "most"].includes(sign) && bound !== "" && Number.isFinite(Number(bound)))
          row({ field, sign, bound: Number(bound) });
        else unknown.push(name);
      }
      if (unknown.length > 0)
        notice(`The address asks for goals that this map cannot have; it leaves them out: ` +
          `${unknown.join(", ")}`);
      if (goals.length > 0 || real.checked) element("filters").open = true;
      update();
    },
  };
}
