// What the explorer packed: base64 of deflate of bytes; quantities as differences of 16-bit counts.

export async function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Adds up along an axis what was packed as differences, modulo 2^16. */
function addUp(counts, shape, axis) {
  const step = shape.slice(axis + 1).reduce((a, b) => a * b, 1), length = shape[axis];
  for (let i = 0; i < counts.length; ++i)
    if (Math.floor(i / step) % length > 0) counts[i] += counts[i - step];
}

/** A field's values along all axes, NaN where there is none. */
export async function quantity(field, shape, differenced) {
  const bytes = await unpacked(field.data), n = shape.reduce((a, b) => a * b, 1);
  if (bytes.length !== 2 * n)
    throw new Error(`the field ${field.name} holds ${bytes.length / 2} values, the axes say ${n}`);
  const counts = new Uint16Array(n);
  for (let i = 0; i < n; ++i) counts[i] = bytes[i] | (bytes[n + i] << 8);
  for (const axis of differenced) addUp(counts, shape, axis);
  const values = new Float64Array(n);
  for (let i = 0; i < n; ++i) values[i] = counts[i] === 0 ? NaN : (counts[i] - 1 + field.first) * field.step;
  return values;
}

export async function codes(code, shape) {
  const bytes = await unpacked(code.data), n = shape.reduce((a, b) => a * b, 1);
  if (bytes.length !== n) throw new Error(`a code holds ${bytes.length} values, the axes say ${n}`);
  return bytes;
}

/** As many decimals as the steps of a field have. */
export function decimalsOf(step) { return Math.min(100, Math.max(0, Math.round(-Math.log10(step)))); }
