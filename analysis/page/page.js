// The page: what belongs to what.

const element = (id) => document.getElementById(id);

function complain(error) {
  const message = element("message");
  message.hidden = false;
  message.textContent = `This page cannot be shown: ${error.message ?? error}`;
}

/** The map as the explorer wrote it, with its numbers unpacked. */
async function readMap() {
  const map = JSON.parse(element("data").textContent);
  if (!Array.isArray(map.axes) || !Array.isArray(map.fields) || map.fields.length === 0) throw new Error("it holds no map");
  const shape = map.axes.map((a) => a.values.length);
  for (const field of map.fields) {
    field.values = await quantity(field, shape, map.differenced);
    field.table = Uint8Array.from(atob(field.colours), (c) => c.charCodeAt(0));
    let low = Infinity, high = -Infinity;
    for (const v of field.values) if (v === v && (!field.log || v > 0)) { low = Math.min(low, v); high = Math.max(high, v); }
    if (field.log) high = Math.max(high, ...(field.name === "agility" ? Object.values(map.jumpers).map((v) => 1.15 * v) : []));
    // A few extreme designs do not set the scale: isolines that are given do.
    const given = field.levels.filter((l) => l >= low && l <= high);
    if (field.log && given.length > 2) low = Math.max(low, given[0]);
    if (!field.log && given.length > 2) [low, high] = [Math.max(low, Math.min(given[0], low + 0.02 * (high - low))), given.at(-1)];
    Object.assign(field, { low, high, place: colourScale(field, low, high) });
  }
  for (const code of Object.values(map.codes)) code.values = await codes(code, shape);
  if (map.codes.status)
    map.codes.status.rgb = map.codes.status.shown.map(({ colour }) => [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16)));
  return map;
}

function option(select, value, text) {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = text;
  select.append(made);
}

const withUnit = (text, unit) => (unit === "°" ? `${text}°` : unit ? `${text} ${unit}` : text);
const placeText = (map, index) => map.axes.map((axis, k) => `${axis.symbol} ${withUnit(short(inShownUnit(axis, axis.values[index[k]])), axis.unit)}`).join(", ");
const inShownUnit = (axis, value) => (axis.unit === "°" ? value * 180 / Math.PI : value);

function start(map, solver) {
  const canvas = element("map");
  document.title = `${map.name}: leapmap explorer`;
  element("title").textContent = map.title || map.name;
  element("subtitle").textContent = `${map.name}: ${map.designs.toLocaleString("en")} designs` +
    (map.computed < 1 ? `, INCOMPLETE: ${(100 * map.computed).toFixed(0)} % of them computed` : "") +
    (map.slips ? "; slips by Coulomb's law" : "; never slips") + ` · runway ${short(map.fixed.runway)} turns · a jump is ${short(map.fixed.hop_height)} diameters or more`;
  element("footer").textContent = `Made by leapmap ${map.program}, which runs in this page as well. The map's numbers are rounded as shown` +
    (map.left_out.length ? `; left out for size: ${map.left_out.join(", ")}` : "") +
    (map.fields.some((f) => f.name === "agility") ? `. Salto ${map.jumpers.Salto} m/s, galago ${map.jumpers.galago} m/s: ${map.jumpers_source}` : "") + ".";

  const chosen = hopPanel(map, solver);
  const told = (index) => {
    const at = view.offset(index), shown = view.view.field;
    const status = map.codes.status?.meanings[map.codes.status.values[at]];
    const text = (f) => (f.values[at] === f.values[at] ? withUnit(f.values[at].toFixed(decimalsOf(f.step)), f.unit) : "none");
    const notes = [status === undefined || status === "jumped" ? "" : status.replaceAll("_", " "),
                   map.codes.spurious_first_jump?.values[at] === 1 ? "the first lift-off is spurious" : ""];
    element("place").textContent = placeText(map, index);
    element("value").textContent = [`${shown.label}: ${text(shown)}`, ...notes].filter((w) => w).join("; ");
    element("others").replaceChildren(...map.fields.filter((f) => f !== shown && f.values[at] === f.values[at]).map((f) => {
      const pair = document.createElement("div"), name = document.createElement("dt"), value = document.createElement("dd");
      name.textContent = f.label.split(":")[0];
      value.textContent = text(f);
      pair.append(name, value);
      return pair;
    }));
    const { dataset } = element("readout");
    dataset.index = index.join(",");
    dataset.value = shown.values[at] === shown.values[at] ? shown.values[at].toFixed(decimalsOf(shown.step)) : "";
  };
  const view = mapView(canvas, map, told, chosen.show);

  // Slope to the right and mass ratio up where there are both, as on the charts; never an axis of one value if there are others.
  const liked = (axis, k) => [axis.values.length > 1 ? 0 : 1, ["slope", "mass_ratio"].includes(axis.name) ? 0 : 1, axis.name === "slope" ? 0 : 1, k];
  const order = map.axes.map((axis, k) => liked(axis, k)).sort((a, b) => a.reduce((sum, v, i) => sum || v - b[i], 0));
  [view.view.x, view.view.y] = [order[0][3], order[1][3]];

  const fieldSelect = element("field"), selects = { x: element("x-axis"), y: element("y-axis") };
  map.fields.forEach((f, k) => option(fieldSelect, k, withUnit(f.label, f.unit ? `[${f.unit}]` : "")));
  for (const select of Object.values(selects)) map.axes.forEach((a, k) => option(select, k, a.label));
  fieldSelect.addEventListener("change", () => { view.view.field = map.fields[fieldSelect.value]; legend(); view.paint(); told(view.view.index); });
  for (const [key, select] of Object.entries(selects))
    select.addEventListener("change", () => {
      const other = key === "x" ? "y" : "x", taken = Number(select.value);
      if (view.view[other] === taken) view.view[other] = view.view[key];
      view.view[key] = taken;
      arrange();
      view.paint();
    });

  /** A slider for every axis that is not on the screen. */
  function arrange() {
    selects.x.value = view.view.x;
    selects.y.value = view.view.y;
    element("sliders").replaceChildren(...map.axes.flatMap((axis, k) => {
      if (k === view.view.x || k === view.view.y) return [];
      const label = document.createElement("label"), slider = document.createElement("input"), value = document.createElement("output");
      slider.type = "range";
      slider.min = 0;
      slider.max = axis.values.length - 1;
      slider.value = view.view.index[k];
      slider.dataset.axis = axis.name;
      const tell = () => { value.textContent = withUnit(short(inShownUnit(axis, axis.values[view.view.index[k]])), axis.unit); slider.setAttribute("aria-valuetext", value.textContent); };
      slider.addEventListener("input", () => { view.view.index[k] = Number(slider.value); tell(); view.paint(); told(view.view.index); });
      tell();
      label.append(axis.label, slider, value);
      return [label];
    }));
  }

  function legend() {
    const entry = (words, colour, image) => {
      const item = document.createElement("li"), swatch = document.createElement("span");
      swatch.className = "swatch";
      swatch.style.background = image ?? colour;
      item.append(swatch, words);
      return item;
    };
    const items = [];
    const flags = map.codes.spurious_first_jump;
    if (flags?.values.includes(1)) items.push(entry("first lift-off is spurious", "", `repeating-linear-gradient(135deg, #555 0 1px, #fff 1px 5px)`));
    map.codes.status?.shown.forEach(({ colour, words }, k) => {
      if (map.codes.status.meanings[k] !== "jumped" && map.codes.status.values.includes(k)) items.push(entry(words, colour));
    });
    element("legend").replaceChildren(...items);
  }

  // Begin where the paper's hoop is, if it is on the map, else in the middle.
  map.axes.forEach((axis, k) => {
    const wanted = map.paper?.[axis.name];
    if (wanted === undefined) return;
    const away = axis.values.map((v) => Math.abs(v - wanted));
    view.view.index[k] = away.indexOf(Math.min(...away));
  });
  const asked = addressed(map);
  if (asked.index) view.view.index = asked.index;
  arrange();
  legend();
  view.paint();
  told(view.view.index);
  view.pick();
  if (asked.time !== undefined) chosen.stopAt(asked.time);
  window.explorer = { map, view, solver };
}

/** What the address asks for, as #design=20,30,1&time=0.5: a design by its place along each axis, and a moment to stop at [s]. */
function addressed(map) {
  const words = new URLSearchParams(location.hash.slice(1)), asked = {};
  const index = (words.get("design") ?? "").split(",").map(Number);
  if (index.length === map.axes.length && map.axes.every((axis, k) => Number.isInteger(index[k]) && index[k] >= 0 && index[k] < axis.values.length))
    asked.index = index;
  if (words.has("time") && Number.isFinite(Number(words.get("time")))) asked.time = Number(words.get("time"));
  return asked;
}

/** The part that shows one hoop: show(index) a design, stopAt(time) a moment of its motion. */
function hopPanel(map, solver) {
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const scene = element("scene"), plots = element("plots"), play = element("play"), scrub = element("scrub"), clock = element("clock");
  const radius = element("radius"), mass = element("mass"), table = element("numbers").tBodies[0], command = element("command");
  const now = { design: null, story: null, time: 0, playing: false, last: 0, timeAt: null };
  radius.value = 1000 * map.fixed.radius;
  mass.value = 28.2;  // the paper's: 8.2 g and 20 g

  const end = () => now.story.motion.t.at(-1) ?? 0;
  const positive = (input, otherwise) => (Number(input.value) > 0 ? Number(input.value) : otherwise);
  const weight = () => positive(mass, 28.2) / 1000 * (now.design.gravity ?? solver.defaults.gravity);

  function draw() {
    if (!now.story || now.story.motion.t.length === 0) {
      for (const canvas of [scene, plots]) canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
      clock.textContent = "it does not set out";
      return;
    }
    drawHoop(scene, now.design, now.story.motion, now.time, element("follow").checked);
    now.timeAt = drawPlots(plots, now.story.motion, now.story.liftOffs, now.story.outcome, now.time, weight());
    clock.textContent = `${now.time.toFixed(3)} s`;
    scrub.value = now.time;
  }

  function tick(stamp) {
    if (!now.playing) return;
    const passed = now.last ? Math.min(0.1, (stamp - now.last) / 1000) : 0;
    now.last = stamp;
    now.time += passed * Number(element("speed").value);
    if (now.time >= end()) { now.time = end(); run(false); }
    draw();
    if (now.playing) requestAnimationFrame(tick);
  }
  function run(on) {
    if (on && now.time >= end()) now.time = 0;
    now.playing = on && end() > 0;
    now.last = 0;
    play.textContent = now.playing ? "❚❚ pause" : "▶ play";
    if (now.playing) requestAnimationFrame(tick);
  }

  function row(name, words, text, value) {
    const tr = document.createElement("tr"), th = document.createElement("th"), td = document.createElement("td");
    th.scope = "row";
    th.textContent = words;
    td.textContent = text;
    tr.dataset.name = name;
    tr.dataset.value = String(value);
    tr.append(th, td);
    return tr;
  }

  function tell() {
    const { outcome } = now.story, R = now.design.radius, g = now.design.gravity, second = Math.sqrt(R / g), kg = positive(mass, 28.2) / 1000;
    const jumped = outcome.status === "jumped", rows = [];
    const add = (name, words, text, value = outcome[name]) => rows.push(row(name, words, text, value));
    add("status", "ends as", outcome.status.replaceAll("_", " "));
    if (jumped) {
      const metres = 2 * R * outcome.jump_height, speed = outcome.jump_spin / second;
      add("jump_height", "jump height", `${short(1000 * metres)} mm = ${short(outcome.jump_height, 5)} diameters`);
      add("jump_time", "lift-off after", `${short(outcome.jump_time, 5)} s`);
      add("agility", "agility", `${short(metres / (outcome.jump_time + outcome.apex_time))} m/s`, metres / (outcome.jump_time + outcome.apex_time));
      add("apex_time", "apex, landing after lift-off", `${short(outcome.apex_time, 4)} s, ${short(outcome.flight_time, 4)} s`);
      add("jump_spin", "spin at lift-off", `${short(speed)} rad/s`);
      add("jump_angle", "angle at lift-off", `${short(outcome.jump_angle * 180 / Math.PI, 5)}°`);
      add("jump_distance", "rolled until lift-off", `${short(outcome.jump_distance * R * 1000)} mm`);
      if (!map.slips) add("dip", "flight first dips", `${short(2000 * R * outcome.dip, 3)} mm`);
    }
    if (outcome.candidates > 0) {
      add("spurious_first_jump", "first lift-off", outcome.spurious_first_jump === 1 ? `spurious: ${short(1000 * 2 * R * outcome.first_jump_height, 3)} mm high, after ${short(outcome.first_jump_time)} s` : "is the jump");
      add("candidates", "lift-offs looked at", String(outcome.candidates));
    }
    if (map.slips) {
      add("phase_sequence", "phases", outcome.phase_sequence);
      if (Number.isFinite(outcome.slip_distance)) add("slip_distance", "slid", `${short(1000 * R * outcome.slip_distance)} mm`);
      if (jumped) add("landing_spin", "spin after landing", `${short(outcome.landing_spin / second)} rad/s`);
      if (jumped) add("energy_lost", "energy lost until the jump", `${short(1000 * outcome.energy_lost * kg * g * R)} mJ`);
    }
    const pushes = now.story.motion.normal_force;
    if (pushes.length > 0) {
      const most = pushes.reduce((a, b) => Math.max(a, b), 0) * kg * g;
      add("most_normal_force", "largest normal force", `${short(most)} N`, most);
    }
    table.replaceChildren(...rows);
    command.textContent = hopCommand();
  }

  /** The command line that tells the same hoop. */
  function hopCommand() {
    const { design } = now, contact = ["mu_static", "mu_kinetic", "restitution"];
    const flags = ["slope", "mass_ratio", "offset_ratio", "inertia_factor", "release_angle", "release_spin", ...(map.slips ? contact : [])];
    const words = ["leapmap hop", ...flags.filter((k) => Number.isFinite(design[k])).map((k) => `--${k.replaceAll("_", "-")} ${design[k]}`)];
    if (map.slips) words.push("--set friction=coulomb", `--set rest_speed=${design.rest_speed}`);
    for (const key of ["runway", "hop_height", "radius", "gravity"])
      if (design[key] !== solver.defaults[key]) words.push(`--set ${key}=${design[key]}`);
    if (map.tolerance !== 1e-10) words.push(`--set tolerance=${map.tolerance}`);
    return words.join(" ");
  }

  function solve(restart) {
    const { design } = now;
    design.radius = positive(radius, 1000 * map.fixed.radius) / 1000;
    // Some 30 samples a radian of the swiftest motion that the eye can follow; a thousand at most over a usual run.
    const interval = 0.03 * Math.sqrt(design.radius / (design.gravity ?? solver.defaults.gravity));
    now.story = solver.solve(design, map.slips, map.tolerance, interval);
    scrub.max = end();
    if (restart) now.time = 0;
    now.time = Math.min(now.time, end());
    tell();
    draw();
  }

  play.addEventListener("click", () => run(!now.playing));
  scrub.addEventListener("input", () => { run(false); now.time = Number(scrub.value); draw(); });
  element("follow").addEventListener("change", draw);
  radius.addEventListener("change", () => { if (now.design) solve(true); });
  mass.addEventListener("change", () => { if (now.design) { tell(); draw(); } });
  const seek = (event) => { if (now.timeAt && (event.type === "click" || event.buttons === 1)) { run(false); now.time = now.timeAt(event.clientX); draw(); } };
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

  const show = (index) => {
    history.replaceState(null, "", `#design=${index.join(",")}`);
    now.design = { ...map.fixed };
    map.axes.forEach((axis, k) => { now.design[axis.name] = axis.values[index[k]]; });
    element("hop-title").textContent = `One hoop: ${placeText(map, index)}`;
    solve(true);
    run(!still);
  };
  const stopAt = (time) => { run(false); now.time = Math.min(Math.max(0, time), end()); draw(); };
  return { show, stopAt };
}

(async () => {
  try {
    if (typeof DecompressionStream === "undefined" || typeof WebAssembly === "undefined")
      throw new Error("this browser is too old; Chrome 80, Firefox 113 and Safari 16.4 are not");
    start(await readMap(), await loadSolver(element("module").textContent));
  } catch (error) { complain(error); }
})();
