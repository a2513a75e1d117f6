// What the views of a map share: colours, a frame with ticks, names with units, and how designs are pointed
// at.

import { tickTexts } from "./scales.js";
import { tones } from "../state/tones.js";

/** Whether cliffs and flags of the first jump are a field's own: not of hoops as made, nor of gaits. */
export const isOfFirstJump = (field) => !field.made && !field.gait;

/** The canvas at the screen's own resolution and the frame in it, or null while it is not shown; right,
    above: what is free there [of the font's size]. */
export function fitted(canvas, right, above = 0.8) {
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect(), font = 13 * ratio;
  if (!(box.width > 0)) return null;
  canvas.width = Math.round(box.width * ratio);
  canvas.height = Math.round(box.height * ratio);
  return { left: 4.6 * font, top: above * font, right: canvas.width - right * font,
    bottom: canvas.height - 3.4 * font, font, ratio };
}

/**
 * Points at designs and picks them, by mouse, finger and keys; view holds index and picked. pointAt(event):
 * points there, if there is a design; goBack(): to the one picked, if that is shown; step(key, by): moves on,
 * if that is a key to move by. Returns {point, pick}.
 */
export function pointing(canvas, view, { pointAt, goBack, step, paintCursor, onPoint, onPick }) {
  const point = () => { paintCursor(); onPoint(view.index); };
  const pick = (byHand = false) => { view.picked = [...view.index]; point(); onPick(view.index, byHand); };
  canvas.addEventListener("pointermove", (event) =>
    { if (event.pointerType !== "touch" && pointAt(event)) point(); });
  canvas.addEventListener("click", (event) => { if (pointAt(event)) pick(true); });
  canvas.addEventListener("pointerleave", (event) =>
    { if (event.pointerType !== "touch" && view.picked && goBack()) point(); });
  canvas.addEventListener("keydown", (event) => {
    if (step(event.key, event.shiftKey ? 10 : 1)) point();
    else if (event.key === "Enter" || event.key === " ") pick();
    else return;
    event.preventDefault();
  });
  return { point, pick };
}

export const clamped = (value, most) => Math.min(most, Math.max(0, value));

export const labelOf = (axis) =>
  axis.label + (axis.unit === "°" ? " [degrees]" : axis.unit ? ` [${axis.unit}]` : "");

/** A frame with ticks and names on a canvas; sx, sy: pixel(value), ticks(). */
export function paintAxes(context, frame, sx, sy, nameX, nameY) {
  const { left, top, right, bottom, font, ratio } = frame;
  context.strokeStyle = context.fillStyle = tones.ink;
  context.lineWidth = ratio;
  context.strokeRect(left, top, right - left, bottom - top);
  context.font = `${font}px system-ui, "DejaVu Sans", sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "top";
  context.beginPath();
  let last = -Infinity;
  const along = sx.ticks(), textsAlong = tickTexts(along);
  for (const [i, tick] of along.entries()) {
    const p = sx.pixel(tick), text = textsAlong[i], width = context.measureText(text).width;
    context.moveTo(p, bottom);
    context.lineTo(p, bottom + 0.35 * font);
    if (p - width / 2 > last) { context.fillText(text, p, bottom + 0.5 * font);
        last = p + width / 2 + 0.4 * font; }
  }
  context.textAlign = "right";
  context.textBaseline = "middle";
  const up = sy.ticks(), textsUp = tickTexts(up);
  for (const [i, tick] of up.entries()) {
    const p = sy.pixel(tick);
    context.moveTo(left, p);
    context.lineTo(left - 0.35 * font, p);
    context.fillText(textsUp[i], left - 0.5 * font, p);
  }
  context.stroke();
  context.textAlign = "center";
  context.textBaseline = "alphabetic";
  context.fillText(nameX, (left + right) / 2, context.canvas.height - 0.6 * font);
  context.save();
  context.translate(1.1 * font, (top + bottom) / 2);
  context.rotate(-Math.PI / 2);
  context.fillText(nameY, 0, 0);
  context.restore();
}
