// From values to places and colours.

/** An axis of the map on the screen: its cells are around its values, halfway to the neighbours. */
function axisScale(axis, from, to) {
  const degrees = axis.unit === "°" ? 180 / Math.PI : 1;
  const shown = axis.values.map((v) => v * degrees);
  const at = axis.log ? Math.log : (v) => v;
  const places = shown.map(at), n = places.length;
  const edges = new Array(n + 1);
  for (let i = 1; i < n; ++i) edges[i] = (places[i - 1] + places[i]) / 2;
  edges[0] = n > 1 ? places[0] - (edges[1] - places[0]) : places[0] - 0.5;
  edges[n] = n > 1 ? places[n - 1] + (places[n - 1] - edges[n - 1]) : places[0] + 0.5;
  const factor = (to - from) / (edges[n] - edges[0]);
  const pixel = (value) => from + (at(value) - edges[0]) * factor;
  return {
    shown, n,
    pixel,
    /** What is drawn at a pixel. */
    value(p) {
      const place = edges[0] + (p - from) / factor;
      return axis.log ? Math.exp(place) : place;
    },
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

function linearTicks(low, high, most = 7) {
  if (!(high > low)) return [low];
  let step = 10 ** Math.floor(Math.log10((high - low) / most));
  for (const factor of [1, 2, 5, 10]) if ((high - low) / (step * factor) <= most) { step *= factor; break; }
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(Number((k * step).toPrecision(12)));
  return ticks;
}

function logTicks(low, high) {
  const ticks = [], dense = Math.log10(high / low) < 4;
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e)
    for (const m of dense ? [1, 2, 5] : [1]) {
      const tick = Number((m * 10 ** e).toPrecision(12));
      if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9)) ticks.push(tick);
    }
  return ticks;
}

/** Where a value lies on a field's colour scale, from 0 to 1. */
function colourScale(field, low, high) {
  if (field.log) {
    const bottom = Math.log(low), span = Math.log(high / low) || 1;
    return (v) => Math.min(1, Math.max(0, (Math.log(Math.max(v, low)) - bottom) / span));
  }
  const span = high - low || 1;
  return (v) => Math.min(1, Math.max(0, (v - low) / span)) ** field.exponent;
}

/** Numbers as people read them: four digits, no needless zeros. */
function short(value, digits = 4) {
  if (!Number.isFinite(value)) return "none";
  return String(Number(value.toPrecision(digits)));
}
