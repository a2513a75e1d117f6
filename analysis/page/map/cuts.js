// Cuts through the design pointed at: the quantity shown along both axes of the map, broken at cliffs, dashed
// where the first lift-off is below the threshold.

import { fitted, isOfFirstJump, labelOf, paintAxes } from "./axes.js";
import { element } from "../dom.js";
import { scaleOf } from "../state/drawn.js";
import { saveButtons } from "../export/export.js";
import { axisScale, linearTicks } from "./scales.js";
import { tones } from "../state/tones.js";
import { fieldLabel, shownIn } from "../state/units.js";

/** Draws one cut. offset(index): a design's place among the values; axis: along which. */
function drawCut(canvas, map, view, axis, offset) {
  const frame = fitted(canvas, 1), [factor] = shownIn(view.field.unit, scaleOf(map, view.field));
  if (!frame) return;
  const context = canvas.getContext("2d"), { left, right, top, bottom, ratio } = frame, { field } = view,
    row = map.axes[axis];
  const own = isOfFirstJump(field), flags = own ? map.codes.spurious_first_jump?.values : undefined,
    torn = own ? map.codes.cliffs?.values : undefined, n = row.values.length;
  const places = Array.from({ length: n }, (_, i) => offset(view.index.map((k, a) => (a === axis ? i : k))));
  const sx = axisScale(row, left, right), span = field.high - field.low || 1,
    low = Math.min(field.low, ...places.map((k) => field.values[k]).filter((v) => v === v)),
    high = Math.max(field.low + 1e-12, ...places.map((k) => field.values[k]).filter((v) => v === v))
      + 0.04 * span;
  const sy = { pixel: (v) => bottom - (bottom - top) * (v - low) / (high - low || 1), ticks: () =>
    linearTicks(low * factor, high * factor, 4) }, shownY = { ...sy, pixel: (v) => sy.pixel(v / factor) };
  context.fillStyle = tones.ground;
  context.fillRect(0, 0, canvas.width, canvas.height);
  context.lineWidth = 1.8 * ratio;
  context.strokeStyle = tones.data;
  for (const spurious of [false, true]) {
    context.setLineDash(spurious ? [5 * ratio, 3 * ratio] : []);
    context.beginPath();
    let drawing = false;
    places.forEach((k, i) => {
      const v = field.values[k], here = v === v && (flags?.[k] === 1) === spurious, x = sx.centre(i);
      if (!here) { drawing = false; return; }
      if (drawing) context.lineTo(x, sy.pixel(v));
      else { context.moveTo(x - ratio, sy.pixel(v)); context.lineTo(x, sy.pixel(v)); }
      drawing = !(torn && (torn[k] >> axis & 1));
    });
    context.stroke();
  }
  context.setLineDash([]);
  paintAxes(context, frame, sx, shownY, labelOf(row),
    fieldLabel(field, scaleOf(map, field), field.label.split(":")[0].split(" of the ")[0]));
  const here = sx.centre(view.index[axis]), value = field.values[places[view.index[axis]]];
  context.strokeStyle = tones.mark;
  context.lineWidth = 1.2 * ratio;
  context.beginPath();
  context.moveTo(here, top);
  context.lineTo(here, bottom);
  context.stroke();
  if (value === value) {
    context.beginPath();
    context.arc(here, sy.pixel(value), 4 * ratio, 0, 2 * Math.PI);
    context.fillStyle = tones.mark;
    context.fill();
  }
  canvas.dataset.values = places.filter((k) => field.values[k] === field.values[k]).length;
}

/** Returns draw(), for whenever something else is pointed at or shown. */
export function cutsPart(map, view) {
  const part = element("cuts"), canvases = [element("cut-x"), element("cut-y")];
  const draw = () => { if (part.open)
    [view.view.x, view.view.y].forEach((axis, k) => drawCut(canvases[k], map, view.view, axis, view.offset));
    };
  part.addEventListener("toggle", draw);
  for (const [k, name] of ["cut-x", "cut-y"].entries())
    saveButtons(name, canvases[k],
      () => `${view.view.field.name}_over_${map.axes[[view.view.x, view.view.y][k]].name}`,
      (like) => drawCut(like, map, view.view, [view.view.x, view.view.y][k], view.offset));
  new ResizeObserver(draw).observe(canvases[0]);
  return draw;
}
