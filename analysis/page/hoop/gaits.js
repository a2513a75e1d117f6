// Where jump after jump leads: how high hoops jump once they have settled, over one parameter of theirs, as a
// density.

import { element, option, stepsOf } from "../dom.js";
import { saveButtons } from "../export/export.js";
import { linearTicks, tickTexts } from "../map/scales.js";
import { onTones, rgbOf, tones } from "../state/tones.js";
import { perUnit, short, shownIn, withUnit } from "../state/units.js";

const SETTLE = 200, KEEP = 100;  // jumps of each hoop that are let go by, and that are drawn
const COLUMNS = 512, ROWS = 320, MOST_AT_ONCE = 16;  // hoops, and heights told apart
export const SLICE = 14;  // ms of computing between two pictures
const OVER = { slope: [0.05, 0.6], mass_ratio: [0.2, 12], offset_ratio: [0.05, 1], inertia_factor: [0.5, 1],
  release_angle: [-Math.PI, Math.PI], release_spin: [0, 5], drive_torque: [0, 0.2],
  resisting_torque: [0, 0.1] };

/** Columns from coarse to fine: those of a level lie evenly between those before. */
function* columnsInOrder() {
  for (let step = 64, first = 0; step >= 1; step /= 2, first = step)
    for (let begin = first; begin < COLUMNS; begin += MOST_AT_ONCE * (first ? 2 : 1) * step) {
      const stride = (first ? 2 : 1) * step;
      yield { begin, stride, count: Math.min(MOST_AT_ONCE, Math.ceil((COLUMNS - begin) / stride)),
        width: step };
    }
}

/** The part of the page that draws it, once it is opened. choose(parameter, value): shows the hoop that was
    clicked. Returns show(design). */
export function gaitsPart(map, solver, choose) {
  const part = element("gaits"), canvas = element("gaits-picture"), over = element("gaits-over"),
    told = element("gaits-told");
  const inputs = { from: element("gaits-from"), to: element("gaits-to") };
  const now = { design: null, heights: [], width: COLUMNS, frame: 0, work: null };
  const names = Object.keys(OVER).filter((name) => name in map.parameters);
  names.forEach((name) => option(over, name, map.parameters[name].label));

  const unit = () => map.parameters[over.value];
  const factor = () => perUnit(unit().unit);
  const bounds = () =>
    [inputs.from, inputs.to].map((input) => (input.value === "" ? NaN : Number(input.value) / factor()));
  function setBounds() {
    const [from, to] = OVER[over.value];
    inputs.from.value = Number((from * factor()).toPrecision(4));
    inputs.to.value = Number((to * factor()).toPrecision(4));
  }

  /** Where the picture has its frame: pixels, and the canvas scaled to the screen. */
  function frame() {
    const ratio = window.devicePixelRatio || 1, box = canvas.getBoundingClientRect(), font = 12 * ratio;
    return { ratio, box, font, left: 4.5 * font, right: canvas.width - font, top: 0.6 * font,
      bottom: canvas.height - 3 * font };
  }

  function draw() { drawOn(canvas); }

  function drawOn(canvas) {
    const ratio = window.devicePixelRatio || 1, size = canvas.getBoundingClientRect();
    canvas.width = Math.max(1, Math.round(size.width * ratio));
    canvas.height = Math.max(1, Math.round(size.height * ratio));
    const { font, left, right, top, bottom } = frame(), context = canvas.getContext("2d"),
      [from, to] = bounds();
    let most = 0;
    for (const column of now.heights) for (const height of column ?? []) if (height > most) most = height;
    most = most > 0 ? 1.05 * most : 1;
    const ink = rgbOf(tones.data), image = new ImageData(COLUMNS, ROWS), hits = new Uint32Array(ROWS);
    for (let column = 0; column < COLUMNS; ++column) {
      // A coarse picture: what lies to the left is drawn on until the column itself is there.
      let source = column;
      while (source > column - now.width && !now.heights[source]) --source;
      if (!now.heights[source]) continue;
      hits.fill(0);
      for (const height of now.heights[source]) {
        if (!(height >= 0)) continue;
        const row = Math.min(ROWS - 2, Math.floor(height / most * ROWS));
        ++hits[row];
        ++hits[row + 1];  // one row alone is hard to see
      }
      for (let row = 0; row < ROWS; ++row) {
        if (!hits[row]) continue;
        const at = 4 * ((ROWS - 1 - row) * COLUMNS + column),
          shade = 0.35 + 0.65 * Math.log(1 + hits[row]) / Math.log(1 + KEEP);
        image.data.set([...ink, 255 * shade], at);
      }
    }
    const ready = document.createElement("canvas");  // which SVG can hold
    [ready.width, ready.height] = [COLUMNS, ROWS];
    ready.getContext("2d").putImageData(image, 0, 0);
    context.imageSmoothingEnabled = false;
    context.drawImage(ready, left, top, right - left, bottom - top);
    context.strokeStyle = tones.frame;
    context.strokeRect(left, top, right - left, bottom - top);
    context.font = `${font}px system-ui, "DejaVu Sans", sans-serif`;
    context.fillStyle = tones.ink;
    context.textAlign = "right";
    context.textBaseline = "middle";
    const [height, heightUnit] = now.design ? shownIn("diameters", now.design) : [1, "diameters"];
    const heights = linearTicks(0, most * height, 5), texts = tickTexts(heights);
    for (const [i, tick] of heights.entries())
      context.fillText(texts[i], left - 0.4 * font, bottom - (bottom - top) * tick / height / most);
    context.textAlign = "center";
    context.textBaseline = "top";
    const along = linearTicks(from * factor(), to * factor(), 8), textsAlong = tickTexts(along);
    for (const [i, tick] of along.entries())
      context.fillText(textsAlong[i], left + (right - left) * (tick / factor() - from) / (to - from),
        bottom + 0.3 * font);
    context.fillText(withUnit(unit().label, unit().unit ? `[${unit().unit}]` : ""), (left + right) / 2,
      bottom + 1.6 * font);
    context.save();
    context.translate(font, (top + bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.fillText(`jump height [${heightUnit}]`, 0, -0.6 * font);
    context.restore();
    const here = now.design ? (now.design[over.value] - from) / (to - from) : NaN;
    if (here >= 0 && here <= 1) {
      context.strokeStyle = tones.mark;
      context.beginPath();
      context.moveTo(left + (right - left) * here, top);
      context.lineTo(left + (right - left) * here, bottom);
      context.stroke();
    }
    const done = now.heights.filter((column) => column).length,
      lively = now.heights.filter((column) => column && !Number.isNaN(column[0])).length;
    told.textContent = `${lively} of ${done} hoops still jump after ${SETTLE} jumps`;
    Object.assign(canvas.dataset, { hoops: done, lively });
  }

  /** Computes on, a slice at a time. */
  function step() {
    const begun = performance.now(), [from, to] = bounds();
    while (performance.now() - begun < SLICE) {
      const { value, done } = now.work.next();
      if (done) { now.width = 1; draw(); return; }
      const at = (column) => from + (to - from) * column / (COLUMNS - 1),
        last = value.begin + (value.count - 1) * value.stride;
      const heights = solver.bifurcate(now.design, map.slips, map.tolerance,
        { parameter: over.value, from: at(value.begin), to: at(last), count: value.count, settle: SETTLE,
          keep: KEEP });
      for (let k = 0; k < value.count; ++k) now.heights[value.begin + k * value.stride] =
          heights.subarray(k * KEEP, (k + 1) * KEEP);
      now.width = value.width * 2;
    }
    draw();
    now.frame = requestAnimationFrame(step);
  }

  function begin() {
    cancelAnimationFrame(now.frame);
    now.heights = [];
    if (!part.open || !now.design) return;
    const [from, to] = bounds(), [least, most] = solver.ranges[over.value];
    const good = to > from && from >= least && to <= most;
    for (const input of Object.values(inputs)) input.setAttribute("aria-invalid", String(!good));
    if (!good) { draw();
        told.textContent = `from must be below to, between ${short(least * factor())} and ` +
        `${short(most * factor())}`; return; }
    now.heights = new Array(COLUMNS).fill(null);
    now.work = columnsInOrder();
    step();
  }

  over.addEventListener("change", () => { setBounds(); begin(); });
  for (const input of Object.values(inputs)) {
    input.addEventListener("change", begin);
    stepsOf(input, () => (OVER[over.value][1] - OVER[over.value][0]) * factor());
  }
  part.addEventListener("toggle", begin);
  canvas.addEventListener("click", (event) => {
    const { box, left, right } = frame(), [from, to] = bounds();
    const place = ((event.clientX - box.left) * canvas.width / box.width - left) / (right - left);
    if (now.design && place >= 0 && place <= 1) choose(over.value, from + (to - from) * place);
  });
  canvas.addEventListener("keydown", (event) => {
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key], [from, to] = bounds();
    if (!way || !now.design) return;
    event.preventDefault();
    choose(over.value, Math.min(to,
      Math.max(from, now.design[over.value] + way * (event.shiftKey ? 10 : 1) * (to - from) / 200)));
  });
  saveButtons("gaits", canvas, () => `jump_after_jump_over_${over.value}`, drawOn);
  new ResizeObserver(() => { if (part.open && now.heights.length > 0) draw(); }).observe(canvas);
  setBounds();
  onTones(() => { if (part.open && now.heights.length > 0) draw(); });

  /** What the picture is of, but for the one parameter: nothing is computed anew if that alone is another. */
  const keyOf = (design) =>
    JSON.stringify([map.slips, ...Object.entries(design)
    .filter(([name]) => name !== over.value && name !== "radius")]);
  return (design) => {
    const same = now.design && keyOf(design) === keyOf(now.design);
    now.design = { ...design };
    if (!same || now.heights.length === 0) begin();
    else if (part.open) draw();
  };
}
