// Cliffs of a live map: where what becomes of a hoop changes between two neighbours, bisected and joined to
// curves.

import { chained } from "../map/isolines.js";

/** Pairs of neighbours among every `side`-th design with different outcomes: {key, i, j, along} each; along:
    0 to the right, 1 up. */
export function cliffEdges(map, side) {
  const [nx, ny] = LIVE_SHAPE, differ = outcomesDiffer(map), edges = [];
  for (let i = 0; i < nx; i += side)
    for (let j = 0; j < ny; j += side) {
      if (i + side < nx && differ(i * ny + j, (i + side) * ny + j))
        edges.push({ key: `0:${i},${j}`, i, j, along: 0, side, part: 0.5 });
      if (j + side < ny && differ(i * ny + j, i * ny + j + side))
        edges.push({ key: `1:${i},${j}`, i, j, along: 1, side, part: 0.5 });
    }
  return edges;
}

/** The ends of edges for the solver: [x, y, x, y] each. x, y: the values along the axes. */
export function edgeEnds(x, y, edges) {
  const ends = new Float64Array(4 * edges.length);
  edges.forEach(({ i, j, along, side }, k) =>
    ends.set([x[i], y[j], x[along === 0 ? i + side : i], y[along === 1 ? j + side : j]], 4 * k));
  return ends;
}

/** What becomes of the first end's hoop: code by code of each. */
export function edgeBegins(map, edges) {
  return Float64Array.from(edges.flatMap(({ i, j }) =>
    OUTCOME_CODES.map(([name]) => map.codes[name].values[i * LIVE_SHAPE[1] + j])));
}

/**
 * Curves through edges whose `part` tells how far along the outcome changes: straight from edge to edge of
 * the square between four designs, or to the middle where more than two of its sides are cut. As the explorer
 * writes curves.
 */
export function cliffCurves(map, edges, side) {
  const [nx, ny] = LIVE_SHAPE, cut = new Map(edges.map((edge) => [edge.key, edge])), segments = [];
  const point = ({ key, i, j, along, part }) =>
    ({ key, x: i + (along === 0 ? part * side : 0), y: j + (along === 1 ? part * side : 0) });
  for (let i = 0; i + side < nx; i += side)
    for (let j = 0; j + side < ny; j += side) {
      const sides = [`0:${i},${j}`, `1:${i + side},${j}`, `0:${i},${j + side}`, `1:${i},${j}`].filter((key) =>
        cut.has(key)).map((key) => point(cut.get(key)));
      if (sides.length === 2) segments.push(sides);
      if (sides.length > 2) {
        const mean = (name) => sides.reduce((sum, side) => sum + side[name], 0) / sides.length,
          middle = { key: `m${i},${j}`, x: mean("x"), y: mean("y") };
        for (const side of sides) segments.push([side, middle]);
      }
    }
  const valueAt = (values, place) => values[0] + (values.at(-1) - values[0]) * place / (values.length - 1);
  return chained(segments).map((chain) => ({
    kind: "outcome", axes: [0, 1], at: {},
    x: chain.filter((_, k) => k % 2 === 0).map((place) => valueAt(map.axes[0].values, place)),
    y: chain.filter((_, k) => k % 2 === 1).map((place) => valueAt(map.axes[1].values, place)),
  }));
}

export const LIVE_SHAPE = [200, 150];
/** What tells one course of events from another, each with what stands where there is none. */
export const OUTCOME_CODES = [["status", 0], ["spurious_first_jump", 255], ["candidates", 0]];

/** Whether two designs, by their places among the values, end by another course of events. */
export function outcomesDiffer({ codes: { status, spurious_first_jump: spurious, candidates } }) {
  return (a, b) => status.values[a] !== status.values[b] || spurious.values[a] !== spurious.values[b]
    || candidates.values[a] !== candidates.values[b];
}
