// The map as the explorer wrote it, unpacked.

import { codes, quantity } from "../solver/decode.js";
import { element } from "../dom.js";
import { wholeDrawing } from "../state/drawn.js";
import { scaleField } from "./scales.js";
import { rgbOf } from "../state/tones.js";

/** The map as the explorer wrote it, with its numbers unpacked. */
export async function readMap() {
  const map = JSON.parse(element("data").textContent);
  if (!Array.isArray(map.axes) || !Array.isArray(map.fields) || map.fields.length === 0)
    throw new Error("it holds no map");
  const shape = map.axes.map((a) => a.values.length);
  for (const field of map.fields) {
    field.values = await quantity(field, shape, map.differenced);
    field.table = Uint8Array.from(atob(field.colours), (c) => c.charCodeAt(0));
    let low = Infinity, high = -Infinity;
    for (const v of field.values)
      if (v === v && (!field.log || v > 0)) { low = Math.min(low, v); high = Math.max(high, v); }
    scaleField(field, low, high, field.levels);
  }
  map.drawing &&= wholeDrawing(map.drawing);
  for (const code of Object.values(map.codes)) code.values = await codes(code, shape);
  if (map.codes.status)
    map.codes.status.rgb = map.codes.status.shown.map(({ colour }) => rgbOf(colour));
  return map;
}
