// What stands above and below everything: what the page is of, and where its numbers are from.

import { element } from "./dom.js";

export const LIVE_SUBTITLE =
  "Change any parameter: the map follows. Click a design to see it jump. The address stores the view.";

export function showHeading(map) {
  document.title = `${map.name}: leapmap explorer`;
  element("title").textContent = map.title || map.name;
  element("subtitle").textContent = map.live ? LIVE_SUBTITLE
    : `${map.name}: ${map.designs.toLocaleString("en")} designs` +
    (map.computed < 1 ? `, INCOMPLETE: ${(100 * map.computed).toFixed(0)} % of them computed` : "") +
    `; ${map.about.join(", ")}`;
  element("footer").textContent =
    (map.live ? "Every number is computed by leapmap in this page"
    : `Made by leapmap ${map.program}, which runs in this page as well. The map's numbers are rounded as ` +
    `shown`) +
    (map.method === "exact" ? "" : `; the map was solved by ${map.method}, the hoop by exact`) +
    (map.left_out.length ? `; left out for size: ${map.left_out.join(", ")}` : "") +
    (map.beyond_page?.length ? `; in the map's numbers, not in this page's: ${map.beyond_page.join(", ")}`
    : "") +
    (map.wall ? `; a wall of ${map.wall}, which the page's hoops do not have, is in the map's numbers` : "") +
    (map.fields.some((f) => f.name === "agility")
      ? `. Salto ${map.jumpers.Salto} m/s, galago ${map.jumpers.galago} m/s: ${map.jumpers_source}` : "")
      + ".";
}
