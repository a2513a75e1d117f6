// Cliffs of a live map: where what becomes of a hoop changes between two neighbours, bisected and joined to curves.

/** Pairs of neighbours with different outcomes: {key, i, j, along} each; along: 0 to the right, 1 up. */
function cliffEdges(map) {
  const [nx, ny] = LIVE_SHAPE, { values } = map.codes.cliffs, edges = [];
  for (let i = 0; i < nx; ++i)
    for (let j = 0; j < ny; ++j)
      for (const along of [0, 1]) if (values[i * ny + j] >> along & 1) edges.push({ key: `${along}:${i},${j}`, i, j, along, part: 0.5 });
  return edges;
}

/** The ends of edges for the solver: [x, y, x, y] each. */
function edgeEnds(map, edges) {
  const [x, y] = map.axes.map((axis) => axis.values), ends = new Float64Array(4 * edges.length);
  edges.forEach(({ i, j, along }, k) => ends.set([x[i], y[j], x[along === 0 ? i + 1 : i], y[along === 1 ? j + 1 : j]], 4 * k));
  return ends;
}

/**
 * Curves through edges whose `part` tells how far along the outcome changes: straight from edge to edge of the square between four designs,
 * or to the middle where more than two of its sides are cut. As the explorer writes curves.
 */
function cliffCurves(map, edges) {
  const [nx, ny] = LIVE_SHAPE, cut = new Map(edges.map((edge) => [edge.key, edge])), segments = [];
  const point = ({ key, i, j, along, part }) => ({ key, x: i + (along === 0 ? part : 0), y: j + (along === 1 ? part : 0) });
  for (let i = 0; i + 1 < nx; ++i)
    for (let j = 0; j + 1 < ny; ++j) {
      const sides = [`0:${i},${j}`, `1:${i + 1},${j}`, `0:${i},${j + 1}`, `1:${i},${j}`].filter((key) => cut.has(key)).map((key) => point(cut.get(key)));
      if (sides.length === 2) segments.push(sides);
      if (sides.length > 2) {
        const mean = (name) => sides.reduce((sum, side) => sum + side[name], 0) / sides.length, middle = { key: `m${i},${j}`, x: mean("x"), y: mean("y") };
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
