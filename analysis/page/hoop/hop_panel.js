// The part of the page that shows one hoop: its controls, numbers and command line.

import { addressPart, designOf, noteAddress, wordsOf } from "../state/address.js";
import { designAt, placeText } from "../map/described.js";
import { element, notice, stepsOf } from "../dom.js";
import { drawingPart } from "../inputs/drawing.js";
import { choicesOf, differInSize, heldUnit, isDrawn, lackedBy, spreadsOf } from "../state/drawn.js";
import { recorded, saveAs, saveButtons } from "../export/export.js";
import { SLICE, gaitsPart } from "./gaits.js";
import { gradientPart, hoopInputs } from "../inputs/hoop_inputs.js";
import { drawHoop } from "./hop_view.js";
import { toldFields } from "../solver/live.js";
import { madeAfter, madeAsked, reachesAll } from "../solver/made.js";
import { hopCommand, numberRows, tilesOf } from "../results/numbers.js";
import { pinsPart } from "../results/pins.js";
import { drawPlots } from "./plots.js";
import { NO_LIVE_AXIS, SLIPPING } from "../state/ranges.js";
import { onTones } from "../state/tones.js";
import { measuresOf, perUnit, short, units, withUnit } from "../state/units.js";

const STEADY_AFTER = 100;  // jumps, before it is looked whether one hoop's jumps are steady

/**
 * The part that shows one hoop: show(index) a design, stopAt(time) a moment of its motion, retell() it in
 * other units. ofItsOwn(title, outcome, design): a hoop is shown that is none of the map's designs;
 * otherUnits(): everything is to be told anew; pinned(): other designs are; followed(): a live map's hoops
 * are followed for another number of jumps; teller: tells of hoops as made; toldMore(outcome): more is known
 * of the hoop that is none of the map's.
 */
export function hopPanel(map, solver, { ofItsOwn, otherUnits, pinned, followed, teller, toldMore }) {
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const scene = element("scene"), plots = element("plots"), play = element("play"), scrub = element("scrub"),
    clock = element("clock");
  const radius = element("radius"), mass = element("mass"), table = element("numbers").tBodies[0],
    command = element("command");
  // source: where the design is from, "design" of the map, "paper" or "hoop" as typed, and which.
  const now = { design: null, fixed: null, source: ["", ""], story: null, ghosts: [], time: 0,
    playing: false, last: 0, frame: 0, timeAt: null, recording: false, haunting: 0 };
  const firstJumps = map.jumps;
  const weighed = map.mass ? 1000 * map.mass : "";  // g; "": unknown
  const kilograms = () => (mass.value === "" ? NaN : Number(mass.value) / 1000);
  mass.value = weighed;
  const chosen = { radius: map.fixed.radius, mass: kilograms(), jumps: map.jumps };  // m; kg
  units.mass = chosen.mass;
  radius.value = 1000 * chosen.radius;
  radius.parentElement.hidden = map.live;  // which has a slider for it
  const jumps = element("jumps");
  jumps.value = chosen.jumps;

  const showGaits = gaitsPart(map, solver, (name, value) => {
    const { label, unit } = map.parameters[name];
    typed({ ...now.design, [name]: value },
      `One hoop: ${label.toLowerCase()} ` +
      `${withUnit(short(value * perUnit(unit)), unit)}`);
  });
  const showInputs = hoopInputs(map, solver, (design) => typed(design)),
    showGradient = gradientPart(map, solver);
  const drawing = drawingPart(map, solver, (body, drawn, drawnBefore) => {
    const { radius: R, total_mass: kg, mass_ratio, offset_ratio, inertia_factor } = body;
    // What the map's hoops share in the SI stays what it is there.
    const from = { ...(drawnBefore ?? map.drawing), held: map.drawing?.held };
    const before = Object.entries(now.design ?? { ...map.fixed, ...map.paper })
      .filter(([name]) => !isDrawn(name))
      .map(([name, value]) => [name, value * heldUnit(solver, name, from, drawn)]);
    mass.value = Number((1000 * kg).toPrecision(12));
    chosen.mass = units.mass = kg;
    chosen.radius = R;
    if (map.live) map.redraw(drawn, { radius: R, mass_ratio, offset_ratio, inertia_factor });
    else radius.value = Number((1000 * R).toPrecision(12));
    typed({ ...Object.fromEntries(before), mass_ratio, offset_ratio, inertia_factor },
      "One hoop: from a drawing");
    otherUnits();
  });
  addressPart(drawing);

  const pins = pinsPart(map, solver, (design) => commandPieces(design).join(" "),
    () => { if (now.story) haunt(); pinned(); noteAddress(); });
  element("pin").addEventListener("click", () => { if (now.story) pins.pin(now.design); });
  element("pins-along").addEventListener("change", () => { if (now.story) haunt(); });

  const GHOSTS = 20, ghosts = element("ghosts");
  // How one looks at the hoop, by the address's words: what turns it, and how it stands at first.
  const ways = [["speed", element("speed")], ["close", element("follow")], ["forces", element("forces")],
    ["along", element("pins-along")], ["as_made", ghosts]]
    .map(([name, input]) => [name, input, input.type === "checkbox" ? input.checked : input.value]);
  for (const [, input] of ways) input.addEventListener("change", noteAddress);
  element("ghosts-label").hidden = map.spreads.length === 0 && !map.live;

  const end = () => Math.max(now.story?.motion.t.at(-1) ?? 0,
    ...now.ghosts.map(({ story }) => story.motion.t.at(-1) ?? 0));

  const plotOn = (canvas) =>
    drawPlots(canvas, now.story, now.ghosts.filter(({ pin }) => pin !== undefined), now.time, end(),
    measuresOf(now.design, chosen.mass).plots, now.design.radius);

  function draw() {
    if (!now.story || now.story.motion.t.length === 0) {
      for (const canvas of [scene, plots])
        canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
      clock.textContent = "it does not move";
      return;
    }
    drawHoop(scene, now.design, now.story, now.time, element("follow").checked, now.ghosts,
      element("forces").checked);
    now.timeAt = plotOn(plots);
    const [factor, unit] = measuresOf(now.design, chosen.mass).plots.t;
    clock.textContent = `${(now.time * Number(factor)).toFixed(3)} ${unit}`;
    scrub.value = now.time;
  }

  function tick(stamp) {
    if (!now.playing) return;
    // A tab that was away goes on where it was; a film keeps the clock's time even where frames come late.
    const since = now.last ? (stamp - now.last) / 1000 : 0, passed = now.recording ? since
      : Math.min(0.1, since);
    now.last = stamp;
    now.time += passed * Number(element("speed").value);
    if (now.time >= end()) { now.time = end(); run(false); }
    draw();
    if (now.playing) now.frame = requestAnimationFrame(tick);
  }
  function run(on) {
    if (on && now.time >= end()) now.time = 0;
    now.playing = on && end() > 0;
    now.last = 0;
    play.textContent = now.playing ? "❚❚ pause" : "▶ play";
    cancelAnimationFrame(now.frame);
    if (now.playing) now.frame = requestAnimationFrame(tick);
  }

  const stopAt = (time) =>
    { now.time = Math.min(Math.max(0, time), end()); run(false); draw(); noteAddress(); };

  function tell() {
    table.replaceChildren(...numberRows(now.story, now.design, chosen, map.slips));
    element("tiles").replaceChildren(...tilesOf(now.story, now.design, chosen).map(([name, text]) => {
      const tile = document.createElement("div"), term = document.createElement("dt"),
        value = document.createElement("dd");
      term.textContent = name;
      value.textContent = text;
      tile.append(term, value);
      return tile;
    }));
    // Each flag with its value in a piece, which lines do not break.
    command.replaceChildren(...commandPieces(now.design).flatMap((text, k) => {
      const piece = document.createElement("span");
      piece.textContent = text;
      return k > 0 ? [" ", piece] : [piece];
    }));
  }
  const commandPieces = (design) => hopCommand(design, map, solver.defaults, chosen.jumps);

  /** Of a hoop that is none of the map's, what the map's readout tells. */
  function ownOutcome() {
    const { design, story: { outcome } } = now;
    return { ...outcome, ...now.asMade,
      agility: 2 * design.radius * outcome.jump_height / (outcome.jump_time + outcome.apex_time) };
  }
  const tellOwn = () => ofItsOwn(element("hop-title").textContent, ownOutcome(), now.design);

  /** Of such a hoop what is told of hoops made after it, once that is known. */
  function tellAsMade(design) {
    const { made } = map.asked;
    if (!made || !toldFields(map).some((field) => field.made)) return;
    const places = Float64Array.of(design.slope, design.release_angle), drawn = drawing.drawn();
    if (lackedBy(drawn, map.spreads).length > 0) {
      now.asMade = Object.fromEntries(made.fields.map((name) => [name, NaN]));
      toldMore(ownOutcome());
      return;
    }
    const order = { design: { ...design, drawing: drawn }, slips: map.slips, tolerance: map.tolerance,
      first: "slope", second: "release_angle", places, made: { ...made, spreads: spreadsHere(drawn) } };
    teller.tell(order, (row) => {
      now.asMade = Object.fromEntries(made.fields.map((name, k) => [name, row ? row[k] : NaN]));
      toldMore(ownOutcome());
    });
  }

  /** Solves the design anew, its motion from the start. */
  function solve() {
    try { solved(); } catch (error) { now.story = null;
      notice(`This hoop cannot be shown: ${error.message ?? error}`); }
  }
  function solved() {
    const { design } = now;
    if (map.live && !differInSize(map)) chosen.radius = map.fixed.radius;
    design.radius = chosen.radius;
    element("radius-note").textContent = design.radius === map.fixed.radius ? ""
      : `(the map's: ${short(1000 * map.fixed.radius)} mm)`;
    now.asked = { ...map.asked, jumps: chosen.jumps };
    now.story = solver.solve(design, map.slips, map.tolerance, 0,
      { ...now.asked, settle: now.asked.settle || STEADY_AFTER });
    now.asMade = {};
    drawing.follow(design, now.source[0] === "design");
    teller.drop();
    if (now.source[0] !== "design") { tellOwn(); tellAsMade(design); }
    now.time = 0;
    tell();
    haunt();
    showGaits(design);
    showInputs(design);
    showGradient(design);
  }

  /** The map's tolerances in the units of the hoop shown. */
  const spreadsHere = (drawn) => spreadsOf(solver, map.spreads, map.drawing, drawn);
  const goalsOfHoops = () => (map.live ? map.hoopGoals() : map.goals);
  /** What hoops that jump along are asked, so that goals can be told of. */
  const ghostsAsked = () =>
    { const { jumps, settle, growth } = madeAsked(map, goalsOfHoops());
    return { jumps: Math.max(jumps, chosen.jumps), settle, growth }; };
  const ghostsKey = () => JSON.stringify([ghostsAsked(), map.spreads]);
  function countGhosts() {
    const outcomes = now.ghosts.filter(({ pin }) => pin === undefined).map(({ story }) => story.outcome),
      goals = goalsOfHoops();
    if (outcomes.length === 0) return;
    const jump = outcomes.filter((o) => o.status === "jumped").length,
      reach = outcomes.filter((o) => reachesAll(o, goals, solver.codes)).length;
    element("ghosts-told").textContent = `: ${jump} of ${GHOSTS} jump`
      + (goals.length ? `, ${reach} reach every goal` : "");
  }
  /** Goals are others: hoops that jump along are counted anew, and solved anew if more has to be known of
      them. */
  function recount() {
    if (!now.story || !ghosts.checked) return;
    if (ghostsKey() === now.ghostsKey) countGhosts(); else haunt();
  }

  /** Draws the hoop, and solves those that jump along: those pinned, and as made, of which it says how many
      jump. A slice at a time, as friction takes its time. */
  async function haunt() {
    const mine = ++now.haunting, lacked = lackedBy(drawing.drawn(), map.spreads),
      made = ghosts.checked && lacked.length === 0
        ? madeAfter(solver, now.design, drawing.drawn(), spreadsHere(drawing.drawn()), GHOSTS) : [];
    const wanted = [...(element("pins-along").checked ? pins.designs().map((design, pin) => ({ design, pin }))
      : []), ...made.map((design) => ({ design }))], found = [];
    now.ghosts = [];
    now.ghostsKey = ghostsKey();
    element("ghosts-told").textContent = made.length > 0 ? ": solving"
      : ghosts.checked && lacked.length > 0 ? `: this hoop's drawing lacks ${lacked.join(", ")}` : "";
    scrub.max = end();
    draw();
    if (wanted.length === 0) return;
    let begun = performance.now();
    for (const each of wanted) {
      try {
        const story = solver.solve(each.design, map.slips, map.tolerance, 0, ghostsAsked());
        found.push({ ...each, story });
      } catch (error) {
        element("ghosts-told").textContent = "";
        notice(`A hoop beside cannot be shown: ${error.message ?? error}`);
        return;
      }
      if (performance.now() - begun < SLICE) continue;
      await new Promise((go) => { setTimeout(go); });
      if (mine !== now.haunting) return;  // others are wanted by now
      begun = performance.now();
    }
    now.ghosts = found;
    countGhosts();
    scrub.max = end();
    now.time = Math.min(now.time, end());
    draw();
  }
  ghosts.addEventListener("change", () => { if (now.story) haunt(); });

  play.addEventListener("click", () => { run(!now.playing); noteAddress(); });
  const frame = (way) => stopAt(now.time + way * Number(element("speed").value) / 30);
  element("step-back").addEventListener("click", () => frame(-1));
  element("step-on").addEventListener("click", () => frame(1));
  scene.addEventListener("keydown", (event) => {
    if (!now.story) return;
    const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    if (way) frame(way * (event.shiftKey ? 10 : 1));
    else if (event.key === " ") play.click();
    else if (event.key === "Home") stopAt(0);
    else return;
    event.preventDefault();
  });
  element("film").addEventListener("click", async () => {
    if (!now.story) return;
    const film = element("film");
    film.disabled = true;
    film.textContent = "recording ...";
    now.time = 0;
    now.recording = true;
    const blob = await recorded(scene, () => new Promise((keep) => {
      run(true);
      const wait = () => (now.playing ? requestAnimationFrame(wait) : keep());
      wait();
    }));
    now.recording = false;
    film.disabled = false;
    film.textContent = "save as WebM";
    if (blob) { film.dataset.bytes = blob.size; saveAs(blob, "hoop.webm");
        } else notice("This browser cannot record films.");
  });
  scrub.addEventListener("input", () => stopAt(Number(scrub.value)));
  for (const id of ["follow", "forces"]) element(id).addEventListener("change", draw);
  saveButtons("plots", plots, () => "hoop_forces", (canvas) => { if (now.story) plotOn(canvas); });
  onTones(() => { if (now.story) draw(); });
  /** Takes a number above zero; says so if it is none, and what is shown stays as it was. */
  const choose = (input, name, then) => input.addEventListener("change", () => {
    const good = Number(input.value) > 0 && input.checkValidity();
    input.setAttribute("aria-invalid", String(!good));
    if (!document.querySelector('[aria-invalid="true"]')) notice("");
    if (!good) notice(`The ${name} must be a number above 0, and finite.`);
    if (!good) return;
    chosen[name] = Number(input.value) / 1000;
    if (now.story) then();
    noteAddress();
  });
  for (const input of [radius, mass]) stepsOf(input, () => Number(input.value) || 1);
  choose(radius, "radius", solve);
  /** A live map tells how many jumps each of its hoops makes of as many. */
  const followOn = () => {
    if (!map.live || map.jumps === chosen.jumps) return;
    map.jumps = chosen.jumps;
    followed();
  };
  jumps.addEventListener("change", () => {
    const good = jumps.value !== "" && jumps.checkValidity();
    jumps.setAttribute("aria-invalid", String(!good));
    notice(good ? "" : `The number of jumps must be a whole number from ${jumps.min} to ${jumps.max}.`);
    if (!good) return;
    chosen.jumps = Number(jumps.value);
    followOn();
    pins.show();
    noteAddress();
    if (now.design) { solve(); run(!still && now.story !== null); }
  });
  mass.addEventListener("change", () => {
    const good = mass.value === "" ? !mass.validity.badInput : Number(mass.value) > 0 && mass.checkValidity();
    mass.setAttribute("aria-invalid", String(!good));
    notice(good ? "" : "The mass must be a number above 0, and finite; empty: unknown.");
    if (!good) return;
    chosen.mass = units.mass = kilograms();
    otherUnits();
    noteAddress();
  });
  const seek = (event) =>
    { if (now.timeAt && (event.type === "click" || event.buttons === 1)) stopAt(now.timeAt(event.clientX)); };
  plots.addEventListener("click", seek);
  plots.addEventListener("pointermove", seek);
  element("copy").addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(command.textContent);
      element("copy").textContent = "copied";
    } catch {  // a page from a file may not; the text is selected instead
      const range = document.createRange();
      range.selectNodeContents(command);
      window.getSelection().removeAllRanges();
      window.getSelection().addRange(range);
      element("copy").textContent = "selected: Ctrl+C";
    }
    setTimeout(() => { element("copy").textContent = "copy"; }, 2000);
  });
  new ResizeObserver(draw).observe(scene);

  /** goesOn: the hoop of the same place, on which a reader who stopped it wants to see the same moment. */
  const begin = (design, title, source, goesOn = false) => {
    const stopped = goesOn && now.story && !now.playing && now.time > 0, { time } = now;
    Object.assign(now, { design, source, fixed: { ...map.fixed } });
    element("hop-title").textContent = title;
    solve();
    if (stopped && now.story) stopAt(time);
    else run(!still && now.story !== null);
    noteAddress();
  };
  /** A hoop of numbers that were typed, of which only those that differ from the map's go into the address.
      */
  const typed = (design, title = "One hoop: edited", goesOn = false) =>
    begin(design, title,
    ["hoop", wordsOf(design, Object.keys(map.parameters)
    .filter((name) => name in solver.defaults && name !== "radius"
    && (map.slips || !SLIPPING.includes(name))))], goesOn);
  const PAPERS = "One hoop: the paper's, from rest with its mass on top";
  // In a model that slips it is a hoop of numbers: the paper's has no friction to name.
  const paper = (goesOn = false) =>
    (map.slips ? typed({ ...map.fixed, ...map.paper }, PAPERS)
    : begin({ ...map.fixed, ...map.paper }, PAPERS, ["paper", ""], goesOn));
  element("paper").hidden = map.slips;
  element("paper").addEventListener("click", () => paper());
  const show = (index, byHand, goesOn = false) => {
    // On a phone the hoop is further down.
    const part = element("hop-part");
    if (byHand && part.getBoundingClientRect().top > 0.9 * window.innerHeight)
      part.scrollIntoView({ behavior: still ? "auto" : "smooth" });
    const design = designAt(map, index);
    if (map.drawing && choicesOf(map).some(({ name }) => isDrawn(name))) {
      Object.assign(chosen, { radius: design.radius, mass: design.mass });
      units.mass = chosen.mass;
      for (const [input, value] of [[radius, chosen.radius], [mass, chosen.mass]])
        input.value = Number((1000 * value).toPrecision(12));
    }
    begin(design, `One hoop: ${placeText(map, index)}`, ["design", index.join(",")], goesOn);
  };
  addressPart({
    write(words) {
      const [key, value] = now.source;
      if (key) words.set(key, value);
      for (const [name, input, fallback] of [["jumps", jumps, firstJumps],
          ["radius", radius, 1000 * map.fixed.radius], ["mass", mass, weighed]])
        if (Number(input.value) !== Number(fallback) && !(name === "radius" && map.live))
          words.set(name === "radius" ? "hoop_radius" : name, input.value);
      for (const [name, input, fallback] of ways)
        if (input.type === "checkbox" ? input.checked !== fallback : input.value !== fallback)
          words.set(name, input.type === "checkbox" ? Number(input.checked) : input.value);
      if (now.story && !now.playing && now.time > 0 && now.time < end())
        words.set("time", Number(now.time.toPrecision(6)));
      pins.write(words);
    },
    read(words) {
      for (const [name, input, fallback] of [["jumps", jumps, firstJumps],
          ["hoop_radius", radius, 1000 * map.fixed.radius], ["mass", mass, weighed]]) {
        const value = Number(words.get(name) ?? fallback);
        if (value > 0 && value <= Number(input.max)) input.value = value;
        else if (name === "mass" && !words.has("mass")) input.value = "";
      }
      units.mass = kilograms();
      Object.assign(chosen,
        { radius: Number(radius.value) / 1000, mass: units.mass, jumps: Math.round(Number(jumps.value)) });
      followOn();
      for (const [name, input, fallback] of ways) {
        const word = words.get(name);
        if (input.type === "checkbox") input.checked = word === null ? fallback : word === "1";
        else input.value = word !== null
          && (input.tagName !== "SELECT" || [...input.options].some(({ value }) => value === word)) ? word
          : fallback;
        if (input.value === "" || !input.checkValidity()) input.value = fallback;
      }
      pins.read(words);
      pinned();
      const hoop = designOf(words.get("hoop"), solver.ranges);
      if (words.has("paper")) paper();
      else if (hoop) typed({ ...map.fixed, ...hoop });
      else if (words.has("hoop")) notice("The address describes a hoop that is not possible.");
    },
  });
  /** The model is another: a hoop that is none of the map's, and what is pinned, are solved anew; the map's
      own follow the map. */
  const remodel = () => {
    pins.show();
    if (!now.design || now.source[0] === "design") return;
    const title = element("hop-title").textContent;
    title === PAPERS ? paper() : typed(now.design, title);
  };
  /** The scene is another, or something else is asked: the paper's hoop is in that scene, one of numbers has
      its own but for the radius and for what has been turned since. */
  const follow = () => {
    const { source, design } = now, other = now.story && Object.keys(map.asked)
      .some((what) => what !== "jumps" && map.asked[what] !== now.asked[what]);
    const turned = Object.keys(map.fixed)
      .filter((name) => now.fixed && name !== "radius" && !Object.is(map.fixed[name], now.fixed[name]));
    if (source[0] === "paper" && (other || NO_LIVE_AXIS.some((name) => design[name] !== map.fixed[name])))
      paper(true);
    else if (source[0] === "hoop" && turned.length > 0)
      typed({ ...design, ...Object.fromEntries(turned.map((name) => [name, map.fixed[name]])) },
        element("hop-title").textContent, true);
    else if (source[0] === "hoop" && (other || design.radius !== map.fixed.radius))
      begin(design, element("hop-title").textContent, source, true);
  };
  return { show, stopAt, remodel, retell: () =>
    { pins.show(); if (now.story) { tell(); showGaits(now.design); showGradient(now.design); draw(); } },
    isOfMap: () => now.source[0] === "design",
    /** Whether the hoop shown is that design of the map. */
    isOf: (index) =>
      Boolean(now.story) && now.source[0] === "design" && now.source[1] === String(index),
    hoop: () => ({ outcome: now.story.outcome, design: now.design }), follow, recount,
    haunt: () => { if (now.story) haunt(); } };
}
