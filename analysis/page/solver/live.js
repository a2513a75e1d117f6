// A live map: a grid over any two parameters, solved as one looks by leapmap itself on all cores, coarse at
// once and then finer.

import { complain, notice } from "../dom.js";
import { drawnParameters } from "../state/drawn.js";
import {
  LIVE_SHAPE, OUTCOME_CODES, cliffCurves, cliffEdges, edgeBegins, edgeEnds, outcomesDiffer,
} from "./live_cliffs.js";
import { USUAL_SPREADS, madeAsked } from "./made.js";
import { linearTicks, logTicks, scaleField } from "../map/scales.js";
import { rgbOf } from "../state/tones.js";
const COARSEST = 8;  // cells a side of the blocks that the first picture has
const SLOW = 2000;   // what a hoop costs (costEach) of which a job is one
const REST = 150;
/** What a field that takes many jumps, or many hoops of each, wants asked; it has numbers only while it is
    shown, or a goal. */
export const costOf = (field) =>
  (field.made ? "made" : field.gait ? "settle" : field.name === "sequence_condition" ? "growth" : null);

/** A map as the explorer writes them, without a number yet. given: {looks, statuses, parameters, ...}; state:
    {x, y, slips, fixed}. */
export function liveMap(given, solver, state) {
  const n = LIVE_SHAPE[0] * LIVE_SHAPE[1];
  const fields = given.looks.map((look) => ({
    ...look, step: 1e-6, table: Uint8Array.from(atob(look.colours), (c) => c.charCodeAt(0)),
    values: new Float64Array(n).fill(NaN),
    given: look.levels, low: 0, high: 1, most: 1, place: () => 0,
  }));
  const meanings = solver.codes.status,
    shown = meanings.map((word) => given.statuses[word] ?? { colour: "#ffffff", words: word });
  const map = {
    ...given, live: true, name: "leapmap", title: "Jumps of hoops, computed while you explore", designs: n,
    computed: 1, slips: state.slips, method: "exact", tolerance: 1e-10,
    parameters: { ...given.parameters, ...drawnParameters(state.drawing) },
    fixed: { ...solver.defaults, ...state.fixed }, drawing: state.drawing,
    fields, curves: [], goals: [], objectives: [], left_out: [], about: [], jumps: 1, settle: 100,
    samples: 256, seed: 1, spreads: USUAL_SPREADS,
    solver, asked: { jumps: 1, settle: 0, growth: false, made: null }, wanted: () => [], hoopGoals: () => [],
    codes: {
      status: { meanings, shown, rgb: shown.map(({ colour }) => rgbOf(colour)), values: new Uint8Array(n) },
      spurious_first_jump: { values: new Uint8Array(n).fill(255) }, candidates: { values: new Uint8Array(n) },
      cliffs: { values: new Uint8Array(n) },
    },
  };
  map.axes = [state.x, state.y].map((axis) => liveAxis(map, axis));
  return map;
}

/** What the solver is to be asked of each hoop of a live map, so that all that is wanted has numbers. */
export function toAsk(map) {
  const wants = (what) => map.wanted().some((field) => costOf(field) === what);
  return { jumps: map.jumps, settle: wants("settle") ? map.settle : 0, growth: map.jumps > 1
    && wants("growth"), made: wants("made") ? madeWanted(map) : null };
}
/** What hoops as made are asked by the tolerances and goals that a live map has now: what was asked last, if
    it is the same. */
function madeWanted(map) {
  const { made } = map.asked, isSame = (wanted) => JSON.stringify(wanted) === JSON.stringify(made),
    whole = madeAsked(map, map.hoopGoals());
  if (isSame(whole)) return made;
  // Without the yield: goals that change leave what is asked as it is.
  const wanted = map.wanted().some(({ name }) => name === "yield") ? whole : madeAsked(map, [], false);
  return isSame(wanted) ? made : wanted;
}
export const isAsMade = (map) => map.asked.made !== null && map.asked.made === madeWanted(map);
/**
 * What a hoop of the map costs, in whole first jumps, as measured: a jump of those let go by costs a fifth,
 * as its time is not asked for, and a hoop made an eighth, as little is told of each.
 */
export const costEach = ({ settle, growth, made }) =>
  1 + (settle > 0 ? 20 + settle / 5 : 0) + (growth ? 20 : 0)
  + (made ? made.samples / 8 * made.jumps * costEach({ ...made, made: null }) : 0);
export const isCostly = (asked) => costEach(asked) > 1;
/** Whether what is asked of each hoop tells a field. */
const isAsked = (map, field) =>
  (field.made ? Boolean(map.asked.made?.fields.includes(field.name)) : costOf(field) === null
  || Boolean(map.asked[costOf(field)]));
/** The fields of which a live map has, or will have, numbers. */
export function toldFields(map) {
  if (!map.live) return map.fields;
  const made = isAsMade(map);
  return map.fields.filter((field) => isAsked(map, field) && (!field.made || made));
}

/** An axis with its values, evenly from one bound to the other. */
export function liveAxis(given, { name, from, to, count }) {
  const { label, symbol, unit } = given.parameters[name];
  return { name, label, symbol, unit, log: false, from, to,
    values: Array.from({ length: count }, (_, i) => from + (to - from) * i / (count - 1)) };
}

/** The radius of a live map's hoop. */
function radiusAt(map, ...place) {
  const k = map.axes.findIndex(({ name }) => name === "hoop.diameter");
  return k < 0 ? map.fixed.radius : map.axes[k].values[place[k]] / 2;
}

/** Puts what rows tell of designs, cell by cell, into all fields: each in a block of `side` cells, but for
    cells that know better. */
function putRows(map, rows, cells, side, level) {
  const [nx, ny] = LIVE_SHAPE, names = [...map.solver.rowNames, ...(map.asked.made?.fields ?? [])],
    wide = names.length, column = (name) => names.indexOf(name);
  const [height, time, apex] = ["jump_height", "jump_time", "apex_time"].map(column),
    fields = map.fields.filter((field) => isAsked(map, field)),
    columns = fields.map((field) => column(field.name));
  const codes = OUTCOME_CODES.map(([name, none]) =>
    ({ at: column(name), none, values: map.codes[name].values }));
  const told = new Float64Array(fields.length);
  for (const field of fields) field.isFilled = true;
  for (let n = 0; n < cells.length; ++n) {
    const at = cells[n], row = n * wide, i0 = Math.floor(at / ny), j0 = at % ny;
    for (let f = 0; f < told.length; ++f)
      told[f] = columns[f] >= 0 ? rows[row + columns[f]]
        : 2 * radiusAt(map, i0, j0) * rows[row + height] / (rows[row + time] + rows[row + apex]);
    for (let i = i0; i < Math.min(nx, i0 + side); ++i)
      for (let j = j0; j < Math.min(ny, j0 + side); ++j) {
        const k = i * ny + j;
        if (k !== at && level[k] <= side) continue;
        level[k] = k === at ? 0 : side;
        for (let f = 0; f < told.length; ++f) fields[f].values[k] = told[f];
        for (const code of codes) { const v = rows[row + code.at]; code.values[k] = v === v ? v : code.none; }
      }
  }
}

/** Scales and isolines after the values that are there, and the cells that differ from the next: cliffs. */
export function settleMap(map) {
  for (const field of map.fields) {
    if (field.isScaled && !field.isFilled) continue;
    field.isScaled = true;
    let low = Infinity, high = -Infinity;
    for (const v of field.values)
      if (v === v && (!field.log || v > 0)) { low = Math.min(low, v); high = Math.max(high, v); }
    if (!(low <= high)) [low, high] = field.log ? [1, 10] : [0, 1];
    scaleField(field, low, high, field.given
      ?? (field.log ? logTicks(low, high) : linearTicks(low, high, 12)));
    field.step = ["candidates", "jumps", "gait_period"].includes(field.name) ? 1
      : 10 ** Math.floor(Math.log10(Math.max(high - low, 1e-2) / 60000));
  }
  const [nx, ny] = LIVE_SHAPE, { cliffs } = map.codes, differ = outcomesDiffer(map);
  for (let i = 0; i < nx; ++i)
    for (let j = 0; j < ny; ++j) {
      const k = i * ny + j;
      cliffs.values[k] = (i + 1 < nx && differ(k, k + ny) ? 1 : 0) | (j + 1 < ny && differ(k, k + 1) ? 2 : 0);
    }
}

/**
 * Solves a live map on all cores, anew by begin(). onPicture(what): there is more to see: "part" of the map,
 * the "whole", or its "cliffs" too; or "none" of a new one yet, of which the numbers of the last are
 * "cleared" where it takes long. onProgress(share, left): of a map that takes many jumps, or many hoops of
 * each design, so much is solved, and the rest will take so long [s]; NaN: no more will be.
 */
export function liveEngine(map, module, workerText, onPicture, onProgress) {
  const [nx, ny] = LIVE_SHAPE, level = new Uint8Array(nx * ny);
  const url = URL.createObjectURL(new Blob([workerText], { type: "text/javascript" }));
  const now = { generation: 0, queue: [], left: [], edges: {}, rushing: false, again: false, begun: 0,
    solved: 0, resting: 0, shown: 0, cost: 0, timing: {} }, workers = [];
  const count = Math.max(1, Math.min(16, navigator.hardwareConcurrency || 2));

  /** Keeps two jobs with a worker, so that it never waits for this thread to paint. */
  function feed(worker) {
    while (worker.jobs.length < 2 && now.queue.length > 0) send(worker, now.queue.shift());
  }
  function feedAll() {
    for (const round of [0, 1])
      for (const worker of workers) if (worker.ready && worker.jobs.length <= round && now.queue.length > 0)
        send(worker, now.queue.shift());
  }

  function send(worker, job) {
    const { order, values: [xs, ys] } = now;
    worker.jobs.push(job);
    if (job.edges) {
      // to a hundredth of a cell; while one drags to some cells, and to one
      const steps = job.side === 1 ? 7 : map.slips ? 1 : 3;
      worker.postMessage({ ...order, ends: edgeEnds(xs, ys, job.edges), begins: edgeBegins(map, job.edges),
        codes: OUTCOME_CODES, steps });
      return;
    }
    const places = new Float64Array(2 * job.cells.length);
    job.cells.forEach((k, i) => { places[2 * i] = xs[Math.floor(k / ny)]; places[2 * i + 1] = ys[k % ny]; });
    worker.postMessage({ ...order, places });
  }

  /** Looks for cliffs: of the first picture between its few designs, before anything else, and once the whole
      map is there between all. */
  function beginCliffs(side) {
    const edges = cliffEdges(map, side),
      most = Math.min(map.slips ? 16 : 400, Math.max(1, Math.ceil(edges.length / count))), jobs = [];
    for (let first = 0; first < edges.length; first += most)
      jobs.push({ side, stage: now.left.length, edges: edges.slice(first, first + most) });
    now.edges[side] = edges;
    now.left.push(jobs.length);
    now.queue = side > 1 ? [...jobs, ...now.queue] : jobs;
    if (jobs.length === 0) endCliffs(side);
    feedAll();
  }

  function receiveCliffs(job, parts) {
    job.edges.forEach((edge, k) => { edge.part = parts[k]; });
    if (--now.left[job.stage] === 0) endCliffs(job.side);
  }

  function endCliffs(side) {
    const { generation } = now;
    map.curves = cliffCurves(map, now.edges[side], side);
    map.roughCurves = side > 1;
    if (side > 1) {
      now.rushing = false;
      onPicture("coarse discontinuities");
      if (now.again) begin(); else if (now.left.every((left) => left === 0)) goOn();
      return;
    }
    setTimeout(() => {  // the browser may listen first
      if (generation !== now.generation) return;
      now.timing.crisp = performance.now() - now.begun;
      onPicture("cliffs");
    });
  }

  function show(what) {
    const begun = performance.now();
    settleMap(map);
    if (what === "whole") map.curves = [];  // those of the first picture are too rough for it
    onPicture(what);
    now.shown = performance.now();
    now.cost = now.shown - begun;
  }

  function receive(worker, { data }) {
    if (data.ready) { worker.ready = true; feed(worker); return; }
    const job = worker.jobs.shift();
    feed(worker);
    if (data.error) {
      notice(`Solving the map has stopped: ${data.error}`);
      if (data.generation !== now.generation) return;
      Object.assign(now, { generation: now.generation + 1, queue: [], rushing: false });
      if (now.again) begin(); else onProgress(NaN, 0);
      return;
    }
    if (data.generation !== now.generation) return;
    if (job.edges) { receiveCliffs(job, data.rows); return; }
    putRows(map, data.rows, job.cells, job.side, level);
    now.solved += job.cells.length;
    if (isCostly(map.asked))
      onProgress(now.solved / (nx * ny), (performance.now() - now.begun) / 1000 * (nx * ny / now.solved - 1));
    const last = --now.left[job.stage] === 0;
    if (last && job.stage === 0) {
      now.timing = { coarse: performance.now() - now.begun };
      map.curves = [];
      beginCliffs(COARSEST);
      if (data.generation === now.generation) show("part");  // else there were none, and another map is begun
    } else if (!now.rushing && now.left[0] === 0) goOn();  // the first picture has its cliffs
  }

  /** More designs are there. */
  function goOn() {
    const whole = now.left.every((left) => left === 0);
    if (whole) Object.assign(now.timing, { full: performance.now() - now.begun, designs: nx * ny });
    // Pictures take longer than designs: of those between the first and the last no more than take a fifth of
    // the time.
    if (whole || performance.now() - now.shown > Math.max(250, 5 * now.cost)) show(whole ? "whole" : "part");
    if (whole) now.resting = setTimeout(() => beginCliffs(1), REST);
  }

  function newWorker() {
    const worker = new Worker(url);
    Object.assign(worker, { jobs: [], ready: false });
    worker.onmessage = (event) => receive(worker, event);
    worker.onerror = (event) => complain(event);
    worker.postMessage({ module });
    return worker;
  }
  for (let i = 0; i < count; ++i) workers.push(newWorker());

  /** Of what one job may take seconds nobody waits for the end. */
  function dropSlowJobs() {
    if (!now.order || costEach(now.order.asked) <= SLOW) return;
    workers.forEach((worker, i) =>
      { if (worker.jobs.length > 0) { worker.terminate(); workers[i] = newWorker(); } });
  }

  /**
   * Throws away what is under way and starts again, coarse first; but a first picture that is begun is shown
   * first, however often a slider tells, unless it takes a second or more.
   */
  function begin() {
    now.again = now.rushing;
    if (now.rushing) return;
    dropSlowJobs();
    map.asked = toAsk(map);
    now.rushing = !isCostly(map.asked) || (!map.slips && costEach(map.asked) <= 61);
    now.solved = 0;
    onProgress(1, 0);
    // Where the first picture takes its time, numbers of other settings do not stand until then.
    const clears = isCostly(map.asked) && !now.rushing;
    for (const field of map.fields) {
      if (!field.isFilled || (isAsked(map, field) && !clears)) continue;
      field.values.fill(NaN);
      field.isFilled = false;
    }
    if (clears) {
      map.curves = [];
      map.codes.status.values.fill(map.codes.status.meanings.indexOf("not_computed"));
      map.codes.spurious_first_jump.values.fill(255);
      for (const { values } of [map.codes.candidates, map.codes.cliffs]) values.fill(0);
    }
    onPicture(clears ? "cleared" : "none");
    // One picture is of one set of numbers, whatever is turned meanwhile.
    now.order = { generation: ++now.generation, design: { ...map.fixed, drawing: map.drawing },
      slips: map.slips, tolerance: map.tolerance, asked: map.asked, first: map.axes[0].name,
      second: map.axes[1].name };
    now.values = map.axes.map((axis) => axis.values);
    clearTimeout(now.resting);
    now.queue = [];
    now.left = [];
    now.begun = performance.now();
    level.fill(255);
    for (let side = COARSEST, stage = 0; side >= 1; side /= 2, ++stage) {
      const cells = [];
      for (let i = 0; i < nx; i += side)
        for (let j = 0; j < ny; j += side) if (side === COARSEST || i % (2 * side) || j % (2 * side))
          cells.push(i * ny + j);
      const most = Math.min(Math.max(1, Math.floor((map.slips ? 200 : 2000) / costEach(map.asked))),
        Math.ceil(cells.length / count));
      now.left.push(0);
      for (let first = 0; first < cells.length; first += most) {
        now.queue.push({ stage, side, cells: cells.slice(first, first + most) });
        ++now.left[stage];
      }
    }
    feedAll();
  }
  return { begin, timing: () => ({ ...now.timing }) };
}
