// The page begins here.

import { address, addressWords } from "./state/address.js";
import { complain, element } from "./dom.js";
import { liveFrom } from "./links.js";
import { madeTeller } from "./solver/made.js";
import { sheetPart, start, startLive } from "./page.js";
import { readMap } from "./map/read_map.js";
import { loadModule, solverOf } from "./solver/solver.js";
import { tourPart } from "./tour.js";
import { tonesPart } from "./state/tones.js";

(async () => {
  try {
    if (typeof DecompressionStream === "undefined" || typeof WebAssembly === "undefined")
      throw new Error("this page needs Chrome 97, Firefox 113, Safari 16.4 or newer");
    const module = await loadModule(element("module").textContent), solver = await solverOf(module),
      data = JSON.parse(element("data").textContent);
    const live = data.only_live || addressWords().has("live");
    Object.assign(address, { live: Boolean(live), others: !data.only_live });
    tonesPart();
    sheetPart();
    tourPart();
    const toggle = element("live-toggle");
    toggle.hidden = Boolean(data.only_live);
    toggle.textContent = live ? "back to the map in the file"
      : "compute the map here: every parameter a slider";
    toggle.addEventListener("click",
      () => { location.hash = live ? "" : liveFrom(data); location.reload(); });
    if (live) await startLive(data.for_live, module, solver);
    else await start(await readMap(), solver, madeTeller(module, element("worker").textContent));
  } catch (error) { complain(error); }
})();
