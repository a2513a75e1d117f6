// The page: what belongs to what.

import { addressButtons, addressPart, addressWords, noteAddress, readAddress } from "./state/address.js";
import { cutsPart } from "./map/cuts.js";
import { applies, offerGrouped, optionOf } from "./map/described.js";
import { element, notice, option } from "./dom.js";
import { choicesOf, scaleOf } from "./state/drawn.js";
import { saveButtons } from "./export/export.js";
import { barBrush } from "./goals/bar_brush.js";
import { filtersPart } from "./goals/filters.js";
import { linesPart } from "./goals/lines.js";
import { hopPanel } from "./hoop/hop_panel.js";
import { LIVE_SUBTITLE, showHeading } from "./heading.js";
import { showLegend } from "./map/legend.js";
import { addressed, askedOfFile } from "./links.js";
import { listView } from "./map/list_view.js";
import {
  costEach, isAsMade, isCostly, liveEngine, liveMap, settleMap, toAsk,
} from "./solver/live.js";
import { liveControls, liveState, settlePart } from "./inputs/live_controls.js";
import { madeTeller } from "./solver/made.js";
import { mapView } from "./map/map_view.js";
import { readoutPart } from "./results/readout.js";
import { tolerancesPart } from "./inputs/tolerances.js";
import { onTones } from "./state/tones.js";
import { fieldLabel, inShownUnit, short, unitsPart, withUnit } from "./state/units.js";
const NOTHING_YET = { coarse: "false", whole: "false", cliffs: "false" };

/** On a small screen the inputs are a sheet from below. */
export function sheetPart() {
  const toggle = element("inputs-toggle");
  const open = (isOpen) => {
    document.body.classList.toggle("inputs-open", isOpen);
    toggle.setAttribute("aria-expanded", String(isOpen));
    toggle.textContent = isOpen ? "Close" : "Inputs and goals";
  };
  toggle.addEventListener("click", () => open(!document.body.classList.contains("inputs-open")));
  document.addEventListener("keydown", (event) => { if (event.key === "Escape") open(false); });
}

/** Lets the browser draw and listen between two pieces of work. */
const aMoment = () => new Promise((goOn) => { setTimeout(goOn); });

/** Starts with a map that is solved as one looks. */
export async function startLive(given, module, solver) {
  const map = liveMap(given, solver, liveState(addressWords(), solver));
  const teller = madeTeller(module, element("worker").textContent);
  let page = null, settled = 0, again = false;
  const early = new Set();  // pictures that were there before the page was
  const show = (what) => {
    const { dataset } = element("map");
    if (what === "none" || what === "cleared") {
      Object.assign(dataset, NOTHING_YET);
      early.clear();
      page?.begun(what === "cleared");
      return;
    }
    if (!page) { early.add(what); return; }
    dataset.coarse = "true";
    if (what === "coarse discontinuities") page.view.overlayCliffs();
    else if (what === "cliffs") page.showCurves(); else page.repaint(what === "part");
    Object.assign(dataset,
      { whole: String(what === "whole" || what === "cliffs"), cliffs: String(what === "cliffs"),
      generation: String(Number(dataset.generation ?? 0) + 1) });
    if (what === "cliffs") window.explorer.timing = engine.timing();
    if (what === "whole") { window.explorer.timing = engine.timing(); page.again(); noteAddress(); }
  };
  const engine = liveEngine(map, module, element("worker").textContent, show, (share, left) => {
    element("subtitle").textContent = Number.isNaN(share) ? "Solving has stopped" : share < 1
      ? `${(100 * share).toFixed(0)} % of the designs are solved; ` +
      `${left < 100 ? `${left.toFixed(0)} s` : `${(left / 60).toFixed(0)} min`} to go` : LIVE_SUBTITLE;
  });
  const begin = map.refresh = () => { Object.assign(element("map").dataset, NOTHING_YET); engine.begin(); };
  settleMap(map);
  const controls = liveControls(map, solver, (what) => {
    if (what === "model" && page) page.remodel();
    // At once, and then once a picture, however often a slider tells.
    if (settled) { again = true; return; }
    begin();
    settled = requestAnimationFrame(function next() {
      settled = again ? requestAnimationFrame(next) : 0;
      if (again) begin();
      again = false;
    });
  });
  addressPart(settlePart(map));
  addressPart(controls);  // begins anew, by what is told above
  begin();
  page = await start(map, solver, teller);  // which may start the map again, by what the address wants
  if (early.size > 0) show(early.has("whole") ? "whole" : "part");
  if (early.has("cliffs")) show("cliffs");
}

export async function start(map, solver, teller) {
  Object.assign(map, { solver, defaults: solver.defaults });
  // Of a file's map a hoop of one's own is told what the map's designs are.
  map.settle = Math.min(map.settle, element("settle").max);
  map.asked ??= askedOfFile(map);
  const canvas = element("map");
  showHeading(map);

  let drawCuts = () => {}, filters = null, lines = null, bar = () => {};
  const readout = readoutPart(map, { view: () => view, panel: () => chosen,
    moved() { drawCuts(); lines?.point(); } });
  const chosen = hopPanel(map, solver, {
    ofItsOwn(title, outcome, design) {
      view.view.picked = null;
      view.paint();
      readout.showOwn({ title, outcome, design });
    },
    otherUnits: () => tellUnits(),
    pinned: () => view.paint(),
    followed() { offerFields(); map.refresh?.(); },
    teller,
    toldMore: readout.knowMore,
  });
  const view = (map.columns ? listView : mapView)(canvas, map, readout.point, (index, byHand) => {
    readout.forgetOwn();
    chosen.show(index, byHand);
    readout.invalidate();
    readout.show(index);
  });
  canvas.addEventListener("pointerleave", readout.leave);

  // Slope to the right and mass ratio up where there are both, as on the charts; never an axis of one value
  // if there are others.
  const choices = choicesOf(map);
  const liked = (axis, k) =>
    [axis.values.length > 1 ? 0 : 1, ["slope", "mass_ratio"].includes(axis.name) ? 0 : 1,
    axis.name === "slope" ? 0 : 1, k];
  if (map.live) { view.view.x = 0; view.view.y = 1; }
  const order = choices.map(liked).sort((a, b) => a.reduce((sum, v, i) => sum || v - b[i], 0));
  if (!map.live) view.view.x = order[0][3];
  if (!map.live && !map.columns) view.view.y = order[1][3];
  // A front stands as it was asked for: the first objective up, the second to the right.
  if (map.columns && map.objectives.length === 2) {
    const right = map.columns.findIndex((c) => c.name === map.objectives[1]),
      up = map.fields.find((f) => f.name === map.objectives[0]);
    if (right >= 0 && up) Object.assign(view.view, { x: right, field: up });
  }

  const fieldSelect = element("field"), selects = map.columns ? { x: element("x-axis") }
    : { x: element("x-axis"), y: element("y-axis") };
  element("y-axis").parentElement.hidden = Boolean(map.columns) || Boolean(map.live);
  element("x-axis").parentElement.hidden = Boolean(map.live);
  offerGrouped(map, fieldSelect);
  fieldSelect.value = map.fields.indexOf(view.view.field);
  /** Offers what the model has. */
  const offerFields = () => {
    map.fields.forEach((f, k) => {
      const offered = optionOf(fieldSelect, k);
      offered.hidden = offered.disabled = !applies(map, f);
    });
    if (!applies(map, view.view.field)) { fieldSelect.value = 0; view.view.field = map.fields[0]; }
  };
  offerFields();
  for (const select of Object.values(selects)) choices.forEach((a, k) => option(select, k, a.label));
  map.wanted = () => [view.view.field, ...(filters?.fields() ?? []), ...(lines?.fields() ?? [])];
  map.hoopGoals = () => filters?.ofHoops() ?? [];
  /** Solves a live map anew if it has not the numbers of all that is wanted, or is still after some that are
      not. */
  const tellWanted = () => {
    if (!map.live) return;
    const { asked } = map, wanted = toAsk(map), isThere = element("map").dataset.whole === "true";
    element("settle").parentElement.hidden = wanted.settle === 0;
    const lacks = (wanted.settle && wanted.settle !== asked.settle) || (wanted.growth && !asked.growth)
      || (wanted.made && !isAsMade(map));
    if (!lacks && (isThere || costEach(wanted) >= costEach(asked))) return;
    map.refresh();
    chosen.follow();
  };
  const showField = () => {
    view.view.field = map.fields[fieldSelect.value];
    tellWanted();
    view.paint();
    legend();
    readout.showCurrent();
    drawCuts();
    filters?.tell();
  };
  fieldSelect.addEventListener("change", () => { showField(); noteAddress(); });
  const firstField = fieldSelect.value;
  addressPart({
    write(words) { if (fieldSelect.value !== firstField) words.set("field", view.view.field.name); },
    read(words) {
      const at = map.fields.findIndex((f) => f.name === words.get("field"));
      if (words.has("field") && at < 0)
        notice(`The address asks for a field that is not on this map: ${words.get("field")}`);
      fieldSelect.value = at < 0 ? firstField : at;
      showField();
    },
  });
  for (const [key, select] of Object.entries(selects))
    select.addEventListener("change", () => {
      const other = key === "x" ? "y" : "x", taken = Number(select.value);
      if (view.view[other] === taken) view.view[other] = view.view[key];
      view.view[key] = taken;
      arrange();
      view.paint();
      drawCuts();
      legend();
      noteAddress();
    });

  /** A slider for every axis that is not on the screen. */
  function arrange() {
    for (const [key, select] of Object.entries(selects)) select.value = view.view[key];
    if (map.columns) return;
    element("sliders").replaceChildren(...map.axes.flatMap((axis, k) => {
      if (k === view.view.x || k === view.view.y) return [];
      const label = document.createElement("label"), slider = document.createElement("input"),
        value = document.createElement("output");
      slider.type = "range";
      slider.min = "0";
      slider.max = String(axis.values.length - 1);
      slider.value = view.view.index[k];
      slider.dataset.axis = axis.name;
      const tell = () => { value.textContent =
        withUnit(short(inShownUnit(axis, axis.values[view.view.index[k]])), axis.unit);
        slider.setAttribute("aria-valuetext", value.textContent); };
      slider.addEventListener("input", () => {
        view.view.index[k] = Number(slider.value);
        tell();
        view.paint();
        readout.show(view.view.index);
        noteAddress();
      });
      tell();
      label.append(axis.label, slider, value);
      return [label];
    }));
  }

  const legend = () => { showLegend(map, view); bar(); lines?.show(); };

  // Begin where the paper's hoop is, if it is on the map, else in the middle.
  if (!map.columns) map.axes.forEach((axis, k) => {
    const wanted = map.paper[axis.name];
    if (wanted === undefined) return;
    const away = axis.values.map((v) => Math.abs(v - wanted));
    view.view.index[k] = away.indexOf(Math.min(...away));
  });
  arrange();
  view.paint();
  legend();
  readout.show(view.view.index);
  const pictureName = () => `${map.name.replace(/\.[^.]*$/, "")}_${view.view.field.name}`;
  saveButtons("map", canvas, pictureName, (like) => view.paintOn(like.getContext("2d")));
  element("cuts").hidden = Boolean(map.columns);
  if (!map.columns) drawCuts = cutsPart(map, view);
  filters = map.columns ? null
    : filtersPart(map, view,
      () => { tellWanted(); view.paint(); chosen.recount(); bar(); lines?.show(); }, (index) =>
      { view.view.index = index; arrange(); view.paint(); view.pick(); });
  element("lines-part").hidden = Boolean(map.columns);
  if (filters) {
    bar = barBrush(view, filters);
    lines = linesPart(map, view, filters, tellWanted);
    new ResizeObserver(bar).observe(canvas);
  }
  element("filters").hidden = Boolean(map.columns);
  const tolerances = map.live
    ? tolerancesPart(map, () => {
      tellWanted();
      filters.tell();
      readout.invalidate();
      readout.showCurrent();
      chosen.haunt();
    }) : null;
  if (tolerances) addressPart(tolerances);
  if (filters) { addressPart(filters); addressPart(lines); }
  const tellUnits = () => {
    readout.invalidate();
    map.fields.forEach((f, k) => { optionOf(fieldSelect, k).textContent = fieldLabel(f, scaleOf(map, f)); });
    view.paint();
    filters?.tell();
    drawCuts();
    readout.showCurrent();
    chosen.retell();
    noteAddress();
  };
  addressPart(unitsPart(tellUnits));
  onTones(() => { view.paint(); drawCuts(); legend(); });
  // The design that the address asks for, unless it asks for a hoop of its own.
  const home = [...view.view.index], homeAxes = [view.view.x, view.view.y];
  if (!map.live) addressPart({
    write(words) {
      const { x, y } = view.view;
      if (x !== homeAxes[0]) words.set("right", choices[x].name);
      if (map.columns) return;
      if (y !== homeAxes[1]) words.set("up", choices[y].name);
      map.axes.forEach((axis, k) =>
        { if (k !== x && k !== y && view.view.index[k] !== (view.view.picked ?? home)[k])
        words.append("at", `${axis.name}:${view.view.index[k]}`); });
    },
    read(words) {
      const [x, y] = ["right", "up"].map((key, k) =>
        { const at = choices.findIndex(({ name }) => name === words.get(key));
        return at < 0 ? homeAxes[k] : at; });
      view.view.x = x;
      if (!map.columns) {
        view.view.y = x === y ? homeAxes[x === homeAxes[0] ? 1 : 0] : y;
        view.view.index = [...home];
        for (const [name, text] of words.getAll("at").map((word) => word.split(":"))) {
          const k = map.axes.findIndex((axis) => axis.name === name);
          if (k >= 0 && /^\d+$/.test(text) && Number(text) < map.axes[k].values.length)
            view.view.index[k] = Number(text);
          else notice(`The address asks for a place that is not on this map: ${name}`);
        }
      }
      arrange();
      view.paint();
      legend();
    },
  });
  addressPart({
    write() {},
    done() { view.paint(); legend(); },
    read(words) {
      const asked = addressed(map, words);
      if (asked.index || !(words.has("paper") || words.has("hoop"))) {
        const slices = view.view.index;
        view.view.index = asked.index ?? [...home];
        view.pick();
        if (words.has("at"))
          view.view.index = view.view.index.map((i, k) =>
            (k === view.view.x || k === view.view.y ? i : slices[k]));
        arrange();
        view.paint();
        readout.show(view.view.index);
      }
      // On a phone the hoop that a link is about comes first.
      document.body.classList.toggle("hoop-first", words.has("paper") || words.has("hoop"));
      if (asked.time !== undefined) chosen.stopAt(asked.time);
    },
  });
  window.explorer = { map, view, solver };
  await aMoment();
  readAddress(true);
  addressButtons();
  noteAddress();
  return {
    view,
    /** After more of a live map is there. */
    repaint(rough) {
      readout.invalidate();
      view.paint(rough);
      if (rough && !isCostly(map.asked)) return;
      filters?.tell();
      legend();
      readout.showCurrent();
      drawCuts();
    },
    /** After the curves of a live map are there: of its numbers none is another. */
    showCurves() { view.paint(); legend(); drawCuts(); },
    /** Another map is begun: a hoop that is none of it is told what is asked now. */
    begun(cleared) {
      if (cleared) this.repaint(true);
      if (!chosen.isOfMap()) chosen.follow();
    },
    /** The hoop shown, of the same place on another map. */
    again() { if (view.view.picked && chosen.isOfMap()) chosen.show(view.view.picked, false, true);
      else chosen.follow(); },
    /** Another model: what is told of a hoop is another. */
    remodel() { element("paper").hidden = map.slips; offerFields(); tolerances.remodel(); chosen.remodel();
      legend(); },
  };
}
