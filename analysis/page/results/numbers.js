// The table of one hoop's numbers, and the command that tells the same.

import { measuresOf, short } from "../state/units.js";

function numberRow(name, words, text, value) {
  const tr = document.createElement("tr"), th = document.createElement("th"),
    td = document.createElement("td");
  th.scope = "row";
  th.textContent = words;
  td.textContent = text;
  tr.dataset.name = name;
  tr.dataset.value = String(value);
  tr.append(th, td);
  return tr;
}

/** Whether the jumps of a hoop become the same, one by one or some in turn. */
export const isSteady = ({ gait_period: period }) => period > 0 && period < 255;

/** What most people want to know of a hoop, as [name, value] in the units shown; empty: it does not jump. */
export function tilesOf({ outcome }, design, chosen) {
  if (outcome.status !== "jumped") return [];
  const R = design.radius, speed = Math.sqrt(design.gravity * R), measure = measuresOf(design, chosen.mass);
  const { jump_height: height, jump_range: range, landing_normal_speed: normal, landing_energy_lost: lost,
    landing_tangential_speed: along, max_normal_force: force } = outcome;
  return [["height", measure.length(2 * R * height, 3)], ["range", measure.length(R * range, 3)],
    ["landing speed", measure.speed(speed * Math.hypot(normal, along))],
    ["lost in landing", measure.energy(lost)], ["hardest force", measure.force(force)]]
    .filter(([, text]) => !text.startsWith("none"));
}

/** Rows of what a story of a design tells; chosen: {mass, jumps}. */
export function numberRows({ outcome, motion, liftOffs }, design, chosen, slips) {
  const R = design.radius, second = Math.sqrt(R / design.gravity), measure = measuresOf(design, chosen.mass),
    jumped = outcome.status === "jumped", rows = [];
  const add = (name, words, text, value = outcome[name]) => rows.push(numberRow(name, words, text, value));
  add("status", "outcome", outcome.status.replaceAll("_", " "));
  if (jumped) {
    const metres = 2 * R * outcome.jump_height, agility = metres / (outcome.jump_time + outcome.apex_time);
    add("jump_height", "jump height",
      `${measure.length(metres)} = ${short(outcome.jump_height, 5)} diameters`);
    add("jump_time", "lift-off after", measure.time(outcome.jump_time, 5));
    add("agility", "agility", measure.speed(agility), agility);
    add("apex_time", "apex, landing after lift-off",
      `${measure.time(outcome.apex_time)}, ${measure.time(outcome.flight_time)}`);
    add("jump_spin", "spin at lift-off", measure.spin(outcome.jump_spin / second));
    add("jump_angle", "angle at lift-off", `${short(outcome.jump_angle * 180 / Math.PI, 5)}°`);
    add("jump_distance", slips ? "travelled until lift-off" : "rolled until lift-off",
      measure.length(outcome.jump_distance * R));
    add("jump_range", "range of the jump", measure.length(outcome.jump_range * R));
    if (design.clear_height > 0) {
      const [from, to] = [outcome.clears_from, outcome.clears_to].map((at) => measure.length(at * R));
      add("clears_from", `clears a wall of ${measure.length(2 * R * design.clear_height)}`,
        Number.isFinite(outcome.clears_from) ? `that stands ${from} to ${to} after the lift-off` : "nowhere");
    }
    const unit = Math.sqrt(design.gravity * R);
    add("landing_normal_speed", "landing speed, towards the plane",
      measure.speed(outcome.landing_normal_speed * unit));
    if (!slips) add("dip", "penetration depth", measure.length(-2 * R * outcome.dip, 3));
  }
  if (jumped && chosen.jumps > 1) {
    const heights = [...liftOffs.height].filter((_, i) => liftOffs.is_jump[i] === 1);
    add("jumps", "number of jumps", `${outcome.jumps} of ${chosen.jumps}: ` +
      heights.map((h) => measure.length(2 * R * h)).join(", "));
  }
  // The first jump may be the lowest: what its jumps come to, for who wants to go on jumping.
  if (jumped && isSteady(outcome))
    add("steady_jump", "steady jump", `${measure.length(2 * R * outcome.gait_height)}, ` +
      `${measure.speed(outcome.gait_speed)} down the plane` +
      (outcome.gait_period > 1 ? `, mean of ${outcome.gait_period} jumps in turn` : ""), outcome.gait_height);
  if (outcome.candidates > 0) {
    const after = measure.time(outcome.first_jump_time);
    add("spurious_first_jump", "first lift-off", outcome.spurious_first_jump !== 1 ? "is the jump"
      : outcome.first_jump_height > 0
        ? `below the threshold: ${measure.length(2 * R * outcome.first_jump_height, 3)} high, after ${after}`
      : `sinks at once, after ${after}: the normal force is negative`);
    add("candidates", "number of lift-offs", String(outcome.candidates));
  }
  if (slips) {
    add("phase_sequence", "phases", `${outcome.phase_sequence} (R rolls, S slides, F flies)`);
    if (Number.isFinite(outcome.slip_distance))
      add("slip_distance", "slid", measure.length(R * outcome.slip_distance));
    if (jumped) add("landing_spin", "spin after landing", measure.spin(outcome.landing_spin / second));
    if (jumped) add("energy_lost", "energy lost until the jump", measure.energy(outcome.energy_lost));
  }
  const pushes = motion.normal_force;
  if (pushes.length > 0) {
    // Up to the first jump the maximum itself, beyond it that of samples.
    const most = pushes.reduce((a, b) => Math.max(a, b), jumped ? outcome.max_normal_force : 0);
    add("most_normal_force", "largest normal force", measure.force(most),
      chosen.mass > 0 ? most * chosen.mass * design.gravity : most);
  }
  return rows;
}

/** The command line that tells the same hoop, in pieces. jumps: followed. */
export function hopCommand(design, map, defaults, jumps) {
  const contact = ["mu_static", "mu_kinetic", "restitution"];
  const flags = ["slope", "mass_ratio", "offset_ratio", "inertia_factor", "release_angle", "release_spin",
    "drive_torque", "resisting_torque", ...(map.slips ? contact : [])];
  const words = ["leapmap hop", ...flags.filter((k) => Number.isFinite(design[k]))
    .map((k) => `--${k.replaceAll("_", "-")} ${design[k]}`)];
  if (map.slips) words.push("--set friction=coulomb", `--set rest_speed=${design.rest_speed}`);
  for (const key of ["runway", "hop_height", "clear_height", "radius", "gravity"])
    if (design[key] !== undefined && design[key] !== defaults[key]) words.push(`--set ${key}=${design[key]}`);
  if (jumps > 1) words.push(`--jumps ${jumps}`);
  if (map.asked?.settle > 0) words.push(`--set settle=${map.asked.settle}`);
  if (map.tolerance !== 1e-10) words.push(`--set tolerance=${map.tolerance}`);
  return words;
}
