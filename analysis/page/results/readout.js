// The line below the map: what is known of the design pointed at or of the hoop shown, and of every other
// quantity beside.

import { applies, placeText } from "../map/described.js";
import { element } from "../dom.js";
import { isSteady } from "./numbers.js";
import { decimalsOf } from "../solver/decode.js";
import { costOf, toldFields } from "../solver/live.js";
import { scaleOf } from "../state/drawn.js";
import { alsoAs, short, toldIn, withUnit } from "../state/units.js";

const PAUSE = 600;  // ms that a text stands before it is spoken

/** view(): the map's; panel(): that of the hoop shown; moved(): another design is pointed at. */
export function readoutPart(map, { view, panel, moved }) {
  // what is told; the hoop beside, if it is none of the map's; whether one points at the map
  let said = "", own = null, points = false, speaking = 0;
  const field = () => view().view.field;
  /** Of every quantity but the one shown a row, whether there is a number or none, so that nothing below
      moves. */
  const tellOthers = (textOf) => element("others")
    .replaceChildren(...toldFields(map).filter((f) => f !== field() && applies(map, f)).map((f) => {
    const pair = document.createElement("div"), name = document.createElement("dt"),
      value = document.createElement("dd");
    name.textContent = f.label.split(":")[0];
    value.textContent = textOf(f) || "–";
    pair.append(name, value);
    return pair;
  }));
  /** Puts what is told there and, once it has stood for a while, to who listens. */
  function put(place, texts, index, value) {
    element("place").textContent = place;
    element("value").textContent = texts.filter(Boolean).join("; ");
    Object.assign(element("readout").dataset, { index, value });
    clearTimeout(speaking);
    speaking = setTimeout(() =>
      { element("spoken").textContent = `${place}. ${element("value").textContent}`; }, PAUSE);
  }
  /** The height is that of the first jump: the steady one beside it, of the hoop that is shown. */
  const steadyNote = ({ outcome, design }) =>
    (field().name === "jump_height" && isSteady(outcome)
    ? `steady jump ${toldIn(outcome.gait_height, "diameters", design)}` : "");

  function tellOwn() {
    const { outcome, title, design } = own, f = field(), v = outcome[f.name];
    said = "";
    const instead = v === undefined ? (map.asked.made ? "being solved" : "unknown")
      : outcome.status === "jumped" ? "none" : outcome.status.replaceAll("_", " ");
    const text = Number.isFinite(v) ? withUnit(short(v, 6), f.unit) + alsoAs(f, v, design) : instead;
    put(title, [`${f.label}: ${text}`, steadyNote(own)], "", Number.isFinite(v) ? String(v) : "");
    tellOthers((each) => (each.name === "candidates" ? String(outcome.candidates)
      : Number.isFinite(outcome[each.name]) ? toldIn(outcome[each.name], each.unit, design) : ""));
  }

  /** What is unusual about a design of the map. */
  function notesOf(at) {
    const status = map.codes.status?.meanings[map.codes.status.values[at]],
      spurious = map.codes.spurious_first_jump?.values[at] === 1;
    const notes = status === "no_jump" && spurious
      ? [`no jump: all lift-offs below ${toldIn(map.fixed.hop_height, "diameters", scaleOf(map))}`]
      : [status === undefined || status === "jumped" ? "" : status.replaceAll("_", " "),
        spurious ? "the first lift-off is below the threshold" : ""];
    return notes.filter(Boolean).map((note) => (field().made ? `nominal: ${note}` : note));
  }

  function show(index) {
    const at = view().offset(index), shown = field(), key = `${index} ${shown.name}`;
    if (key === said) return;  // the pointer moved inside a cell
    said = key;
    moved();
    const number = (f) =>
      (f.values[at] === f.values[at]
      ? (map.live && f.log ? short(f.values[at], 6) : f.values[at].toFixed(decimalsOf(f.step))) : "");
    const isSolving = (f) =>
      map.live && costOf(f) && !number(f) && element("map").dataset.coarse !== "true";
    const text = (f) =>
      (number(f) ? withUnit(number(f), f.unit) + alsoAs(f, f.values[at], scaleOf(map, f)) : isSolving(f)
      ? "being solved" : "none");
    put(placeText(map, index), [`${shown.label}: ${text(shown)}`,
      panel().isOf(index) ? steadyNote(panel().hoop()) : "", ...(isSolving(shown) ? [] : notesOf(at))],
      index.join(","), number(shown));
    tellOthers((f) => (number(f) ? alsoAs(f, f.values[at], scaleOf(map, f)).slice(3) || text(f) : ""));
  }

  return {
    show,
    /** What is there is out of date: it is written anew next time, even for the same design. */
    invalidate() { said = ""; },
    /** The pointer is on a design, or leaves the map. */
    point(index) { points = true; show(index); },
    leave() { points = false; if (own) tellOwn(); },
    /** A hoop is shown that is none of the map's; more is known of it; one of the map's is shown instead. */
    showOwn(hoop) { own = hoop; points = false; tellOwn(); },
    knowMore(outcome) { if (own) own.outcome = outcome; if (own && !points) tellOwn(); },
    forgetOwn() { own = null; },
    showCurrent() { if (own && !points) tellOwn(); else show(view().view.index); },
  };
}
