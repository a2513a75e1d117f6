// Parallel coordinates: an axis with a histogram for each parameter that varies and for each quantity chosen,
// and a line for each design, dark where it reaches every goal. A stretch of a quantity's axis, brushed, is a
// goal. Designs are counted between neighbouring axes in BINS times BINS: a million need no more lines than a
// thousand.

import { brushY } from "d3-brush";
import { scaleLinear, scaleLog } from "d3-scale";
import { event, select } from "d3-selection";

import { element, option } from "../dom.js";
import { applies, stridesOf } from "../map/described.js";
import { linearTicks, logTicks, tickTexts } from "../map/scales.js";
import { scaleOf } from "../state/drawn.js";
import { noteAddress } from "../state/address.js";
import { onTones, rgbOf, tones } from "../state/tones.js";
import { fieldLabel, perUnit, shownIn } from "../state/units.js";

const BINS = 48, NONE = 255, SHADES = 8;
const FIRST = ["jump_height", "jump_time", "jump_range", "landing_normal_speed"];

/** What a design has on each of the map's axes: number(k) of axis i. */
function parameterOf(map, i) {
  const { values } = map.axes[i], stride = stridesOf(map)[i];
  return (k) => values[Math.floor(k / stride) % values.length];
}

const scaleAlong = ({ low, high, isLog }, range) =>
  (isLog ? scaleLog() : scaleLinear()).domain([low, high]).range(range).clamp(true);

/** The bin of each design on an axis. */
function binned(axis, count) {
  const { number } = axis, scale = scaleAlong(axis, [0, BINS]), bins = new Uint8Array(count);
  for (let k = 0; k < count; ++k) {
    const place = scale(number(k));
    bins[k] = place >= 0 ? Math.min(BINS - 1, Math.floor(place)) : NONE;
  }
  return bins;
}

/** How many designs, of those for which isIn, run from each bin of one axis to each of the next. */
function counted(from, to, isIn) {
  const counts = new Uint32Array(BINS * BINS);
  for (let k = 0; k < from.length; ++k)
    if (isIn[k] && from[k] !== NONE && to[k] !== NONE) ++counts[from[k] * BINS + to[k]];
  return counts;
}

/** Words in lines of about that many letters. */
const linesOf = (text, most) => text.split(" ").reduce((lines, word) => {
  const last = lines.length - 1;
  return last >= 0 && lines[last].length + 1 + word.length <= most
    ? [...lines.slice(0, last), `${lines[last]} ${word}`] : [...lines, word];
}, []);

/** goals: with range(field) and setRange(field, least, most); chosen(): axes are of other quantities. Returns
    show(), for when numbers or goals are
    others, point(), for when another design is pointed at, and the address's words. */
export function linesPart(map, view, goals, chosen) {
  const part = element("lines-part"), canvas = element("lines"), add = element("lines-add"),
    background = document.createElement("canvas"), svg = select("#lines-brushes"),
    count = map.fields[0].values.length;
  const fieldOf = (name) => map.fields.find((field) => field.name === name);
  const first = FIRST.filter((name) => fieldOf(name)), now = { names: [...first], axes: [], frame: 0,
    isBrushing: false };

  /** The axes from left to right: what varies, then quantities that have numbers. */
  function axesNow() {
    const varying = map.axes.map((axis, i) => ({ axis, i })).filter(({ axis }) => axis.values.length > 1)
      .map(({ axis, i }) => ({
        name: axis.name, unit: axis.unit, factor: perUnit(axis.unit), isLog: axis.log,
        low: axis.values[0], high: axis.values.at(-1), number: parameterOf(map, i), field: null }));
    const quantities = now.names.map(fieldOf).filter((field) => applies(map, field) && field.high > field.low)
      .map((field) => {
        const [factor, unit] = shownIn(field.unit, scaleOf(map, field));
        return { name: field.name, unit, factor, isLog: field.log, low: field.low, high: field.high,
          number: (k) => field.values[k], field };
      });
    return [...varying, ...quantities];
  }

  function offer() {
    add.replaceChildren();
    option(add, "", "+ or − a quantity");
    for (const field of map.fields.filter((each) => applies(map, each)))
      option(add, field.name, `${now.names.includes(field.name) ? "− " : "+ "}` +
        `${fieldLabel(field, scaleOf(map, field))}`);
    add.value = "";
  }

  /** Lines between two axes, the more designs the darker. */
  function paintBetween(context, counts, [x0, x1], yOf, colour) {
    // Where designs are spread evenly lines are faint.
    const most = counts.reduce((a, b) => Math.max(a, b), counts.reduce((a, b) => a + b, 1) / BINS),
      [r, g, b] = rgbOf(colour);
    for (let shade = 1; shade <= SHADES; ++shade) {
      context.strokeStyle = `rgba(${r},${g},${b},${0.7 * shade / SHADES})`;
      context.beginPath();
      counts.forEach((n, at) => {
        if (n === 0 || Math.ceil(SHADES * Math.sqrt(n / most)) !== shade) return;
        context.moveTo(x0, yOf(Math.floor(at / BINS) + 0.5));
        context.lineTo(x1, yOf(at % BINS + 0.5));
      });
      context.stroke();
    }
  }

  function paintHistogram(context, bins, isIn, x, width, yOf, colour, most) {
    const heights = new Uint32Array(BINS);
    bins.forEach((bin, k) => { if (bin !== NONE && isIn[k]) ++heights[bin]; });
    const full = most ?? heights.reduce((a, b) => Math.max(a, b), 1);
    context.fillStyle = colour;
    heights.forEach((n, bin) =>
      context.fillRect(x, yOf(bin + 1), width * n / full, Math.abs(yOf(bin) - yOf(bin + 1)) - 0.5));
    return full;
  }

  function paintAxis(context, axis, x, { font, top, bottom, room }) {
    const [low, high] = [axis.low * axis.factor, axis.high * axis.factor],
      ticks = axis.isLog ? logTicks(low, high) : linearTicks(low, high, 5), texts = tickTexts(ticks),
      scale = scaleAlong({ ...axis, low, high }, [bottom, top]);
    context.strokeStyle = context.fillStyle = tones.ink;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, bottom);
    context.stroke();
    context.textAlign = "right";
    context.textBaseline = "middle";
    context.strokeStyle = tones.ground;
    context.lineWidth = 0.3 * font;
    context.lineJoin = "round";
    ticks.forEach((tick, i) => {
      context.strokeText(texts[i], x - 0.4 * font, scale(tick));
      context.fillText(texts[i], x - 0.4 * font, scale(tick));
    });
    context.textAlign = "center";
    const unit = axis.unit ? ` [${axis.unit.replaceAll(" ", "\u00a0")}]` : "";
    const name = axis.name.replace(/^hoop[.]/, "").replaceAll(/[_.]/g, " ");
    linesOf(`${name}${unit}`, 12).forEach((line, k, { length }) =>
      context.fillText(line, x, top - (length - k) * 1.1 * font + 0.2 * font, room));
  }

  /** Where the frame is, in pixels of the canvas, and each axis in it. */
  function placed() {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect(), font = 12 * ratio,
      n = now.axes.length;
    const at = (i) => (n > 1 ? 4 * font + i * (box.width * ratio - 8 * font) / (n - 1) : 4 * font);
    return { ratio, box, font, at, room: at(1) - at(0), top: 4.4 * font,
      bottom: box.height * ratio - 0.8 * font };
  }

  function paint() {
    if (!part.open || element("map").dataset.coarse === "false") return;
    now.axes = axesNow();
    const frame = placed(), { ratio, box, font, top, bottom, at } = frame;
    if (!(box.width > 0)) return;
    for (const each of [canvas, background])
      [each.width, each.height] = [Math.round(box.width * ratio), Math.round(box.height * ratio)];
    const context = background.getContext("2d"), yOf = (bin) => bottom - (bottom - top) * bin / BINS;
    context.fillStyle = tones.ground;
    context.fillRect(0, 0, background.width, background.height);
    context.font = `${font}px system-ui, "DejaVu Sans", sans-serif`;
    context.lineWidth = ratio;
    const bins = now.axes.map((axis) => binned(axis, count)), all = new Uint8Array(count).fill(1),
      left = map.keeps ? Uint8Array.from(all, (_, k) => Number(map.keeps(k))) : all;
    const layers = map.keeps ? [[all, tones.frame], [left, tones.data]] : [[all, tones.data]];
    for (const [isIn, colour] of layers)
      for (let i = 0; i + 1 < bins.length; ++i)
        paintBetween(context, counted(bins[i], bins[i + 1], isIn), [at(i), at(i + 1)], yOf, colour);
    now.axes.forEach((axis, i) => {
      let most;
      for (const [isIn, colour] of layers)
        most = paintHistogram(context, bins[i], isIn, at(i), 2.4 * font, yOf, colour, most);
      paintAxis(context, axis, at(i), frame);
    });
    canvas.dataset.left = String(left.reduce((a, b) => a + b, 0));
    point();
    brushes(frame);
  }

  /** The designs picked and pointed at, above all others. */
  function point() {
    if (!part.open || background.width === 0 || now.axes.length === 0) return;
    const context = canvas.getContext("2d"), { top, bottom, at, ratio } = placed();
    context.drawImage(background, 0, 0);
    for (const [index, colour] of [[view.view.picked, tones.mark], [view.view.index, tones.ink]]) {
      if (!index) continue;
      const k = view.offset(index);
      context.strokeStyle = colour;
      context.lineWidth = 2 * ratio;
      context.beginPath();
      now.axes.forEach((axis, i) => {
        const y = scaleAlong(axis, [bottom, top])(axis.number(k));
        if (Number.isFinite(y)) context.lineTo(at(i), y);
      });
      context.stroke();
    }
  }

  /** A brush on every axis of a quantity, at the goals that it has. */
  function brushes({ ratio, top, bottom, at }) {
    if (now.isBrushing) return;  // the hand is on one of them
    const [y0, y1] = [top / ratio, bottom / ratio];
    const groups = svg.selectAll("g.brush").data(now.axes.map((axis, i) => ({ axis, i }))
      .filter(({ axis }) => axis.field));
    groups.exit().remove();
    groups.enter().append("g").attr("class", "brush").merge(groups).each(function place({ axis, i }) {
      const { field } = axis, scale = scaleAlong(axis, [y1, y0]);
      const brush = brushY().extent([[at(i) / ratio - 12, y0], [at(i) / ratio + 12, y1]])
        .on("start brush end", () => {
          if (!event.sourceEvent) return;  // moved by this function
          now.isBrushing = event.type !== "end";
          if (event.type === "start") return;
          const [high, low] = event.selection ?? [y0, y1];
          goals.setRange(field, low < y1 ? scale.invert(low) : -Infinity,
            high > y0 ? scale.invert(high) : Infinity);
        });
      const [least, most] = goals.range(field);
      select(this).call(brush).call(brush.move,
        least === -Infinity && most === Infinity ? null
        : [Math.min(most, axis.high), Math.max(least, axis.low)].map((value) => scale(value)));
    });
  }

  /** Once a picture, however often goals change while one drags. */
  function show() {
    if (!part.open || now.frame) return;
    now.frame = requestAnimationFrame(() => { now.frame = 0; paint(); });
  }

  function changed() {
    offer();
    chosen();
    show();
    noteAddress();
  }
  add.addEventListener("change", () => {
    const name = add.value;
    if (!name) return;
    now.names = now.names.includes(name) ? now.names.filter((each) => each !== name) : [...now.names, name];
    changed();
  });
  part.addEventListener("toggle", changed);
  new ResizeObserver(show).observe(canvas);
  onTones(show);

  return {
    show, point, fields: () => (part.open ? now.names.map(fieldOf) : []),
    write(words) { if (part.open) words.set("lines", now.names.join()); },
    read(words) {
      part.open = words.has("lines");
      now.names = words.has("lines") ? words.get("lines").split(",").filter((name) => fieldOf(name))
        : [...first];
      offer();
      chosen();
      show();
    },
  };
}
