// From values to places and colours.

import { perUnit, short, shownIn } from "../state/units.js";

/** A colour with a third of its chroma, for what is there but is not what one looks for. */
export function muted(rgb) {
  const grey = 0.299 * rgb[0] + 0.587 * rgb[1] + 0.114 * rgb[2];
  return rgb.map((v) => Math.round(grey + 0.33 * (v - grey)));
}

/** An axis of the map on the screen: its cells are around its values, halfway to the neighbours. */
export function axisScale(axis, from, to) {
  const shown = axis.values.map((v) => v * perUnit(axis.unit));
  const at = axis.log ? Math.log : (v) => v;
  let places = shown.map(at);
  const n = places.length;
  const edgesOf = (centres) => {
    const edges = new Array(n + 1);
    for (let i = 1; i < n; ++i) edges[i] = (centres[i - 1] + centres[i]) / 2;
    edges[0] = n > 1 ? centres[0] - (edges[1] - centres[0]) : centres[0] - 0.5;
    edges[n] = n > 1 ? centres[n - 1] + (centres[n - 1] - edges[n - 1]) : centres[0] + 0.5;
    return edges;
  };
  let edges = edgesOf(places);
  // Values so near each other, or so large, that no double lies between them or beside them: cells of one
  // width.
  if (!edges.every((edge, i) => Number.isFinite(edge) && (i === 0 || edge > edges[i - 1]))) {
    places = shown.map((_, i) => i);
    edges = edgesOf(places);
    const at = (value) => Math.max(0, shown.findLastIndex((v) => v <= value));
    return axisOfPlaces(axis, shown, places, edges, at, (place) =>
      shown[Math.min(n - 1, Math.max(0, Math.round(place)))], from, to);
  }
  return axisOfPlaces(axis, shown, places, edges, at, axis.log ? Math.exp : (place) => place, from, to);
}

/** at: a value's place; back: the value at a place. */
function axisOfPlaces(axis, shown, places, edges, at, back, from, to) {
  const n = places.length;
  const factor = (to - from) / (edges[n] - edges[0]);
  const pixel = (value) => from + (at(value) - edges[0]) * factor;
  return {
    shown, n,
    pixel,
    /** What is drawn at a pixel. */
    value: (p) => back(edges[0] + (p - from) / factor),
    centre: (i) => from + (places[i] - edges[0]) * factor,
    edge: (i) => from + (edges[i] - edges[0]) * factor,
    /** The cell at a pixel, -1 outside. */
    index(p) {
      const place = edges[0] + (p - from) / factor;
      if (!(place >= edges[0] && place <= edges[n])) return -1;
      let low = 0, high = n - 1;
      while (low < high) {
        const middle = (low + high) >> 1;
        if (place < edges[middle + 1]) high = middle; else low = middle + 1;
      }
      return low;
    },
    ticks: () => (axis.log ? logTicks(shown[0], shown[n - 1]) : linearTicks(shown[0], shown[n - 1])),
  };
}

/**
 * Round numbers from low to high, about `most` of them, each once. Where the two are so near each other, or
 * so far apart, that no double is the round number, the two themselves.
 */
export function linearTicks(low, high, most = 7) {
  if (!(high > low)) return [low];
  const wanted = high / most - low / most;  // so that nothing overflows
  if (!(wanted > 0 && wanted < Infinity)) return [low, high];
  const exponent = Math.floor(Math.log10(wanted));
  const factor = [1, 2, 5, 10, 20].find((f) => Number(`${f}e${exponent}`) >= wanted * (1 - 1e-12));
  const step = Number(`${factor}e${exponent}`), first = Math.ceil(low / step - 1e-9), ticks = [];
  if (!(Math.max(Math.abs(low), Math.abs(high)) / step * factor < 2 ** 53)) return [low, high];
  for (let k = first; k <= first + most + 2; ++k) {
    const tick = Number(`${k * factor}e${exponent}`);  // the double next to the decimal number
    if (tick > high + 1e-9 * step) break;
    if (tick >= low - 1e-9 * step && !(tick <= ticks.at(-1))) ticks.push(tick);
  }
  return ticks.length > 0 ? ticks : [low, high];
}

/** Powers of ten from low to high; where there are few, twice and five times those as well; where there are
    none, round numbers. */
export function logTicks(low, high, most = 12) {
  const from = Math.floor(Math.log10(low)), to = Math.ceil(Math.log10(high)),
    every = Math.ceil((to - from) / most), ticks = [];
  for (let e = Math.ceil(from / every) * every; e <= to; e += every)
    for (const m of to - from <= 5 ? [1, 2, 5] : [1]) {
      const tick = Number(`${m}e${e}`);
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9) && tick > 0 && tick < Infinity)
        ticks.push(tick);
    }
  return ticks.length > 1 ? ticks : linearTicks(low, high);
}

/** Texts of ticks: as few digits as keep them apart, powers of ten where plain numbers would be long. */
export function tickTexts(ticks) {
  const raised = (text) => [...text].map((c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻").join("");
  const text = (v, digits) => {
    if (v === 0 || (Math.abs(v) >= 1e-4 && Math.abs(v) < 1e5)) return String(Number(v.toPrecision(digits)));
    const [mantissa, exponent] = v.toExponential(digits - 1).split("e"),
      least = mantissa.replace(/\.?0+$/, "");
    const times = least === "1" ? "" : least === "-1" ? "-" : `${least}·`;
    return `${times}10${raised(exponent.replace("+", ""))}`;
  };
  for (let digits = 4; digits < 17; ++digits) {
    const texts = ticks.map((v) => text(v, digits));
    if (new Set(texts).size === ticks.length) return texts;
  }
  return ticks.map((v) => text(v, 17));
}

/** Where a value lies on a field's colour scale, from 0 to 1. */
export function colourScale(field, low, high) {
  if (field.log) {
    const bottom = Math.log(low), span = Math.log(high / low) || 1;
    return (v) => Math.min(1, Math.max(0, (Math.log(Math.max(v, low)) - bottom) / span));
  }
  const span = high - low || 1;
  return (v) => Math.min(1, Math.max(0, (v - low) / span)) ** field.exponent;
}

/** A field's isolines, round numbers in the units shown: [{value, text}], value in the field's own. */
export function shownLevels(field, scene) {
  const [factor] = shownIn(field.unit, scene), told = (value) =>
    ({ value: value / factor, text: short(value) });
  if (factor === 1 || field.levels.length === 0) return field.levels.map(told);
  const [low, high] = [field.low * factor, field.high * factor];
  return (field.log ? logTicks(low, high) : linearTicks(low, high, 12)).map(told);
}

/** The value at a place on a field's colour scale, from 0 to 1. */
export const valueOnScale = ({ log, exponent, low, high }, place) =>
  (log ? low * (high / low) ** place : low + (high - low) * place ** (1 / exponent));

/** Sets a field's colours and isolines for values from low to high. A few extreme designs do not set the
    scale: isolines that are given do. */
export function scaleField(field, low, high, levels) {
  const most = high, given = levels.filter((l) => l >= low && l <= high);
  if (field.log && given.length > 2) low = Math.max(low, given[0]);
  if (!field.log && given.length > 2)
    [low, high] = [Math.max(low, Math.min(given[0], low + 0.02 * (high - low))),
      Math.min(high, levels.find((l) => l >= high) ?? levels.at(-1))];
  Object.assign(field, { low, high, most, levels });
  field.place = colourScale(field, low, high);
}
