// Height and forces over time, one under the other, with the moment shown.

import { linearTicks, tickTexts } from "../map/scales.js";
import { PIN_COLOURS, tones } from "../state/tones.js";

const PLOTS = [
  { label: "height", unit: "y", lines: [{ column: "y", tone: "data" }] },
  { label: "force", unit: "force",
    lines: [{ column: "normal_force", tone: "data", name: "normal force", contact: true },
                                { column: "friction", tone: "slide", name: "friction, downhill",
                                  contact: true, dash: [6, 4] }] },
];

/** A line over time, broken where there is no number and, of forces, in flight: a force ends with the
    contact. */
function drawTrace(context, motion, values, contact, sx, sy) {
  context.beginPath();
  let drawing = false;
  values.forEach((v, i) => {
    if (!Number.isFinite(v) || (contact && motion.phase[i] === 3)) { drawing = false; return; }
    if (drawing) context.lineTo(sx(motion.t[i]), sy(v)); else context.moveTo(sx(motion.t[i]), sy(v));
    drawing = true;
  });
  context.stroke();
}

/**
 * Draws the plots of a hoop's story, and of pinned ones, thin and in their colours, beside it: [{pin,
 * story}]. end: the time axis's [s]; shown: {t, y, force}, each what SI, or weights, are multiplied by, and
 * the unit; radius: of the hoop [m]. Returns the time at a place on the screen.
 */
export function drawPlots(canvas, { motion, liftOffs }, pinned, time, end, shown, radius) {
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  canvas.width = Math.max(1, Math.round(box.width * ratio));
  canvas.height = Math.max(1, Math.round(box.height * ratio));
  const context = canvas.getContext("2d"), font = 12 * ratio;
  const left = 5 * font, right = canvas.width - font;
  const sx = (t) => left + (right - left) * t / end;
  const height = (canvas.height - 2.8 * font) / PLOTS.length;
  context.clearRect(0, 0, canvas.width, canvas.height);
  context.font = `${font}px system-ui, "DejaVu Sans", sans-serif`;
  context.lineJoin = "round";
  PLOTS.forEach((plot, k) => {
    const top = k * height + 0.6 * font, bottom = (k + 1) * height - 0.6 * font;
    const [factor, unit] = shown[plot.unit],
      scaled = plot.lines.map((line) => ({ ...line, values: motion[line.column].map((v) => v * factor) }));
    // a tenth of R: what is less is nothing to look at
    let low = 0, high = factor * (plot.unit === "y" ? 0.1 * radius : 1e-9);
    const beside = pinned.filter(({ story }) => story.motion.t.length > 0)
      .map(({ pin, story }) =>
      ({ pin, motion: story.motion, values: story.motion[plot.lines[0].column].map((v) => v * factor) }));
    for (const line of [...scaled, ...beside]) for (const v of line.values)
      if (Number.isFinite(v)) { low = Math.min(low, v); high = Math.max(high, v); }
    high += 0.05 * (high - low);
    const sy = (v) => bottom - (bottom - top) * (v - low) / (high - low);
    // Phases but rolling are shaded.
    for (let i = 0; i + 1 < motion.t.length; ++i) {
      const phase = motion.phase[i + 1];
      if (phase === 1 || phase !== motion.phase[i] && phase !== 3) continue;
      context.fillStyle = phase === 3 ? `${tones.fly}22` : `${tones.slide}22`;
      context.fillRect(sx(motion.t[i]), top, sx(motion.t[i + 1]) - sx(motion.t[i]), bottom - top);
    }
    context.strokeStyle = tones.frame;
    context.lineWidth = ratio;
    context.strokeRect(left, top, right - left, bottom - top);
    context.fillStyle = tones.ink;
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.beginPath();
    const ticks = linearTicks(low, high, 4), texts = tickTexts(ticks);
    for (const [i, tick] of ticks.entries()) {
      context.moveTo(left, sy(tick));
      context.lineTo(right, sy(tick));
      context.fillText(texts[i], left - 0.4 * font, sy(tick));
    }
    context.save();
    context.globalAlpha = 0.35;
    context.stroke();
    context.restore();
    // Lift-offs: dashed, the jump's in red.
    for (let i = 0; i < liftOffs.time.length; ++i) {
      const jump = liftOffs.is_jump[i] === 1;
      context.beginPath();
      context.setLineDash(jump ? [] : [4 * ratio, 4 * ratio]);
      context.strokeStyle = jump ? tones.mark : tones.faint;
      context.moveTo(sx(liftOffs.time[i]), top);
      context.lineTo(sx(liftOffs.time[i]), bottom);
      context.stroke();
    }
    let legend = left + 0.6 * font;
    context.lineWidth = 1.2 * ratio;
    for (const { pin, motion: its, values } of beside) {
      context.strokeStyle = PIN_COLOURS[pin];
      drawTrace(context, its, values, plot.lines[0].contact, sx, sy);
    }
    for (const line of scaled) {
      context.setLineDash((line.dash ?? []).map((d) => d * ratio));
      context.strokeStyle = context.fillStyle = tones[line.tone];
      context.lineWidth = 1.6 * ratio;
      drawTrace(context, motion, line.values, line.contact, sx, sy);
      context.setLineDash([]);
      if (line.name) {
        context.textAlign = "left";
        context.fillText(line.name, legend, top + 0.9 * font);
        legend += context.measureText(line.name).width + font;
      }
    }
    context.fillStyle = tones.ink;
    context.save();
    context.translate(1.0 * font, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(`${plot.label} [${unit}]`, 0, 0);
    context.restore();
    context.strokeStyle = tones.ink;
    context.lineWidth = 1.2 * ratio;
    context.beginPath();
    context.moveTo(sx(time), top);
    context.lineTo(sx(time), bottom);
    context.stroke();
  });
  context.textAlign = "center";
  context.textBaseline = "top";
  context.fillStyle = tones.ink;
  const times = linearTicks(0, end * shown.t[0], 8), texts = tickTexts(times);
  for (const [i, tick] of times.entries())
    context.fillText(texts[i], sx(tick / shown.t[0]), PLOTS.length * height - 0.4 * font);
  context.textBaseline = "alphabetic";
  context.fillText(`time since release [${shown.t[1]}]`, (left + right) / 2, canvas.height - 0.3 * font);
  return (clientX) =>
    Math.min(end, Math.max(0,
    ((clientX - box.left) * canvas.width / box.width - left) / (right - left) * end));
}
