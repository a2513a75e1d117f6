// A thread of the page: solves the designs that it is sent, as drawn and as made, and finds where outcomes
// change between two.

import { solverOf } from "./solver.js";

let solver = null;

/**
 * How far along from the first end of each edge to the second its outcome changes, halved `steps` times: ends
 * as [x, y, x, y] each, begins as the codes that the first end has, codes as [name, what stands where there
 * is none].
 */
function bisected({ design, slips, tolerance, first, second, ends, begins, codes, steps }) {
  const count = ends.length / 4, wide = solver.rowNames.length, parts = new Float64Array(count).fill(0.5),
    places = new Float64Array(2 * count);
  const columns = codes.map(([name, none]) => [solver.rowNames.indexOf(name), none]);
  for (let step = 0.25, n = 0; n < steps; step /= 2, ++n) {
    for (let k = 0; k < count; ++k)
      for (const c of [0, 1])
        places[2 * k + c] = ends[4 * k + c] + (ends[4 * k + 2 + c] - ends[4 * k + c]) * parts[k];
    const rows = solver.solvePlaces(design, slips, tolerance, first, second, places);
    const isAsBegun = (k) =>
      columns.every(([column, none], c) =>
      { const v = rows[k * wide + column]; return (v === v ? v : none) === begins[k * columns.length + c]; });
    for (let k = 0; k < count; ++k) parts[k] += isAsBegun(k) ? step : -step;
  }
  return parts;
}

const solvedAsMade = ({ design, slips, tolerance, first, second, places, made }) =>
  solver.solveMade(design, slips, tolerance, first, second, places, made);

/** What is asked of designs, row by row: as drawn, and behind that as made. */
function solvedAsAsked(order) {
  const { made } = order.asked,
    drawn = solver.solvePlaces(order.design, order.slips, order.tolerance, order.first, order.second,
    order.places, order.asked);
  if (!made) return drawn;
  const asMade = solvedAsMade({ ...order, made }), wide = solver.rowNames.length, more = made.fields.length,
    rows = new Float64Array(drawn.length + asMade.length);
  for (let i = 0; i * wide < drawn.length; ++i) {
    rows.set(drawn.subarray(i * wide, (i + 1) * wide), i * (wide + more));
    rows.set(asMade.subarray(i * more, (i + 1) * more), i * (wide + more) + wide);
  }
  return rows;
}

onmessage = async ({ data }) => {
  try {
    if (data.module) {
      solver = await solverOf(data.module);
      postMessage({ ready: true });
      return;
    }
    const rows = data.ends ? bisected(data) : data.asked ? solvedAsAsked(data) : solvedAsMade(data);
    postMessage({ generation: data.generation, rows }, { transfer: [rows.buffer] });
  } catch (error) {  // of an async function onerror hears nothing
    postMessage({ error: String(error.message ?? error), generation: data.generation });
  }
};
