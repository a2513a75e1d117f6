// What the pixels of a plane show where cliffs run through its cells: as analysis/cliffs.py draws them in
// charts.

/** Where pixels lie among the designs along an axis: the design before each, and how far on it is, from 0 to
    1. */
function between(scale, first, count) {
  const before = new Int32Array(count), share = new Float64Array(count), last = Math.max(0, scale.n - 2);
  const rising = scale.n < 2 || scale.centre(1) > scale.centre(0);
  for (let p = 0, i = rising ? 0 : last; p < count; ++p) {
    const at = first + p + 0.5;
    if (rising) while (i < last && scale.centre(i + 1) <= at) ++i;
    else while (i > 0 && scale.centre(i) <= at) --i;
    before[p] = i;
    if (scale.n > 1) share[p] =
        Math.min(1, Math.max(0, (at - scale.centre(i)) / (scale.centre(i + 1) - scale.centre(i))));
  }
  return { before, share };
}

/** On which side of the line from a to b the point c lies. */
const sideOf = (ax, ay, bx, by, cx, cy) => (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);

/** Whether the way from p to q crosses a segment. */
const crosses = (px, py, qx, qy, [x1, y1, x2, y2]) =>
  sideOf(x1, y1, x2, y2, px, py) * sideOf(x1, y1, x2, y2, qx, qy) < 0
    && sideOf(px, py, qx, qy, x1, y1) * sideOf(px, py, qx, qy, x2, y2) <= 0;

/** How far a point is from a segment. */
function distance(px, py, [x1, y1, x2, y2]) {
  const length2 = Math.max((x2 - x1) ** 2 + (y2 - y1) ** 2, 1e-300);
  const t = Math.min(1, Math.max(0, ((px - x1) * (x2 - x1) + (py - y1) * (y2 - y1)) / length2));
  return Math.hypot(px - x1 - t * (x2 - x1), py - y1 - t * (y2 - y1));
}

/**
 * Between designs values are linear, within the curves that go through a cell: a pixel takes part in what
 * those corners of its cell have that no curve hides from it. chains: curves as pixels [x, y, x, y, ...].
 * offset(i, j) is a design's place among the values. Returns, pixel by pixel: value (NaN where the design it
 * shows has none), design (whose codes it shares), torn (1: a curve is near).
 */
export function crispPlane(values, offset, sx, sy, { x0, y0, w, h }, chains) {
  const u = between(sx, x0, w), v = between(sy, y0, h), cells = new Map();
  const cellOf = (place, first, at) =>
    place.before[Math.min(place.before.length - 1, Math.max(0, Math.floor(at - first)))];
  for (const chain of chains)
    for (let k = 2; k < chain.length; k += 2) {
      const segment = [chain[k - 2], chain[k - 1], chain[k], chain[k + 1]];
      const key = cellOf(v, y0, (segment[1] + segment[3]) / 2) * sx.n
        + cellOf(u, x0, (segment[0] + segment[2]) / 2);
      if (!cells.has(key)) cells.set(key, []);
      cells.get(key).push(segment);
    }
  const value = new Float64Array(w * h), design = new Int32Array(w * h), torn = new Uint8Array(w * h);
  const right = Math.min(1, sx.n - 1), below = Math.min(1, sy.n - 1), shares = [0, 0, 0, 0],
    at = [0, 0, 0, 0], corners = [0, 0, 0, 0];
  for (let q = 0; q < h; ++q) {
    const j = v.before[q], fv = v.share[q], y = y0 + q + 0.5;
    let cell = -1, segments;
    for (let p = 0; p < w; ++p) {
      const i = u.before[p], fu = u.share[p], x = x0 + p + 0.5, pixel = q * w + p;
      if (i !== cell) {
        cell = i;
        segments = cells.get(j * sx.n + i);
        for (let k = 0; k < 4; ++k) {
          at[k] = offset(i + (k & 1) * right, j + (k >> 1) * below);
          corners[k] = values[at[k]];
        }
      }
      shares[0] = (1 - fu) * (1 - fv), shares[1] = fu * (1 - fv), shares[2] = (1 - fu) * fv,
        shares[3] = fu * fv;
      const whole = shares[0] * corners[0] + shares[1] * corners[1] + shares[2] * corners[2]
        + shares[3] * corners[3];
      if (segments === undefined && whole === whole) {  // as nearly everywhere
        value[pixel] = whole;
        design[pixel] = at[(fu > 0.5 ? 1 : 0) + (fv > 0.5 ? 2 : 0)];
        continue;
      }
      if (segments !== undefined) {
        for (let k = 0; k < 4; ++k) {
          const cx = sx.centre(i + (k & 1) * right), cy = sy.centre(j + (k >> 1) * below);
          // A corner on the cell's other side counts where it is all there is to see.
          shares[k] = segments.some((segment) => crosses(x, y, cx, cy, segment)) ? 0
            : Math.max(shares[k], 1e-9);
        }
        torn[pixel] = segments.some((segment) => distance(x, y, segment) < 1.5) ? 1 : 0;
      }
      let most = 0, total = 0, sum = 0;
      for (let k = 0; k < 4; ++k) {
        if (shares[k] > shares[most]) most = k;
        const corner = corners[k];
        if (corner === corner && shares[k] > 0) { total += shares[k]; sum += shares[k] * corner; }
      }
      design[pixel] = at[most];
      value[pixel] = corners[most] === corners[most] ? sum / total : NaN;
    }
  }
  return { value, design, torn };
}
