// Goals by hand: the stretch of the map's colour bar that one brushes is what designs are to have.

import { brushY } from "d3-brush";
import { event, select } from "d3-selection";

import { valueOnScale } from "../map/scales.js";

/** Over the colour bar of a map's view; goals: with range(field) and setRange(field, least, most). Returns
    show(), to be called whenever the picture or the goals are others. */
export function barBrush(view, goals) {
  const svg = select("#bar-brush"), group = svg.append("g");
  let height = 0;
  const field = () => view.view.field;
  const brush = brushY().on("brush end", () => {
    if (!event.sourceEvent) return;  // moved by show()
    const [top, bottom] = event.selection ?? [0, height];
    const at = (pixel) => valueOnScale(field(), 1 - pixel / height);
    goals.setRange(field(), bottom < height ? at(bottom) : -Infinity, top > 0 ? at(top) : Infinity);
  });

  function show() {
    const bar = view.bar();
    svg.attr("hidden", bar ? null : "");
    if (!bar) return;
    if (event?.sourceEvent) return;  // the hand is on it
    height = bar.height;
    for (const side of ["left", "top", "width", "height"]) svg.style(side, `${bar[side]}px`);
    group.call(brush.extent([[0, 0], [bar.width, bar.height]]));
    const [least, most] = goals.range(field());
    group.call(brush.move, least === -Infinity && most === Infinity ? null
      : [most, least].map((value) => height * (1 - field().place(value))));
  }
  return show;
}
