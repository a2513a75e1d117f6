// The part of the page that shows one hoop: its controls, numbers and command line.

/** The part that shows one hoop: show(index) a design, stopAt(time) a moment of its motion. */
function hopPanel(map, solver) {
  const still = window.matchMedia("(prefers-reduced-motion: reduce)").matches;
  const scene = element("scene"), plots = element("plots"), play = element("play"), scrub = element("scrub"), clock = element("clock");
  const radius = element("radius"), mass = element("mass"), table = element("numbers").tBodies[0], command = element("command");
  const now = { design: null, story: null, ghosts: [], time: 0, playing: false, last: 0, frame: 0, timeAt: null };
  const chosen = { radius: map.fixed.radius, mass: 0.0282, jumps: map.jumps };  // m; kg, of hoop and point mass: the paper's 8.2 g and 20 g
  radius.value = 1000 * chosen.radius;
  mass.value = 1000 * chosen.mass;
  const jumps = element("jumps");
  jumps.value = chosen.jumps;

  const showGaits = gaitsPart(map, solver, (name, value) => {
    const { label, unit } = map.parameters[name];
    begin({ ...now.design, [name]: value }, `One hoop: ${label.toLowerCase()} ${withUnit(short(unit === "°" ? value * 180 / Math.PI : value), unit)}`);
  });

  const pins = pinsPart(map, () => { if (now.story) { haunt(); draw(); } });
  element("pin").addEventListener("click", () => { if (now.story) pins.pin(now.design, now.story.outcome, hopCommand().join(" ")); });
  element("pins-along").addEventListener("change", () => { if (now.story) { haunt(); draw(); } });

  const GHOSTS = 20, ghosts = element("ghosts");
  element("ghosts-label").hidden = map.scatter.length === 0;

  const end = () => Math.max(now.story?.motion.t.at(-1) ?? 0, ...now.ghosts.map(({ story }) => story.motion.t.at(-1) ?? 0));

  function draw() {
    if (!now.story || now.story.motion.t.length === 0) {
      for (const canvas of [scene, plots]) canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
      clock.textContent = "it does not set out";
      return;
    }
    drawHoop(scene, now.design, now.story.motion, now.time, element("follow").checked, now.ghosts);
    now.timeAt = drawPlots(plots, now.story.motion, now.story.liftOffs, now.time, chosen.mass * now.design.gravity, now.design.radius);
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
    const { outcome } = now.story, R = now.design.radius, g = now.design.gravity, second = Math.sqrt(R / g), kg = chosen.mass;
    const jumped = outcome.status === "jumped", rows = [];
    const length = (metres, digits = 4) => (Math.abs(metres) >= 1 ? `${short(metres, digits)} m` : `${short(Math.abs(metres) < 1e-9 * R ? 0 : 1000 * metres, digits)} mm`);
    const add = (name, words, text, value = outcome[name]) => rows.push(row(name, words, text, value));
    add("status", "ends as", outcome.status.replaceAll("_", " "));
    if (jumped) {
      const metres = 2 * R * outcome.jump_height, speed = outcome.jump_spin / second;
      add("jump_height", "jump height", `${length(metres)} = ${short(outcome.jump_height, 5)} diameters`);
      add("jump_time", "lift-off after", `${short(outcome.jump_time, 5)} s`);
      add("agility", "agility", `${short(metres / (outcome.jump_time + outcome.apex_time))} m/s`, metres / (outcome.jump_time + outcome.apex_time));
      add("apex_time", "apex, landing after lift-off", `${short(outcome.apex_time, 4)} s, ${short(outcome.flight_time, 4)} s`);
      add("jump_spin", "spin at lift-off", `${short(speed)} rad/s`);
      add("jump_angle", "angle at lift-off", `${short(outcome.jump_angle * 180 / Math.PI, 5)}°`);
      add("jump_distance", map.slips ? "travelled until lift-off" : "rolled until lift-off", length(outcome.jump_distance * R));
      if (!map.slips) add("dip", "flight first dips", length(2 * R * outcome.dip, 3));
    }
    if (jumped && chosen.jumps > 1) {
      const { height, is_jump } = now.story.liftOffs;
      add("jumps", "jumps made", `${outcome.jumps} of ${chosen.jumps}: ${[...height].filter((_, i) => is_jump[i] === 1).map((h) => short(h)).join(", ")} diameters`);
    }
    if (outcome.candidates > 0) {
      add("spurious_first_jump", "first lift-off", outcome.spurious_first_jump !== 1 ? "is the jump"
        : outcome.first_jump_height > 0 ? `spurious: ${length(2 * R * outcome.first_jump_height, 3)} high, after ${short(outcome.first_jump_time)} s`
        : `spurious: sinks at once, after ${short(outcome.first_jump_time)} s; rolling on without slip asks the plane to pull`);
      add("candidates", "lift-offs looked at", String(outcome.candidates));
    }
    if (map.slips) {
      add("phase_sequence", "phases", `${outcome.phase_sequence} (R rolls, S slides, F flies)`);
      if (Number.isFinite(outcome.slip_distance)) add("slip_distance", "slid", length(R * outcome.slip_distance));
      if (jumped) add("landing_spin", "spin after landing", `${short(outcome.landing_spin / second)} rad/s`);
      if (jumped) add("energy_lost", "energy lost until the jump", `${short(1000 * outcome.energy_lost * kg * g * R)} mJ`);
    }
    const pushes = now.story.motion.normal_force;
    if (pushes.length > 0) {
      const most = pushes.reduce((a, b) => Math.max(a, b), 0) * kg * g;
      add("most_normal_force", "largest normal force", `${short(most)} N`, most);
    }
    table.replaceChildren(...rows);
    // Each flag with its value in a piece, which lines do not break.
    command.replaceChildren(...hopCommand().flatMap((text, k) => {
      const piece = document.createElement("span");
      piece.textContent = text;
      return k > 0 ? [" ", piece] : [piece];
    }));
  }

  /** The command line that tells the same hoop, in pieces. */
  function hopCommand() {
    const { design } = now, contact = ["mu_static", "mu_kinetic", "restitution"];
    const flags = ["slope", "mass_ratio", "offset_ratio", "inertia_factor", "release_angle", "release_spin", "drive_torque", ...(map.slips ? contact : [])];
    const words = ["leapmap hop", ...flags.filter((k) => Number.isFinite(design[k])).map((k) => `--${k.replaceAll("_", "-")} ${design[k]}`)];
    if (map.slips) words.push("--set friction=coulomb", `--set rest_speed=${design.rest_speed}`);
    for (const key of ["runway", "hop_height", "radius", "gravity"])
      if (design[key] !== solver.defaults[key]) words.push(`--set ${key}=${design[key]}`);
    if (chosen.jumps > 1) words.push(`--jumps ${chosen.jumps}`);
    if (map.tolerance !== 1e-10) words.push(`--set tolerance=${map.tolerance}`);
    return words;
  }

  /** Solves the design anew, its motion from the start. */
  function solve() {
    try { solved(); } catch (error) { now.story = null; notice(`This hoop cannot be shown: ${error.message ?? error}`); }
  }
  function solved() {
    const { design } = now;
    design.radius = chosen.radius;
    element("radius-note").textContent = design.radius === map.fixed.radius ? "" : `(the map's: ${short(1000 * map.fixed.radius)} mm)`;
    now.story = solver.solve(design, map.slips, map.tolerance, 0, chosen.jumps);
    haunt();
    showGaits(design);
    now.time = 0;
    tell();
    draw();
  }

  /** Makes hoops after the design shown, if they are asked for, and says how many of them jump. */
  function haunt() {
    now.ghosts = !ghosts.checked ? [] : madeAfter(now.design, map.scatter, solver.ranges, GHOSTS)
      .map((design) => ({ design, story: solver.solve(design, map.slips, map.tolerance, 0, chosen.jumps) }));
    const outcomes = now.ghosts.map(({ story }) => story.outcome);
    if (element("pins-along").checked)
      for (const design of pins.designs()) now.ghosts.push({ design, pinned: true, story: solver.solve(design, map.slips, map.tolerance, 0, chosen.jumps) });
    const jump = outcomes.filter((o) => o.status === "jumped").length, reach = outcomes.filter((o) => reachesAll(o, map.goals, solver.codes)).length;
    element("ghosts-told").textContent = outcomes.length === 0 ? "" : `: ${jump} of ${GHOSTS} jump` + (map.goals.length ? `, ${reach} reach every goal` : "");
    scrub.max = end();
  }
  ghosts.addEventListener("change", () => { if (now.story) { haunt(); now.time = Math.min(now.time, end()); draw(); } });

  play.addEventListener("click", () => run(!now.playing));
  const frame = (way) => { run(false); now.time = Math.min(end(), Math.max(0, now.time + way * Number(element("speed").value) / 30)); draw(); };
  element("step-back").addEventListener("click", () => frame(-1));
  element("step-on").addEventListener("click", () => frame(1));
  element("film").addEventListener("click", async () => {
    if (!now.story) return;
    const film = element("film");
    film.disabled = true;
    film.textContent = "recording ...";
    now.time = 0;
    const blob = await recorded(scene, () => new Promise((keep) => {
      run(true);
      const wait = () => (now.playing ? requestAnimationFrame(wait) : keep());
      wait();
    }));
    film.disabled = false;
    film.textContent = "save as WebM";
    if (blob) { film.dataset.bytes = blob.size; saveAs(blob, "hoop.webm"); } else notice("This browser records no films.");
  });
  scrub.addEventListener("input", () => { run(false); now.time = Number(scrub.value); draw(); });
  element("follow").addEventListener("change", draw);
  /** Takes a number above zero; says so if it is none, and what is shown stays as it was. */
  const choose = (input, name, then) => input.addEventListener("change", () => {
    const good = Number(input.value) > 0 && input.checkValidity();
    input.setAttribute("aria-invalid", String(!good));
    if (!document.querySelector('[aria-invalid="true"]')) notice("");
    if (!good) notice(`The ${name} must be a number above 0, and not beyond all bounds.`);
    if (!good) return;
    chosen[name] = Number(input.value) / 1000;
    if (now.story) then();
  });
  choose(radius, "radius", solve);
  jumps.addEventListener("change", () => {
    const good = jumps.value !== "" && jumps.checkValidity();
    jumps.setAttribute("aria-invalid", String(!good));
    notice(good ? "" : `How many jumps must be a whole number from ${jumps.min} to ${jumps.max}.`);
    if (!good) return;
    chosen.jumps = Number(jumps.value);
    if (now.design) { solve(); run(!still && now.story !== null); }
  });
  choose(mass, "mass", () => { tell(); draw(); });
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

  const begin = (design, title) => {
    now.design = design;
    element("hop-title").textContent = title;
    solve();
    run(!still && now.story !== null);
  };
  if (!map.slips) {
    element("paper").hidden = false;
    element("paper").addEventListener("click", () => {
      history.replaceState(null, "", "#paper");
      begin({ ...map.fixed, ...map.paper }, "One hoop: the paper's, from rest with its mass on top");
    });
  }
  const show = (index, byHand) => {
    // On a phone the hoop is further down.
    const part = element("hop-part");
    if (byHand && part.getBoundingClientRect().top > 0.9 * window.innerHeight) part.scrollIntoView({ behavior: still ? "auto" : "smooth" });
    history.replaceState(null, "", `#design=${index.join(",")}`);
    begin(designAt(map, index), `One hoop: ${placeText(map, index)}`);
  };
  const stopAt = (time) => { run(false); now.time = Math.min(Math.max(0, time), end()); draw(); };
  return { show, stopAt };
}
