// Isolines by marching squares over the centres of cells.

const BLOCK = 16;  // squares a side

/** A plane's values at(i, j), with the least and the largest of each block of squares, by which isolines pass
    over most of it. */
export function planeOf(at, nx, ny) {
  const values = new Float64Array(nx * ny), across = Math.ceil((nx - 1) / BLOCK),
    up = Math.ceil((ny - 1) / BLOCK);
  const low = new Float64Array(across * up).fill(Infinity), high = new Float64Array(across * up)
    .fill(-Infinity);
  // a corner may be of two
  const blocks = (i, count) =>
    [Math.max(0, Math.floor((i - 1) / BLOCK)), Math.min(count - 1, Math.floor(i / BLOCK))];
  for (let j = 0; j < ny; ++j)
    for (let i = 0; i < nx; ++i) {
      const v = values[j * nx + i] = at(i, j);
      if (v !== v) continue;
      const [left, right] = blocks(i, across), [below, above] = blocks(j, up);
      for (let q = below; q <= above; ++q)
        for (let p = left; p <= right; ++p) {
          const block = q * across + p;
          if (v < low[block]) low[block] = v;
          if (v > high[block]) high[block] = v;
        }
    }
  return { values, nx, ny, across, low, high };
}

/**
 * Chains of points, [x, y, x, y, ...], where a plane equals level. Squares with a missing corner, and those
 * that `torn(i, j)` says a cliff runs through, have none.
 */
export function isolines(plane, level, px, py, torn) {
  const segments = [];
  for (let block = 0; block < plane.low.length; ++block)
    if (plane.low[block] <= level && level <= plane.high[block])
      blockLines(plane, block, level, px, py, torn, segments);
  return chained(segments);
}

function blockLines({ values, nx, ny, across }, block, level, px, py, torn, segments) {
  const i0 = BLOCK * (block % across), j0 = BLOCK * Math.floor(block / across);
  for (let j = j0; j < Math.min(ny - 1, j0 + BLOCK); ++j)
    for (let i = i0; i < Math.min(nx - 1, i0 + BLOCK); ++i) {
      const at = j * nx + i, a = values[at] - level, b = values[at + 1] - level,
        c = values[at + nx + 1] - level, d = values[at + nx] - level;
      if (!(a - a + b - b + c - c + d - d === 0) || torn(i, j)) continue;
      if (a > 0 === b > 0 && b > 0 === c > 0 && c > 0 === d > 0) continue;
      const sides = [];  // crossings in order around the square: bottom, right, top, left
      const cross = (u, v, key, x0, y0, x1, y1) => {
        if (u > 0 === v > 0) return;
        const t = u / (u - v);
        sides.push({ key, x: x0 + (x1 - x0) * t, y: y0 + (y1 - y0) * t });
      };
      cross(a, b, `h${i},${j}`, px(i), py(j), px(i + 1), py(j));
      cross(b, c, `v${i + 1},${j}`, px(i + 1), py(j), px(i + 1), py(j + 1));
      cross(d, c, `h${i},${j + 1}`, px(i), py(j + 1), px(i + 1), py(j + 1));
      cross(a, d, `v${i},${j}`, px(i), py(j), px(i), py(j + 1));
      if (sides.length === 2) segments.push([sides[0], sides[1]]);
      if (sides.length === 4) {  // a saddle: its middle tells which corners belong together
        const together = a + b + c + d > 0 === a > 0;
        segments.push(together ? [sides[0], sides[1]] : [sides[0], sides[3]], together ? [sides[2], sides[3]]
          : [sides[1], sides[2]]);
      }
    }
}

export function chained(segments) {
  const ends = new Map();
  const note = (key, s) => { if (!ends.has(key)) ends.set(key, []); ends.get(key).push(s); };
  segments.forEach((s, i) => { note(s[0].key, i); note(s[1].key, i); });
  const used = new Uint8Array(segments.length), chains = [];
  const follow = (start, key) => {
    const points = [];
    for (let next = start; next !== undefined;) {
      used[next] = 1;
      const [p, q] = segments[next], ahead = p.key === key ? q : p;
      points.push(ahead.x, ahead.y);
      key = ahead.key;
      next = ends.get(key).find((s) => !used[s]);
    }
    return points;
  };
  for (let i = 0; i < segments.length; ++i) {
    if (used[i]) continue;
    const [p] = segments[i];
    const forth = follow(i, p.key);
    const other = ends.get(p.key).find((s) => !used[s]);
    const back = other === undefined ? [] : follow(other, p.key);
    const reversed = [];
    for (let k = back.length - 2; k >= 0; k -= 2) reversed.push(back[k], back[k + 1]);
    chains.push([...reversed, p.x, p.y, ...forth]);
  }
  return chains;
}
