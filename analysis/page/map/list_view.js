// A map of one dimension: a dot for each design, the field up and one of its parameters to the right.

import { isReadingAddress } from "../state/address.js";
import { clamped, fitted, isOfFirstJump, labelOf, paintAxes, pointing } from "./axes.js";
import { scaleOf } from "../state/drawn.js";
import { linearTicks, logTicks } from "./scales.js";
import { tones } from "../state/tones.js";
import { fieldLabel, inShownUnit, shownIn } from "../state/units.js";

/** The same to its caller as mapView; view.x is a number among map.columns. */
export function listView(canvas, map, onPoint, onPick) {
  const count = map.axes[0].values.length;
  const view = { x: 0, y: null, field: map.fields[0], index: [0], picked: null };
  const status = map.codes.status, flags = map.codes.spurious_first_jump;
  const background = document.createElement("canvas");  // all but the cursor
  let frame, dots;

  /** From values to pixels; a twentieth is free on either side. */
  function scale(values, log, from, to) {
    const at = log ? Math.log : (v) => v,
      finite = values.filter((v) => Number.isFinite(v) && (!log || v > 0));
    const low = finite.reduce((a, b) => Math.min(a, b), Infinity),
      high = finite.reduce((a, b) => Math.max(a, b), -Infinity);
    const span = at(high) - at(low) || 1, first = at(low) - 0.05 * span, factor = (to - from) / (1.1 * span);
    return { pixel: (v) => from + (at(v) - first) * factor, ticks: () =>
      (log && high > low ? logTicks(low, high) : linearTicks(low, high)) };
  }

  function paint() {
    if (frame && isReadingAddress()) return;
    const fresh = fitted(canvas, 1.5);
    if (!fresh) return;
    frame = fresh;
    background.width = canvas.width;
    background.height = canvas.height;
    paintOn(background.getContext("2d"));
    paintCursor();
  }

  function paintOn(context) {
    const column = map.columns[view.x], { log } = view.field, { font, ratio } = frame;
    const [factor] = shownIn(view.field.unit, scaleOf(map, view.field)),
      values = Float64Array.from(view.field.values, (v) => v * factor), [across, acrossUnit] = column.quantity
      ? shownIn(column.unit, scaleOf(map)) : [1, column.unit];
    const shown = column.values.map((v) =>
      (v === null ? NaN : column.quantity ? v * across : inShownUnit(column, v)));
    const sx = scale(shown, column.log, frame.left, frame.right),
      sy = scale([...values], log, frame.bottom - 1.5 * font, frame.top);
    context.fillStyle = tones.ground;
    context.fillRect(0, 0, canvas.width, canvas.height);
    dots = shown.map((x, i) => {
      const there = Number.isFinite(values[i]) && (!log || values[i] > 0);
      return [sx.pixel(x), there ? sy.pixel(values[i]) : frame.bottom - 0.7 * font, there];
    });
    context.lineWidth = 1.4 * ratio;
    dots.forEach(([x, y, there], i) => {
      context.strokeStyle = context.fillStyle = there ? tones.data : status?.shown[status.values[i]]?.colour
        ?? tones.faint;
      context.beginPath();
      if (there) context.arc(x, y, 0.3 * font, 0, 2 * Math.PI);
      else for (const s of [-1, 1]) { context.moveTo(x - 0.25 * font, y - s * 0.25 * font);
        context.lineTo(x + 0.25 * font, y + s * 0.25 * font); }
      if (there && !(flags?.values[i] === 1 && isOfFirstJump(view.field))) context.fill();
      context.stroke();
    });
    paintAxes(context, frame, sx, sy, labelOf({ ...column, unit: acrossUnit }),
      fieldLabel(view.field, scaleOf(map, view.field)));
  }

  function paintCursor() {
    if (!frame) return;
    const context = canvas.getContext("2d"), { font, ratio } = frame;
    context.drawImage(background, 0, 0);
    for (const [index, colour] of [[view.picked, tones.mark], [view.index, tones.ink]]) {
      if (!index) continue;
      context.lineWidth = 2 * ratio;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(dots[index[0]][0], dots[index[0]][1], 0.6 * font, 0, 2 * Math.PI);
      context.stroke();
    }
  }

  /** The dot nearest to the pointer, if it is near at all. */
  function pointAt(event) {
    if (!frame) return false;
    const box = canvas.getBoundingClientRect();
    const x = (event.clientX - box.left) * canvas.width / box.width,
      y = (event.clientY - box.top) * canvas.height / box.height;
    const away = dots.map(([u, v]) => Math.hypot(u - x, v - y)),
      least = away.reduce((a, b) => Math.min(a, b), Infinity);
    if (!(least < 3 * frame.font)) return false;
    view.index = [away.indexOf(least)];
    return true;
  }
  const { point, pick } = pointing(canvas, view, {
    pointAt, paintCursor, onPoint, onPick,
    goBack() {
      view.index = [...view.picked];
      return true;
    },
    step(key, by) {
      const move = { ArrowLeft: -by, ArrowRight: by }[key];
      if (move === undefined) return false;
      view.index = [clamped(view.index[0] + move, count - 1)];
      return true;
    },
  });
  new ResizeObserver(() => paint()).observe(canvas);

  return {
    view, paint, paintOn, pick, point, showsPaper: () => false, offset: (index) => index[0],
    /** Where a design's dot is on the screen, for tests. */
    placeOf(index) {
      const box = canvas.getBoundingClientRect();
      return [box.left + dots[index[0]][0] * box.width / canvas.width,
        box.top + dots[index[0]][1] * box.height / canvas.height];
    },
  };
}
