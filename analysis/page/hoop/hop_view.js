// One hoop on its slope, to scale, at a moment of its motion.

import { PIN_COLOURS, tones } from "../state/tones.js";
import { short, units } from "../state/units.js";

/** Of each phase: what the hoop does, and the tone it is drawn in. */
const PHASES = { 1: ["rolls", "data"], 2: ["slides", "slide"], 3: ["flies", "fly"] };

/** The sample before a time, and how far on to the next. */
function sampleAt(motion, time) {
  const t = motion.t;
  let low = 0, high = t.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (t[middle] <= time) low = middle; else high = middle;
  }
  const span = t[high] - t[low];
  return { low, high, part: span > 0 ? Math.min(1, Math.max(0, (time - t[low]) / span)) : 0 };
}
/** A column of the motion at a time, between samples along a straight line. */
function valueAt(motion, name, time) {
  const { low, high, part } = sampleAt(motion, time);
  return motion[name][low] + (motion[name][high] - motion[name][low]) * part;
}

/** Hoops beside the one drawn at a time, each on its own slope, drawn along this one: as made, faint, and
    pinned ones in their colours, numbered. */
function drawGhosts(context, ghosts, time, turned, px, scale) {
  for (const { design, story, pin } of ghosts) {
    if (story.motion.t.length === 0) continue;
    const R = design.radius;
    context.globalAlpha = pin === undefined ? 0.3 : 0.9;
    context.lineWidth = Math.max(1, 0.03 * R * scale);
    const [x, y, phi] = ["x", "y", "phi"].map((name) => valueAt(story.motion, name, time)),
      L = design.offset_ratio * R;
    context.strokeStyle = pin === undefined
      ? tones[(PHASES[story.motion.phase[sampleAt(story.motion, time).low]] ?? PHASES[1])[1]]
      : PIN_COLOURS[pin];
    context.beginPath();
    context.arc(...px(turned(x, y + R)), R * scale, 0, 2 * Math.PI);
    context.stroke();
    if (pin !== undefined) {
      const [u, v] = px(turned(x, y + 2.3 * R));
      context.fillStyle = context.strokeStyle;
      context.font = `${Math.max(11, 0.4 * R * scale)}px system-ui, "DejaVu Sans", sans-serif`;
      context.fillText(String(pin + 1), u, v);
    }
    context.beginPath();
    context.arc(...px(turned(x - L * Math.sin(phi), y + R - L * Math.cos(phi))), Math.max(2, 0.1 * R * scale),
      0, 2 * Math.PI);
    context.fillStyle = pin === undefined ? tones.weight : PIN_COLOURS[pin];
    context.fill();
  }
  context.globalAlpha = 1;
}

/** Arrows of the plane's push and friction at the contact and of the weight at the centre of mass, in one
    scale: lengths as the square roots of forces, so that small ones are seen beside large. */
function drawForces(context, design, motion, time, turned, px, scale) {
  const R = design.radius, x = valueAt(motion, "x", time), y = valueAt(motion, "y", time),
    phi = valueAt(motion, "phi", time), { low } = sampleAt(motion, time);
  // At least the weight, which is 1.
  const most = motion.normal_force.reduce((a, b) => Math.max(a, b), 1),
    length = Math.min(0.9 * R, 2.4 * R / Math.sqrt(most)), along = (force) =>
    length * Math.sign(force) * Math.sqrt(Math.abs(force));
  const arm = design.offset_ratio * R * design.mass_ratio / (1 + design.mass_ratio),
    onPlane = motion.phase[low] !== 3;
  const labels = [];  // where there is one already
  const label = (words, x, y) => {
    const high = Math.max(11, 0.3 * R * scale);
    context.font = `${high}px system-ui, "DejaVu Sans", sans-serif`;
    // Beside the tip, or above or below whatever is there.
    const free = [0, -1, 1, -2, 2].map((k) => y + k * high)
      .find((at) => labels.every(([u, v]) => Math.abs(u - x) > high || Math.abs(v - at) >= high)) ?? y;
    labels.push([x, free]);
    context.fillText(words, x, free);
  };
  const arrow = ([x0, y0], [dx, dy], tone, words) => {
    const size = Math.hypot(dx, dy) * scale;
    if (!(size > 2)) return;
    const [ax, ay] = px(turned(x0, y0)), [bx, by] = px(turned(x0 + dx, y0 + dy)),
      head = Math.min(size, 0.2 * R * scale), u = (bx - ax) / size, v = (by - ay) / size;
    context.strokeStyle = context.fillStyle = tones[tone];
    context.lineWidth = Math.max(2, 0.05 * R * scale);
    context.beginPath();
    context.moveTo(ax, ay);
    context.lineTo(bx - 0.6 * head * u, by - 0.6 * head * v);
    context.stroke();
    context.beginPath();
    context.moveTo(bx, by);
    context.lineTo(bx - head * u - 0.5 * head * v, by - head * v + 0.5 * head * u);
    context.lineTo(bx - head * u + 0.5 * head * v, by - head * v - 0.5 * head * u);
    context.closePath();
    context.fill();
    label(words, bx + 0.15 * R * scale, by);
  };
  if (onPlane) {
    arrow([x, y], [0, along(motion.normal_force[low])], "fly", "N");
    arrow([x, y], [along(motion.friction[low]), 0], "slide", "F");
  }
  // Straight down on the screen, whatever the slope.
  arrow([x - arm * Math.sin(phi), y + R - arm * Math.cos(phi)],
    [length * Math.sin(design.slope), -length * Math.cos(design.slope)], "ink", "W");
}

/** The wall to clear: in the middle of where it may stand, else dashed in the middle of the jump. */
function drawWall(context, design, { outcome, motion, liftOffs }, turned, px, scale) {
  const k = [...liftOffs.is_jump].indexOf(1);
  if (!(design.clear_height > 0) || k < 0) return;
  const R = design.radius, isCleared = Number.isFinite(outcome.clears_from),
    [from, to] = isCleared ? [outcome.clears_from, outcome.clears_to] : [0, outcome.jump_range],
    at = valueAt(motion, "x", liftOffs.time[k]) + R * (from + to) / 2;
  context.beginPath();
  context.moveTo(...px(turned(at, 0)));
  context.lineTo(...px(turned(at, 2 * R * design.clear_height)));
  context.lineWidth = Math.max(3, 0.06 * R * scale);
  context.strokeStyle = tones.ink;
  context.setLineDash(isCleared ? [] : [0.12 * R * scale, 0.12 * R * scale]);
  context.stroke();
  context.setLineDash([]);
}

/**
 * Draws the hoop at a time, with ghosts beside it. design: {slope, offset_ratio, mass_ratio, radius};
 * closeUp: follows the hoop; forces: with arrows of them. x goes down the slope and y away from it, on the
 * screen turned by the slope; the point mass is at angle phi from the line to the plane, clockwise.
 */
export function drawHoop(canvas, design, story, time, closeUp, ghosts = [], forces = false) {
  const { motion } = story;
  const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect();
  canvas.width = Math.max(1, Math.round(box.width * ratio));
  canvas.height = Math.max(1, Math.round(box.height * ratio));
  const context = canvas.getContext("2d"), R = design.radius, n = motion.t.length;
  const cos = Math.cos(design.slope), sin = Math.sin(design.slope);
  // From along and above the plane to the right and down.
  const turned = (x, y) => [x * cos + y * sin, x * sin - y * cos];
  const centre = (k) => turned(motion.x[k], motion.y[k] + R);
  let [left, right, top, bottom] = [Infinity, -Infinity, Infinity, -Infinity];
  for (let k = 0; k < n; ++k) {
    const [u, v] = centre(k);
    left = Math.min(left, u - 1.6 * R); right = Math.max(right, u + 1.6 * R);
    top = Math.min(top, v - 1.4 * R); bottom = Math.max(bottom, v + 2.2 * R);
  }
  const x = valueAt(motion, "x", time), y = valueAt(motion, "y", time), phi = valueAt(motion, "phi", time);
  const [cu, cv] = turned(x, y + R);
  if (closeUp) [left, right, top, bottom] = [cu - 4.5 * R, cu + 4.5 * R, cv - 2.2 * R, cv + 2.2 * R];
  const scale = Math.min(canvas.width / (right - left), canvas.height / (bottom - top));
  /** @type {(place: number[]) => [number, number]} */
  const px = ([u, v]) =>
    [(u - (left + right) / 2) * scale + canvas.width / 2, (v - (top + bottom) / 2) * scale
    + canvas.height / 2];

  context.fillStyle = tones.scene;
  context.fillRect(0, 0, canvas.width, canvas.height);
  // The plane, far beyond both edges.
  const far = (canvas.width + canvas.height) / scale, here = x;
  const [a, b] = [px(turned(here - far, 0)), px(turned(here + far, 0))];
  context.beginPath();
  context.moveTo(...a);
  context.lineTo(...b);
  context.lineTo(b[0], b[1] + 2 * canvas.height);
  context.lineTo(a[0], a[1] + 4 * canvas.height + far * scale);
  context.closePath();
  context.fillStyle = tones.earth;
  context.fill();
  context.lineWidth = 1.5 * ratio;
  context.strokeStyle = tones.ink;
  context.stroke();

  // A tick every radius tells how fast the slope goes by.
  const ticks = Math.min(400, Math.ceil(far / R));
  context.beginPath();
  for (let k = Math.floor(here / R) - ticks; k <= here / R + ticks; ++k) {
    context.moveTo(...px(turned(k * R, 0)));
    context.lineTo(...px(turned(k * R, -0.12 * R)));
  }
  context.lineWidth = ratio;
  context.stroke();

  drawWall(context, design, story, turned, px, scale);
  // The centre's path so far, coloured by phase; a mark wherever a phase begins.
  const { low } = sampleAt(motion, time);
  context.lineWidth = 2.5 * ratio;
  context.globalAlpha = 0.45;
  for (let k = 0; k < low; ++k) {
    context.beginPath();
    context.strokeStyle = tones[(PHASES[motion.phase[k + 1]] ?? PHASES[1])[1]];
    context.moveTo(...px(centre(k)));
    context.lineTo(...px(centre(k + 1)));
    context.stroke();
  }
  context.globalAlpha = 1;
  drawGhosts(context, ghosts, time, turned, px, scale);
  const phase = PHASES[motion.phase[low]] ?? PHASES[1];
  context.beginPath();
  context.arc(...px([cu, cv]), R * scale, 0, 2 * Math.PI);
  context.lineWidth = Math.max(2 * ratio, 0.06 * R * scale);
  context.strokeStyle = tones[phase[1]];
  context.stroke();
  // phi = 0: the mass is next to the plane; it goes round as the hoop rolls downhill.
  const L = design.offset_ratio * R;
  const mass = turned(x - L * Math.sin(phi), y + R - L * Math.cos(phi));
  context.beginPath();
  context.moveTo(...px([cu, cv]));
  context.lineTo(...px(mass));
  context.lineWidth = 1.2 * ratio;
  context.stroke();
  context.beginPath();
  context.arc(...px(mass), Math.max(3 * ratio, 0.16 * R * scale), 0, 2 * Math.PI);
  context.fillStyle = tones.weight;
  context.fill();

  if (forces) drawForces(context, design, motion, time, turned, px, scale);

  // A ruler of a round length, and what the hoop does.
  const unit = units.pure ? R : 1, length = niceLength((right - left) / 5 / unit), font = 13 * ratio;
  context.font = `${font}px system-ui, "DejaVu Sans", sans-serif`;
  context.fillStyle = context.strokeStyle = tones.ink;
  context.lineWidth = 2 * ratio;
  const ruler = [0.8 * font, canvas.height - 1.0 * font];
  context.beginPath();
  context.moveTo(ruler[0], ruler[1]);
  context.lineTo(ruler[0] + length * unit * scale, ruler[1]);
  context.stroke();
  context.fillText(units.pure ? `${length} R` : length >= 1 ? `${length} m` : length >= 0.01
    ? `${short(100 * length)} cm` : `${short(1000 * length)} mm`, ruler[0], ruler[1] - 0.5 * font);
  context.textAlign = "right";
  context.fillStyle = tones[phase[1]];
  const altitude = units.pure ? `${short(y / R, 3)} R` : `${short(1000 * y, 3)} mm`;
  context.fillText(phase[0] + (y > 1e-9 * R ? `, ${altitude} above the plane` : ""),
    canvas.width - 0.8 * font, 1.5 * font);
  context.textAlign = "left";
}

function niceLength(wanted) {
  const decade = 10 ** Math.floor(Math.log10(wanted));
  return Number(([5, 2, 1].find((m) => m * decade <= wanted) * decade).toPrecision(3));
}
