// Hoops as made after the designs of a map: by which tolerances, how many, and what of them is asked of the
// solver.

import { noteAddress } from "../state/address.js";
import { element, notice, option, stepsOf } from "../dom.js";
import { RATIOS, drawnNames, isDrawn, partOf } from "../state/drawn.js";
import { countPart, designParameters } from "./live_controls.js";
import { USUAL_SPREADS } from "../solver/made.js";
import { perUnit, short } from "../state/units.js";
const LAWS = ["normal", "uniform"];

/** A tolerance as the address has it. */
export const spreadWord = ({ name, law, width, percent }) =>
  [name, law, Number(width.toPrecision(12)), ...(percent ? ["percent"] : [])].join(":");

/** By which tolerances hoops of a live map are made, and how many; changed(): others are wanted. */
export function tolerancesPart(map, changed) {
  const part = element("tolerances"), list = element("spreads"), rows = [];
  part.hidden = false;
  /** What may scatter beside those others: a hoop has a drawing's numbers or ratios. */
  const spreadNames = (others) => [
    ...designParameters(map).filter((name) => !(others.some(isDrawn) && RATIOS.includes(name))),
    ...(map.axes.some(({ name }) => RATIOS.includes(name)) ? [] : drawnNames(map.drawing))];
  const freeNames = (others) => spreadNames(others).filter((name) => !others.includes(name));
  const ownValue = (name) => {
    if (!isDrawn(name)) return map.fixed[name];
    const [part, key] = partOf(map.drawing, name);
    return part[key];
  };
  const factor = ({ name, percent }) => (percent ? 1 : perUnit(map.parameters[name].unit));

  function take() {
    map.spreads = rows.map(({ spread }) => spread);
    const nothing = map.spreads.find(({ name, width, percent }) => percent && width > 0
      && ownValue(name) === 0 && !map.axes.some((axis) => axis.name === name));
    notice(nothing ? `${map.parameters[nothing.name].label} is 0, and ${short(nothing.width)} % of it is ` +
      `0: give the tolerance in its own unit.` : "");
    map.respread?.();
    changed();
    noteAddress();
  }

  /** Takes away what cannot stand beside the rest, and says so. Returns what it said, or "". */
  function drop(isWrong, why) {
    const dropped = rows.filter(({ spread }) => isWrong(spread)).map(({ spread }) => spread);
    if (dropped.length === 0) return "";
    begin(rows.map(({ spread }) => spread).filter((spread) => !dropped.includes(spread)));
    map.spreads = rows.map(({ spread }) => spread);
    const said = `${why}: ${dropped.map(({ name }) => map.parameters[name]?.label ?? name).join(", ")}`;
    notice(said);
    return said;
  }
  map.showSpreads = () => showAll();
  map.dropSpreads = (isWrong) => drop(isWrong, "No tolerance any more of");
  /** A drawing's number scatters: ratios, which follow from the drawing, do not. */
  const dropRatios = () => (rows.some(({ spread }) => isDrawn(spread.name))
    ? drop(({ name }) => RATIOS.includes(name), "Tolerances of the drawing take the place of those of") : "");

  function row(asked) {
    const spread = { ...asked }, item = document.createElement("li"),
      [name, law, unit] = [0, 1, 2].map(() => document.createElement("select"));
    const number = document.createElement("input"), away = document.createElement("button"),
      each = { spread, away };
    const show = () => {
      const others = rows.filter((other) => other !== each).map((other) => other.spread.name),
        own = map.parameters[spread.name].unit;
      name.replaceChildren();
      freeNames(others).forEach((other) => option(name, other, map.parameters[other].label.split(" [")[0]));
      unit.replaceChildren();
      option(unit, "%", "%");
      option(unit, "own", own || "of its own");
      const words = map.parameters[spread.name].label.split(" [")[0];
      name.setAttribute("aria-label", `tolerance of ${words}: parameter`);
      law.setAttribute("aria-label", `tolerance of ${words}: distribution`);
      number.setAttribute("aria-label", `tolerance of ${words}: width`);
      unit.setAttribute("aria-label", `tolerance of ${words}: unit`);
      away.setAttribute("aria-label", `remove the tolerance of ${words}`);
      name.value = spread.name;
      law.value = spread.law;
      unit.value = spread.percent ? "%" : "own";
      if (document.activeElement === number) return;
      number.value = String(Number((spread.width * factor(spread)).toPrecision(6)));
      number.setAttribute("aria-invalid", "false");
    };
    each.show = show;
    option(law, "normal", "normal, σ =");
    option(law, "uniform", "uniform, ±");
    Object.assign(number, { type: "number", min: 0, step: "any" });
    Object.assign(away, { type: "button", textContent: "×" });
    /** The number shown stays, whatever it is of. */
    const change = (what) => {
      const shown = spread.width * factor(spread);
      Object.assign(spread, what);
      spread.width = shown / factor(spread);
      const said = dropRatios();
      showAll();
      take();
      if (said) notice(said);
    };
    name.addEventListener("change", () => change({ name: name.value }));
    law.addEventListener("change", () => change({ law: law.value }));
    unit.addEventListener("change", () => change({ percent: unit.value === "%" }));
    stepsOf(number, () => 2 * Number(number.value) || 1);
    number.addEventListener("change", () => {
      const good = number.value !== "" && number.checkValidity();
      number.setAttribute("aria-invalid", String(!good));
      notice(good ? "" : "A tolerance is a number, 0 or more.");
      if (!good) return;
      spread.width = Number(number.value) / factor(spread);
      take();
    });
    away.addEventListener("click", () => {
      const at = rows.indexOf(each);
      rows.splice(at, 1);
      item.remove();
      showAll();
      (rows[at]?.away ?? add).focus();
      take();
    });
    item.append(name, law, number, unit, away);
    list.append(item);
    rows.push(each);
    each.focus = () => number.focus();
  }
  const add = element("spread-add");
  function showAll() {
    for (const { show } of rows) show();
    add.disabled = freeNames(rows.map(({ spread }) => spread.name)).length === 0;
  }
  function begin(spreads) {
    rows.length = 0;
    list.replaceChildren();
    for (const spread of spreads) row(spread);
    showAll();
  }
  add.addEventListener("click", () => {
    const [name] = freeNames(rows.map(({ spread }) => spread.name)),
      angle = map.parameters[name].unit === "°";
    row({ name, law: "normal", width: angle ? Math.PI / 180 : 1, percent: !angle && ownValue(name) !== 0 });
    showAll();
    rows.at(-1).focus();
    take();
  });
  const samples = countPart(map, "samples", "The number of manufactured hoops per design", changed);
  begin(map.spreads);

  const usual = USUAL_SPREADS.map(spreadWord).join();
  function spreadOf(word) {
    const [name, law, width, percent] = word.split(":");
    return spreadNames([]).includes(name) && LAWS.includes(law) && width !== "" && Number(width) >= 0
      && Number.isFinite(Number(width)) && [undefined, "percent"].includes(percent)
      ? { name, law, width: Number(width), percent: percent === "percent" } : null;
  }
  return {
    /** Another model: other parameters may scatter. */
    remodel() {
      drop(({ name }) => !isDrawn(name) && !designParameters(map).includes(name),
        "Without slip there is no tolerance of");
    },
    write(words) {
      const told = map.spreads.map(spreadWord);
      if (told.join() !== usual) for (const word of told.length > 0 ? told : ["none"])
        words.append("made", word);
      samples.write(words);
      if (map.seed !== 1) words.set("seed", map.seed);
    },
    read(words) {
      const asked = words.getAll("made"), spreads = [];
      for (const word of asked.filter((each) => each !== "none")) {
        const spread = spreadOf(word);
        if (spread && !spreads.some(({ name }) => name === spread.name)) spreads.push(spread);
        else notice(`The address asks for a tolerance that is not possible: ${word}`);
      }
      const sigma = Number(words.get("sigma"));  // as addresses had it before each tolerance had its own word
      begin(asked.length > 0 ? spreads
        : USUAL_SPREADS.map((spread) => (sigma > 0 ? { ...spread, width: sigma } : spread)));
      dropRatios();
      map.spreads = rows.map(({ spread }) => spread);
      map.respread?.();
      samples.read(words);
      map.seed = /^\d{1,15}$/.test(words.get("seed") ?? "1") ? Number(words.get("seed") ?? 1) : 1;
      if (words.has("seed") && String(map.seed) !== words.get("seed"))
        notice(`The address asks for seed=${words.get("seed")}, which is not possible and is ignored.`);
      if (asked.length > 0) part.open = true;
    },
  };
}
