// Isolines by marching squares over the centres of cells.

/**
 * Chains of points, [x, y, x, y, ...], where plane(i, j) equals level. Squares with a missing corner, and those that
 * `torn(i, j)` says a cliff runs through, have none.
 */
function isolines(plane, nx, ny, level, px, py, torn) {
  const segments = [];
  for (let j = 0; j + 1 < ny; ++j)
    for (let i = 0; i + 1 < nx; ++i) {
      const a = plane(i, j) - level, b = plane(i + 1, j) - level, c = plane(i + 1, j + 1) - level, d = plane(i, j + 1) - level;
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
        segments.push(together ? [sides[0], sides[1]] : [sides[0], sides[3]], together ? [sides[2], sides[3]] : [sides[1], sides[2]]);
      }
    }
  return chained(segments);
}

function chained(segments) {
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
    const [p, q] = segments[i];
    const forth = follow(i, p.key);
    const other = ends.get(p.key).find((s) => !used[s]);
    const back = other === undefined ? [] : follow(other, p.key);
    const reversed = [];
    for (let k = back.length - 2; k >= 0; k -= 2) reversed.push(back[k], back[k + 1]);
    chains.push([...reversed, p.x, p.y, ...forth]);
  }
  return chains;
}
