// The drawing as a picture: a ring with its masses, each of which can be dragged to its place.

import { drag } from "d3-drag";
import { event, select } from "d3-selection";

const ROOM = 1.15;  // radii that the picture shows on each side
const STEP = 5e-4, TURN = Math.PI / 180;  // m and rad that places are rounded to

/** moved(k, at, angle, isDone): mass k is dragged there [m, rad], within the ring. Returns
    show(drawing, body), body: what the drawing comes to, null: it is no hoop. */
export function drawingPicture(moved) {
  const svg = select("#drawing-picture").attr("viewBox", `${-ROOM} ${-ROOM} ${2 * ROOM} ${2 * ROOM}`);
  svg.append("circle").attr("class", "ring").attr("r", 1);
  svg.append("path").attr("class", "axis").attr("d", "M-0.06,0H0.06M0,-0.06V0.06");
  const masses = svg.append("g"), centre = svg.append("circle").attr("class", "centre").attr("r", 0.035);
  centre.append("title").text("centre of mass");

  return (drawing, body) => {
    const R = drawing.ring.diameter / 2, most = Math.max(1e-9, ...drawing.weights.map(({ mass }) => mass));
    const dots = masses.selectAll("circle").data(drawing.weights);
    dots.exit().remove();
    const place = ({ at, angle }) => [at / R * Math.cos(angle), -at / R * Math.sin(angle)];
    const all = dots.enter().append("circle").merge(dots)
      .attr("r", ({ mass }) => 0.06 + 0.1 * Math.sqrt(mass / most))
      .attr("cx", (weight) => place(weight)[0]).attr("cy", (weight) => place(weight)[1])
      .call(drag().on("drag end", (weight, k) => {
        const at = Math.min(R, R * Math.hypot(event.x, event.y)), angle = Math.atan2(-event.y, event.x);
        moved(k, Math.min(R, STEP * Math.round(at / STEP)), TURN * Math.round(angle / TURN),
          event.type === "end");
      }));
    all.selectAll("title").remove();
    all.append("title").text(({ name }) => `${name}: drag it to its place`);
    const { eccentricity: away, direction } = body ?? { eccentricity: 0, direction: 0 };
    centre.attr("cx", away * Math.cos(direction)).attr("cy", -away * Math.sin(direction));
  };
}
