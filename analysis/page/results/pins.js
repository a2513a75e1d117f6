// Up to four designs side by side: their numbers in a table, as CSV and as commands, and their hoops jumping
// beside the one shown.

import { designOf, wordsOf } from "../state/address.js";
import { element, notice } from "../dom.js";
import { NO_LIVE_AXIS, SLIPPING } from "../state/ranges.js";
import { PIN_COLOURS, PIN_INKS } from "../state/tones.js";
import { inShownUnit, short, toldIn, withUnit } from "../state/units.js";
  // of numbers on them
const MOST_PINS = PIN_COLOURS.length;
const PINNED = [["jump_height", "jump height", "diameters"], ["jump_time", "lift-off after", "s"],
  ["apex_time", "apex after lift-off", "s"], ["flight_time", "landing after lift-off", "s"],
  ["jump_spin", "spin at lift-off", "√(g/R)"], ["jump_distance", "rolled until lift-off", "R"],
  ["candidates", "number of lift-offs", ""]];

/** command(design): that tells it; changed(): what is pinned is another. Returns {pin(design), designs(),
    show(), write, read}. */
export function pinsPart(map, solver, command, changed) {
  const part = element("pins"), table = element("pins-table"), pins = [];
  map.pins = [];
  const csv = element("pins-csv"), commands = element("pins-commands");
  const cell = (kind, text) =>
    { const made = document.createElement(kind); made.textContent = text; return made; };

  function show() {
    part.hidden = pins.length === 0;
    // the model may be another now
    for (const pin of pins) pin.outcome = solver.solve(pin.design, map.slips, map.tolerance).outcome;
    const keys = [...new Set(pins.flatMap(({ design }) => Object.keys(design)))]
      .filter((key) => key in map.parameters
        && new Set(pins.map(({ design }) => design[key])).size > (pins.length > 1 ? 1 : 0))
        .filter((key) => pins.some(({ design }) => Number.isFinite(design[key])));
    const head = document.createElement("tr");
    head.append(cell("th", "design"), ...pins.map((pin, i) => {
      const th = cell("th", ""), mark = cell("span", String(i + 1)), away = cell("button", "×");
      mark.className = "pin-mark";
      Object.assign(mark.style, { background: PIN_COLOURS[i], color: PIN_INKS[i] });
      away.type = "button";
      away.setAttribute("aria-label", `unpin design ${i + 1}`);
      away.addEventListener("click", () => { pins.splice(pins.indexOf(pin), 1); show(); changed(); });
      th.scope = "col";
      th.append(mark, away);
      return th;
    }));
    const row = (words, texts) =>
      { const tr = document.createElement("tr"), th = cell("th", words); th.scope = "row";
      tr.append(th, ...texts.map((text) => cell("td", text))); return tr; };
    const rows = keys.map((key) =>
      row(map.parameters[key].label,
      pins.map(({ design }) =>
      withUnit(short(inShownUnit(map.parameters[key], design[key])), map.parameters[key].unit))));
    rows.push(row("outcome", pins.map(({ outcome }) => outcome.status.replaceAll("_", " "))));
    for (const [key, words, unit] of PINNED)
      if (pins.some(({ outcome }) => Number.isFinite(outcome[key])))
        rows.push(row(words,
          pins.map(({ design, outcome }) =>
          (Number.isFinite(outcome[key]) ? toldIn(outcome[key], unit, design, 5) : ""))));
    table.replaceChildren(head, ...rows);
    // A list that leapmap sweep --points reads: parameters that may differ from design to design, angles in
    // radians.
    const listed = Object.keys(map.parameters)
      .filter((key) => !NO_LIVE_AXIS.includes(key) && (map.slips || !SLIPPING.includes(key))
      && pins.every(({ design }) => Number.isFinite(design[key])));
    const lines = [["label", ...listed],
      ...pins.map(({ design }, i) => [`pin ${i + 1}`, ...listed.map((key) => design[key])])];
    csv.href = URL.createObjectURL(new Blob([lines.map((line) => line.join(",")).join("\n") + "\n"],
      { type: "text/csv" }));
    csv.dataset.text = lines.map((line) => line.join(",")).join("\n");
    commands.textContent = pins.map(({ design }) => command(design)).join("\n");
    map.pins = pins.map(({ design }) => design);  // for the map to mark
  }

  const add = (design) => pins.push({ design: { ...design }, outcome: null });

  return {
    pin(design) {
      if (pins.length >= MOST_PINS) { notice(`There is room for ${MOST_PINS} designs; unpin one first.`);
          return; }
      notice("");
      add(design);
      show();
      changed();
    },
    show,
    designs: () => pins.map(({ design }) => design),
    write(words) {
      for (const { design } of pins)
        words.append("pin",
          wordsOf(design, Object.keys(solver.defaults)
          .filter((name) => !Object.is(design[name], map.fixed[name]))));
    },
    read(words) {
      const wanted = words.getAll("pin").slice(0, MOST_PINS)
        .map((text) => designOf(text, solver.ranges)).filter((design) => design);
      pins.length = 0;
      for (const design of wanted) add({ ...map.fixed, ...design });
      show();
    },
  };
}
