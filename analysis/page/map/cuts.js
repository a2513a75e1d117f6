// Cuts through the design pointed at: the quantity shown along both axes of the map, broken at cliffs, dashed
// where the first lift-off is below the threshold.

import { fitted, isOfFirstJump, labelOf, paintAxes } from "./axes.js";
import { element } from "../dom.js";
import { scaleOf } from "../state/drawn.js";
import { saveButtons } from "../export/export.js";
import { placeText } from "./described.js";
import { axisScale, linearTicks } from "./scales.js";
import { tones } from "../state/tones.js";
import { fieldLabel, shownIn } from "../state/units.js";

/** The designs of a cut along an axis, through the one pointed at. */
function alongAxis(map, view, axis) {
  const row = map.axes[axis];
  return { indices: row.values.map((_, i) => view.index.map((k, a) => (a === axis ? i : k))), row,
    here: view.index[axis], name: labelOf(row) };
}

/** The designs of a cut from A to B. */
function alongLine(map, view) {
  const [from, to] = view.line, steps = Math.max(1, ...from.map((i, a) => Math.abs(to[a] - i)));
  const indices = Array.from({ length: steps + 1 }, (_, k) =>
    from.map((i, a) => Math.round(i + (to[a] - i) * k / steps)));
  const row = { values: indices.map((_, k) => k / steps), unit: "", log: false };
  return { indices, row, here: -1, name: `from A (${placeText(map, from)}) to B (${placeText(map, to)})` };
}

/** Whether a discontinuity lies between neighbours: torn has a bit for each axis, towards the next design. */
const isTornBetween = (torn, offset, a, b) => a.some((i, axis) => {
  const before = i < b[axis] ? a : a.map((k, at) => (at === axis ? b[axis] : k));
  return i !== b[axis] && torn[offset(before)] >> axis & 1;
});

/** Draws one cut. offset(index): a design's place among the values. */
function drawCut(canvas, map, view, { indices, row, here, name }, offset) {
  const frame = fitted(canvas, 1), [factor] = shownIn(view.field.unit, scaleOf(map, view.field));
  if (!frame) return;
  const context = canvas.getContext("2d"), { left, right, top, bottom, ratio } = frame, { field } = view;
  const own = isOfFirstJump(field), flags = own ? map.codes.spurious_first_jump?.values : undefined,
    torn = own ? map.codes.cliffs?.values : undefined, places = indices.map(offset);
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
      const v = field.values[k], x = sx.centre(i);
      if (v !== v || (flags?.[k] === 1) !== spurious) { drawing = false; return; }
      if (drawing) context.lineTo(x, sy.pixel(v));
      else { context.moveTo(x - ratio, sy.pixel(v)); context.lineTo(x, sy.pixel(v)); }
      drawing = i + 1 < places.length && !(torn && isTornBetween(torn, offset, indices[i], indices[i + 1]));
    });
    context.stroke();
  }
  context.setLineDash([]);
  paintAxes(context, frame, sx, shownY, name,
    fieldLabel(field, scaleOf(map, field), field.label.split(":")[0].split(" of the ")[0]));
  if (here >= 0) paintHere(context, frame, sx.centre(here), sy.pixel(field.values[places[here]]));
  canvas.dataset.values = places.filter((k) => field.values[k] === field.values[k]).length;
}

/** The design pointed at: a line across, and a dot at its value if it has one. */
function paintHere(context, { top, bottom, ratio }, x, y) {
  context.strokeStyle = context.fillStyle = tones.mark;
  context.lineWidth = 1.2 * ratio;
  context.beginPath();
  context.moveTo(x, top);
  context.lineTo(x, bottom);
  context.stroke();
  if (!Number.isFinite(y)) return;
  context.beginPath();
  context.arc(x, y, 4 * ratio, 0, 2 * Math.PI);
  context.fill();
}

/** Returns draw(), for whenever something else is pointed at or shown. */
export function cutsPart(map, view) {
  const part = element("cuts"), line = element("cut-line");
  const axisOf = { "cut-x": () => view.view.x, "cut-y": () => view.view.y };
  const along = (name) =>
    (name in axisOf ? alongAxis(map, view.view, axisOf[name]()) : alongLine(map, view.view));
  const drawOn = (canvas, name) => drawCut(canvas, map, view.view, along(name), view.offset);
  function draw() {
    if (!part.open) return;
    for (const name of Object.keys(axisOf)) drawOn(element(name), name);
    line.hidden = !view.view.line;
    if (view.view.line) drawOn(line, "cut-line");
  }
  part.addEventListener("toggle", draw);
  element("cut-line-draw").addEventListener("click", () => {
    element("cut-line-hint").hidden = false;
    view.takeLine(() => { element("cut-line-hint").hidden = true; draw(); });
  });
  for (const [name, axis] of Object.entries(axisOf))
    saveButtons(name, element(name), () => `${view.view.field.name}_over_${map.axes[axis()].name}`,
      (like) => drawOn(like, name));
  new ResizeObserver(draw).observe(element("cut-x"));
  return draw;
}
