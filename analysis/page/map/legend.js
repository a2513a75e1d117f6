// What the map's signs and colours mean.

import { isOfFirstJump } from "./axes.js";
import { element } from "../dom.js";
import { DASHES } from "./map_view.js";
import { muted } from "./scales.js";
import { tones } from "../state/tones.js";

/** A quantity's colours as they are below the threshold, from left to right. */
const mutedScale = ({ table }) => `linear-gradient(90deg, ${[20, 128, 235].map((c) =>
  `rgb(${muted([...table.subarray(3 * c, 3 * c + 3)]).join()})`).join()})`;

/** Lists the signs and colours that the map has now. */
export function showLegend(map, view) {
  const entry = (words, colour, image) => {
    const item = document.createElement("li"), swatch = document.createElement("span");
    swatch.className = "swatch";
    swatch.style.background = image ?? colour;
    item.append(swatch, words);
    return item;
  };
  const items = [];
  const { field } = view.view, showsSpurious = isOfFirstJump(field)
    && map.codes.spurious_first_jump?.values.includes(1);
  if (showsSpurious && !map.columns)
    items.push(entry("first lift-off below the threshold", "", mutedScale(field)));
  // Of hoops as made a number stands wherever there are some.
  const bare = field.made
    && new Set(map.codes.status?.values.filter((_, k) => Number.isNaN(field.values[k])));
  map.codes.status?.shown.forEach(({ colour, words }, k) => {
    const jumped = map.codes.status.meanings[k] === "jumped";
    if (!jumped && (bare ? bare.has(k) : map.codes.status.values.includes(k)))
      items.push(entry(words, colour));
    if (jumped && bare && bare.has(k))
      items.push(entry("unknown: more than half of a tolerance is outside its domain", "#ffffff"));
  });
  if (field.gait) items.push(entry(field.name === "gait_period" ? "no gait found"
      : "no gait: none found, or the jumps end", "#ffffff"));
  const symbol = (words, sign, colour) => {
    const item = document.createElement("li"), mark = document.createElement("span");
    mark.textContent = sign;
    mark.style.color = colour;
    item.append(mark, ` ${words}`);
    return item;
  };
  if (showsSpurious && map.columns)
    items.push(symbol("first lift-off below the threshold", "○", tones.data));
  if (view.showsPaper()) items.push(symbol("the paper's hoop", "★", tones.mark));
  items.push(symbol("selected", "⊕", tones.ink), symbol("shown on the right", "⊕", tones.mark));
  if (!field.gait) for (const kind of new Set(map.live ? ["outcome"] : map.curves.map((curve) => curve.kind)))
    items.push(symbol(map.cliff_words[kind], kind in DASHES ? "╌" : "—", tones.ink));
  element("legend").replaceChildren(...items);
}
