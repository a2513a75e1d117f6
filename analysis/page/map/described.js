// What is said of a map: its quantities, its designs and where they lie.

import { option } from "../dom.js";
import { scaleOf, shapedBy } from "../state/drawn.js";
import { fieldLabel, inShownUnit, short, withUnit } from "../state/units.js";

/** Quantities by what they are of, as an option each, whose number is that of the quantity. */
/** @type {[string, (field: any) => boolean][]} */
const KINDS = [
  ["Jump", ({ name, made, gait }) => !made && !gait && !/^landing|^(slip|energy|dip)/.test(name)],
  ["Way and landing", ({ made, gait }) => !made && !gait], ["Gait: jump after jump", ({ gait }) => gait],
  ["Manufactured hoops", ({ made }) => made]];
export function offerGrouped(map, select) {
  const groups = KINDS.map(([label]) => Object.assign(document.createElement("optgroup"), { label }));
  map.fields.forEach((f, k) =>
    option(groups[KINDS.findIndex(([, has]) => has(f))], k, fieldLabel(f, scaleOf(map, f))));
  select.append(...groups.filter((group) => group.children.length > 0));
}
/** The option of a quantity, whatever group it is in. */
export const optionOf = (select, k) => select.querySelector(`option[value="${k}"]`);
/** A design's parameters that vary over the map: their rows, each with the value. */
const parametersAt = (map, index) =>
  (map.columns ? map.columns.filter((c) => c.name !== "design" && !c.quantity)
  .map((c) => [c, c.values[index[0]]]) : map.axes.map((axis, k) => [axis, axis.values[index[k]]]));
export const designAt = (map, index) => shapedBy(map,
  { ...map.fixed, ...Object.fromEntries(parametersAt(map, index).map(([row, value]) => [row.name, value])) });

/** How many designs further the next along each axis of a grid is. */
export const stridesOf = ({ axes }) =>
  axes.map((_, k) => axes.slice(k + 1).reduce((product, { values }) => product * values.length, 1));

export const placeText = (map, index) => (map.labels ? `${map.labels[index[0]]}: ` : "") +
  parametersAt(map, index).filter(([row]) => !map.columns || new Set(row.values).size > 1)
    .map(([row, value]) => `${row.symbol} ${withUnit(short(inShownUnit(row, value)), row.unit)}`).join(", ");

/** Quantities that only hoops that may slip have, or only those that never do. */
const OF_SLIPPING = ["slip_distance", "landing_spin", "energy_lost"], OF_STICKING = ["dip"];
export const applies = (map, { name }) => !(map.slips ? OF_STICKING : OF_SLIPPING).includes(name)
  && !(["jumps", "sequence_condition"].includes(name) && map.live && map.jumps === 1)
  && !(/^clears_/.test(name) && map.live && !(map.fixed.clear_height > 0));
