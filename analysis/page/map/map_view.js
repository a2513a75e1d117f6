// The map as an image: cells, isolines, cliffs, axes, and a cursor on the design pointed at.

import { isReadingAddress } from "../state/address.js";
import { clamped, fitted, isOfFirstJump, labelOf, paintAxes, pointing } from "./axes.js";
import { crispPlane } from "./crisp.js";
import { designAt, stridesOf } from "./described.js";
import { RATIOS, isDrawn, scaleOf } from "../state/drawn.js";
import { isolines, planeOf } from "./isolines.js";
import { NO_LIVE_AXIS, SLIPPING } from "../state/ranges.js";
import { axisScale, linearTicks, muted, shownLevels } from "./scales.js";
import { PIN_COLOURS, PIN_INKS, rgbOf, tones } from "../state/tones.js";
import { fieldLabel, inShownUnit, perUnit, short, shownIn, withUnit } from "../state/units.js";

/** What a scene is told by. */
const SCENE_WORDS = {
  radius: (v) => `R ${v} m`, gravity: (v) => `g ${v} m/s²`, runway: (v) => `rolling limit ${v} revolutions`,
  hop_height: (v) => `jump threshold ${v} diameters`, rest_speed: (v) => `rebounds above ${v} √(g R)`,
};

/** Of the lines of cliffs, by what happens there. */
export const DASHES = { fold: [4, 2], runway: [1, 2], turn: [5, 2, 1, 2], release: [1, 1],
  phase: [3, 1, 1, 1], unresolved: [1, 2] };

/**
 * Draws into a canvas; `map` holds axes, fields with their values, codes. Calls onPoint(index) for the design
 * pointed at, onPick(index) for the one clicked; index: along each axis of the map.
 */
export function mapView(canvas, map, onPoint, onPick) {
  const shape = map.axes.map((a) => a.values.length);
  const strides = stridesOf(map);
  const view = { x: 0, y: 1, field: map.fields[0], index: shape.map((n) => Math.floor(n / 2)), picked: null,
    line: null };
  const status = map.codes.status, flags = map.codes.spurious_first_jump, cliffs = map.codes.cliffs;
  const background = document.createElement("canvas");  // all but the cursor
  let sx, sy, frame, box, chains, isCrisp, pixels;

  const offset = (i, j) => {
    let at = i * strides[view.x] + j * strides[view.y];
    for (let k = 0; k < shape.length; ++k) if (k !== view.x && k !== view.y) at += view.index[k] * strides[k];
    return at;
  };

  /** Everything but the cursor, at the screen's own resolution. rough: without isolines, of a map that is
      about to be another. */
  function paint(rough = false) {
    if (frame && isReadingAddress()) return;
    const fresh = fitted(canvas, 7, 2);
    if (!fresh) return;
    frame = fresh;
    background.width = canvas.width;
    background.height = canvas.height;
    paintOn(background.getContext("2d"), rough);
    paintCursor();
  }

  function paintOn(context, rough = false) {
    sx = axisScale(map.axes[view.x], frame.left, frame.right);
    sy = axisScale(map.axes[view.y], frame.bottom, frame.top);
    context.fillStyle = tones.ground;
    context.fillRect(0, 0, canvas.width, canvas.height);
    const x0 = Math.round(frame.left), y0 = Math.round(frame.top);
    box = { x0, y0, w: Math.round(frame.right) - x0, h: Math.round(frame.bottom) - y0 };
    chains = chainsHere();
    isCrisp = chains !== undefined && !map.roughCurves;  // else cells are drawn as they are
    paintCells(context);
    if (!rough) paintIsolines(context);
    paintCliffs(context);
    paintAxes(context, frame, sx, sy, labelOf(map.axes[view.x]), labelOf(map.axes[view.y]));
    paintBar(context);
    paintTitle(context);
    paintPaper(context);
    paintPins(context);
  }

  /** The curves of the plane drawn, as pixels; undefined where its axes are not those that cliffs were looked
      for along, or a gait is shown, which has none of them. */
  function chainsHere() {
    if (view.field.gait) return undefined;
    const unit = (axis) => perUnit(axis.unit), chains = [];
    let looked = false;
    for (const curve of map.curves) {
      const [a, b] = curve.axes, swapped = a === view.y && b === view.x;
      if (!swapped && (a !== view.x || b !== view.y)) continue;
      looked = true;
      if (Object.entries(curve.at).some(([k, i]) => view.index[k] !== i)) continue;
      const [us, vs] = swapped ? [curve.y, curve.x] : [curve.x, curve.y];
      chains.push({ kind: curve.kind,
        places: us.flatMap((u, k) =>
        [sx.pixel(u * unit(map.axes[view.x])), sy.pixel(vs[k] * unit(map.axes[view.y]))]) });
    }
    return looked ? chains : undefined;
  }

  /** What tells colours as canvases store them, red first in memory: (value, design). Where the first
      lift-off is below the threshold they are nearly grey. */
  function colouring() {
    // What fails is dimmed towards the ground.
    const { table, place } = view.field, own = isOfFirstJump(view.field), back = rgbOf(tones.ground);
    const word = (rgb, dim) => rgb.map((v, at) => back[at] + (v - back[at]) * dim)
      .reduceRight((all, v) => all << 8 | v, 255) >>> 0;
    const shades = [1, 0.2].map((dim) =>
      [(rgb) => rgb, muted].map((tone) =>
      Uint32Array.from({ length: 256 }, (_, c) => word(tone([...table.subarray(3 * c, 3 * c + 3)]), dim))));
    const others = [1, 0.2].map((dim) =>
      ({ grey: word([217, 217, 217], dim), white: word([255, 255, 255], dim),
      statuses: status?.rgb.map((rgb) => word(rgb, dim)) }));
    return (value, k) => {
      const dimmed = map.keeps && !map.keeps(k) ? 1 : 0;
      if (value === value)
        return shades[dimmed][flags && own && flags.values[k] === 1 ? 1 : 0][Math.round(255 * place(value))];
      return status ? others[dimmed].statuses[status.values[k]] ?? others[dimmed].white : others[dimmed].grey;
    };
  }

  /** Fills the frame; pixels is then what every pixel shows: within the curves of its cell, or its cell's. */
  function paintCells(context) {
    const { x0, y0, w, h } = box, image = context.createImageData(w, h),
      data = new Uint32Array(image.data.buffer), { values } = view.field;
    const colourOf = colouring();
    if (isCrisp) {
      // Of hoops as made values are smooth across the cliffs of hoops as drawn.
      pixels = crispPlane(values, offset, sx, sy, box, view.field.made ? []
        : chains.map((chain) => chain.places));
      for (let pixel = 0; pixel < w * h; ++pixel)
        data[pixel] = colourOf(pixels.value[pixel], pixels.design[pixel]);
    } else {
      // One colour a design, of which there are fewer than pixels.
      const design = new Int32Array(w * h),
        columns = Int32Array.from({ length: w }, (_, p) => sx.index(x0 + p + 0.5)),
        colours = new Uint32Array(sx.n);
      const at = new Int32Array(sx.n), [r, g, b] = rgbOf(tones.ground),
        none = (255 << 24 | b << 16 | g << 8 | r) >>> 0;
      let done = -1;
      for (let q = 0, pixel = 0; q < h; ++q) {
        const j = sy.index(y0 + q + 0.5);
        if (j >= 0 && j !== done) {
          for (let i = 0; i < sx.n; ++i) {
            at[i] = offset(i, j);
            colours[i] = colourOf(values[at[i]], at[i]);
          }
          done = j;
        }
        for (let p = 0; p < w; ++p, ++pixel) {
          const i = columns[p];
          design[pixel] = i >= 0 && j >= 0 ? at[i] : -1;
          data[pixel] = design[pixel] < 0 ? none : colours[i];
        }
      }
      pixels = { design };
    }
    context.putImageData(image, x0, y0);
  }

  /** Isolines: at(level), each [x, y, x, y, ...] in pixels; between designs, or, within curves, between every
      other pixel. */
  function isolinesHere() {
    if (isCrisp) {
      const step = 2, { x0, y0, w, h } = box, at = (i, j) => step * j * w + step * i;
      const torn = (i, j) => pixels.torn[at(i, j)];
      const near = (i, j) => torn(i, j) | torn(i + 1, j) | torn(i, j + 1) | torn(i + 1, j + 1);
      const centre = (first) => (i) => first + step * i + 0.5;
      const plane = planeOf((i, j) => pixels.value[at(i, j)], Math.ceil(w / step), Math.ceil(h / step));
      return (level) => isolines(plane, level, centre(x0), centre(y0), near);
    }
    const bitX = 1 << view.x, bitY = 1 << view.y;
    const has = (i, j, bits) => (cliffs.values[offset(i, j)] & bits) !== 0;
    const torn = (i, j) => cliffs !== undefined && isOfFirstJump(view.field) &&
      (has(i, j, bitX | bitY) || has(i + 1, j, bitY) || has(i, j + 1, bitX));
    const plane = planeOf((i, j) => view.field.values[offset(i, j)], sx.n, sy.n);
    return (level) => isolines(plane, level, sx.centre, sy.centre, torn);
  }

  function paintIsolines(context) {
    const { font } = frame, { ink } = view.field;
    context.lineWidth = 1.1 * frame.ratio;
    context.strokeStyle = context.fillStyle = ink;
    context.font = `${0.85 * font}px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = "center";
    context.textBaseline = "middle";
    const labels = [], linesAt = isolinesHere();  // where there is text already
    for (const { value, text } of shownLevels(view.field, scaleOf(map, view.field)))
      for (const chain of linesAt(value)) {
        const room = context.measureText(text).width + 0.4 * font;
        let length = 0;
        for (let k = 2; k < chain.length; k += 2)
          length += Math.hypot(chain[k] - chain[k - 2], chain[k + 1] - chain[k - 1]);
        // A label in the middle of a line long enough for it, away from others.
        let label = null;
        if (length > 4 * room) {
          let gone = 0;
          for (let k = 2; k < chain.length && label === null; k += 2) {
            gone += Math.hypot(chain[k] - chain[k - 2], chain[k + 1] - chain[k - 1]);
            const [x, y] = [chain[k], chain[k + 1]];
            if (gone > 0.35 * length && labels.every(([u, v]) => Math.hypot(x - u, y - v) > 2.6 * font) &&
                x > frame.left + room && x < frame.right - room) label = [x, y];
          }
        }
        context.beginPath();
        for (let k = 0; k < chain.length; k += 2) {
          const hidden = label !== null
            && Math.hypot(chain[k] - label[0], chain[k + 1] - label[1]) < 0.55 * room;
          if (hidden || k === 0) context.moveTo(chain[k], chain[k + 1]);
          else context.lineTo(chain[k], chain[k + 1]);
        }
        context.stroke();
        if (label) { context.fillText(text, ...label); labels.push(label); }
      }
  }

  /** Curves that came after the picture that they belong to. */
  function overlayCliffs() {
    if (!frame) return;
    chains = chainsHere();
    paintCliffs(background.getContext("2d"));
    paintCursor();
  }

  /** Where outcomes jump, as leapmap boundaries found it. */
  function paintCliffs(context) {
    context.save();
    context.beginPath();
    context.rect(frame.left, frame.top, frame.right - frame.left, frame.bottom - frame.top);
    context.clip();
    for (const { kind, places } of chains ?? [])
      for (const [colour, width, dashes] of [["#ffffffa0", 2.6, []], ["#303030", 1.2, DASHES[kind] ?? []]]) {
        context.strokeStyle = colour;
        context.lineWidth = width * frame.ratio;
        context.setLineDash(dashes.map((d) => d * frame.ratio));
        context.beginPath();
        for (let k = 0; k < places.length; k += 2) context.lineTo(places[k], places[k + 1]);
        context.stroke();
      }
    context.restore();
  }

  /** The colour scale, with its isolines, and published jumpers beside agility. */
  function paintBar(context) {
    const { top, bottom, right, font } = frame, field = view.field;
    const x = right + 0.8 * font, w = 0.9 * font, h = bottom - top;
    const jumpers = field.name === "agility" ? Object.entries(map.jumpers) : [];
    for (let q = 0; q < h; ++q) {
      const c = 3 * Math.round(255 * (1 - q / h));
      context.fillStyle = `rgb(${field.table[c]},${field.table[c + 1]},${field.table[c + 2]})`;
      context.fillRect(x, top + q, w, 1.5);
    }
    context.font = `${0.85 * font}px system-ui, "DejaVu Sans", sans-serif`;
    context.textAlign = "left";
    context.textBaseline = "middle";
    const placeOf = (value) => bottom - h * field.place(value);
    let last = Infinity;
    const mark = (value, text, colour) => {
      const p = placeOf(value);
      context.fillStyle = context.strokeStyle = colour;
      context.beginPath();
      context.moveTo(x, p);
      context.lineTo(x + w, p);
      context.stroke();
      context.fillText(text, x + w + 0.3 * font, p);
    };
    const [factor, unit] = shownIn(field.unit, scaleOf(map, field)), told = (value, digits = 3) =>
      ({ value, text: short(value * factor, digits) });
    const marks = field.levels.length > 0 ? shownLevels(field, scaleOf(map, field))
      : linearTicks(field.low * factor, field.high * factor).map((v) => told(v / factor, 4));
    for (const { value, text } of [told(field.low),
        ...marks.filter((m) => m.value > field.low && m.value < field.high), told(field.high)]) {
      const p = placeOf(value);
      if (last - p < 0.95 * font && value !== field.low) continue;
      if (jumpers.some(([, v]) => Math.abs(placeOf(v) - p) < 0.9 * font)) continue;
      last = p;
      mark(value, (value === field.high && field.most > field.high ? "≥ " : "") + text, tones.ink);
    }
    const beyond = jumpers.filter(([, value]) => value > field.high);
    for (const [name, value] of jumpers) if (value <= field.high)
      mark(value, `${name} ${short(value * factor)}`, tones.mark);
    // What is beyond the map's own scale is told below it, and how colours go with values, where it is not
    // evenly.
    const notes = [...(unit ? [unit] : []),
      ...beyond.map(([name, value]) => `${name} ${short(value * factor)} ↑`),
      ...(field.log ? ["log scale"] : field.exponent !== 1 ? [`power ${field.exponent}`] : [])];
    context.fillStyle = tones.ink;
    notes.forEach((note, k) => context.fillText(note, x, bottom + (1 + k) * font));
  }

  /** What is drawn, of which hoops: a picture that is saved says it itself. */
  function paintTitle(context) {
    const { left, top, right, font } = frame, drawn = [map.axes[view.x].name, map.axes[view.y].name];
    const values = designAt(map, view.index);
    const told = Object.entries(map.parameters)
      .filter(([name]) => !drawn.includes(name) && Number.isFinite(values[name])
      && !(map.axes.some((axis) => isDrawn(axis.name)) && RATIOS.includes(name))
      && (map.slips || !SLIPPING.includes(name)) && !NO_LIVE_AXIS.includes(name))
      .map(([name, row]) => `${row.symbol} ${withUnit(short(inShownUnit(row, values[name])), row.unit)}`);
    const scene = Object.entries(SCENE_WORDS)
      .filter(([name]) => name === "radius" || values[name] !== map.defaults[name])
      .filter(([name]) => map.slips || !SLIPPING.includes(name))
      .map(([name, tell]) => tell(short(values[name])));
    const text = `${fieldLabel(view.field, scaleOf(map, view.field))}: ` +
      `${[...told, ...scene, map.slips ? "Coulomb friction" : "no slip"].join(", ")}`, size = (part) =>
      `${part * font}px system-ui, "DejaVu Sans", sans-serif`;
    context.fillStyle = tones.ink;
    context.textAlign = "left";
    context.textBaseline = "alphabetic";
    context.font = size(0.85);
    context.font = size(Math.max(0.5,
      Math.min(0.85, 0.85 * (right + 6 * font - left) / context.measureText(text).width)));
    context.fillText(text, left, top - 0.6 * font);
  }

  /** Where the paper's hoop is on the screen, or null. */
  function paperPlace() {
    if (map.slips || !frame) return null;
    const near = (a, b) => Math.abs(a - b) <= 1e-6 * Math.max(1, Math.abs(b));
    const here = designAt(map, view.index), drawn = [map.axes[view.x].name, map.axes[view.y].name];
    if (!drawn.every((name) => name in map.paper) || Object.entries(map.paper)
        .some(([k, v]) => !drawn.includes(k) && !near(here[k], v))) return null;
    const unit = (axis) => perUnit(axis.unit);
    const x = sx.pixel(map.paper[drawn[0]] * unit(map.axes[view.x])),
      y = sy.pixel(map.paper[drawn[1]] * unit(map.axes[view.y]));
    return x > frame.left && x < frame.right && y > frame.top && y < frame.bottom ? [x, y] : null;
  }

  function paintPaper(context) {
    const place = paperPlace();
    if (!place) return;
    const [x, y] = place;
    context.beginPath();
    for (let k = 0; k < 10; ++k) {
      const r = (k % 2 === 0 ? 0.75 : 0.32) * frame.font, a = -Math.PI / 2 + k * Math.PI / 5;
      context.lineTo(x + r * Math.cos(a), y + r * Math.sin(a));
    }
    context.closePath();
    context.fillStyle = "#d62728";
    context.strokeStyle = "#ffffff";
    context.lineWidth = 1.4 * frame.ratio;
    context.fill();
    context.stroke();
  }

  /** Pinned designs with their numbers; faint where anything but the two axes drawn is another. */
  function paintPins(context) {
    const { font, ratio } = frame, drawn = [map.axes[view.x], map.axes[view.y]], unit = (axis) =>
      perUnit(axis.unit), here = designAt(map, view.index);
    map.pins?.forEach((design, i) => {
      const [x, y] = [sx, sy].map((scale, k) => scale.pixel(design[drawn[k].name] * unit(drawn[k])));
      if (!(x >= frame.left && x <= frame.right && y >= frame.top && y <= frame.bottom)) return;
      context.globalAlpha = Object.keys(here)
        .every((name) => drawn.some((axis) => axis.name === name)
        || !(Math.abs(here[name] - design[name]) > 1e-9 * Math.abs(here[name]))) ? 1 : 0.45;
      context.beginPath();
      context.arc(x, y, 0.62 * font, 0, 2 * Math.PI);
      context.fillStyle = PIN_COLOURS[i];
      context.strokeStyle = "#ffffff";
      context.lineWidth = 1.5 * ratio;
      context.fill();
      context.stroke();
      context.fillStyle = PIN_INKS[i];
      context.font = `bold ${0.85 * font}px system-ui, "DejaVu Sans", sans-serif`;
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.fillText(String(i + 1), x, y);
      context.globalAlpha = 1;
    });
  }

  /** The line of a cut, from A to B. */
  function paintLine(context) {
    const ends = view.line.map((index) => [sx.centre(index[view.x]), sy.centre(index[view.y])]);
    for (const [colour, width] of [["#ffffff", 4], ["#000000", 1.8]]) {
      context.strokeStyle = context.fillStyle = String(colour);
      context.lineWidth = Number(width) * frame.ratio;
      context.beginPath();
      for (const end of ends) context.lineTo(...end);
      context.stroke();
    }
    context.font = `bold ${frame.font}px system-ui, "DejaVu Sans", sans-serif`;
    context.strokeStyle = "#ffffff";
    ends.forEach(([x, y], k) => {
      context.strokeText("AB"[k], x + 0.4 * frame.font, y - 0.4 * frame.font);
      context.fillText("AB"[k], x + 0.4 * frame.font, y - 0.4 * frame.font);
    });
  }

  function paintCursor() {
    if (!frame) return;
    const context = canvas.getContext("2d"), { font, ratio } = frame;
    context.drawImage(background, 0, 0);
    const cross = (index, colour, width) => {
      const x = sx.centre(index[view.x]), y = sy.centre(index[view.y]), r = 0.55 * font;
      context.lineWidth = width * ratio;
      context.strokeStyle = colour;
      context.beginPath();
      context.arc(x, y, r, 0, 2 * Math.PI);
      for (const [u, v] of [[1, 0], [-1, 0], [0, 1], [0, -1]]) {
        context.moveTo(x + u * r, y + v * r);
        context.lineTo(x + 1.8 * u * r, y + 1.8 * v * r);
      }
      context.stroke();
    };
    if (view.picked && view.picked.every((i, k) => k === view.x || k === view.y || i === view.index[k])) {
      cross(view.picked, "#ffffff", 4);
      cross(view.picked, "#d62728", 2);
    }
    cross(view.index, "#ffffff", 4);
    cross(view.index, "#000000", 1.6);
    if (view.line) paintLine(context);
  }

  function pointAt(event) {
    const box = canvas.getBoundingClientRect();
    if (!frame) return false;
    const i = sx.index((event.clientX - box.left) * canvas.width / box.width),
      j = sy.index((event.clientY - box.top) * canvas.height / box.height);
    if (i < 0 || j < 0) return false;
    view.index[view.x] = i;
    view.index[view.y] = j;
    return true;
  }
  const { point, pick } = pointing(canvas, view, {
    pointAt, paintCursor, onPoint, onPick,
    goBack() {
      const aside = (i, k) => k !== view.x && k !== view.y && i !== view.index[k];
      if (view.picked.some(aside)) return false;
      for (const k of [view.x, view.y]) view.index[k] = view.picked[k];
      return true;
    },
    step(key, by) {
      const move = { ArrowLeft: [view.x, -by], ArrowRight: [view.x, by], ArrowDown: [view.y, -by],
        ArrowUp: [view.y, by] }[key];
      if (!move) return false;
      view.index[move[0]] = clamped(view.index[move[0]] + move[1], shape[move[0]] - 1);
      return true;
    },
  });
  new ResizeObserver(() => paint()).observe(canvas);

  /** The next stretch that is dragged over the map is view.line, [from, to] as indices; drawn(): it is
      another. */
  function takeLine(drawn) {
    const events = new AbortController(), { signal } = events;
    const move = () => { view.line[1] = [...view.index]; paintCursor(); drawn(); };
    canvas.style.touchAction = "none";
    canvas.addEventListener("pointerdown", (event) => {
      if (!pointAt(event)) return;
      canvas.setPointerCapture(event.pointerId);
      view.line = [[...view.index], [...view.index]];
      canvas.addEventListener("pointermove", (other) => { if (pointAt(other)) move(); }, { signal });
      canvas.addEventListener("pointerup",
        () => { canvas.style.touchAction = ""; events.abort(); }, { signal });
      // It is no click on a design.
      canvas.addEventListener("click", (click) => click.stopImmediatePropagation(),
        { capture: true, once: true });
    }, { signal });
  }

  return {
    /** Where the colour bar and its numbers are on the canvas [CSS pixels], or null while it is not shown. */
    bar() {
      if (!frame) return null;
      const { top, bottom, right, font, ratio } = frame, left = (right + 0.8 * font) / ratio;
      return { left, top: top / ratio, width: canvas.width / ratio - left, height: (bottom - top) / ratio };
    },
    view, paint, paintOn, overlayCliffs, pick, point, takeLine, showsPaper: () => paperPlace()
      !== null, offset: (index) => index.reduce((sum, i, k) => sum + i * strides[k], 0),
    /** What the map's pixels are, for tests: the design whose codes each shows, and where its centre lies
        along the axes. */
    shown() {
      const { x0, y0, w, h } = box, places = (scale, first, count) =>
        Array.from({ length: count }, (_, p) => scale.value(first + p + 0.5));
      return { design: [...pixels.design], x: places(sx, x0, w), y: places(sy, y0, h) };
    },
    /** Where a design's cell is on the screen, for tests. */
    placeOf(index) {
      const box = canvas.getBoundingClientRect();
      return [box.left + sx.centre(index[view.x]) * box.width / canvas.width,
        box.top + sy.centre(index[view.y]) * box.height / canvas.height];
    },
  };
}
