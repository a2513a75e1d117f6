// SPDX-License-Identifier: GPL-3.0-or-later
// Modules of the page that need no browser, bundled by esbuild and run by node's own test runner.
import assert from "node:assert/strict";
import test from "node:test";

import { isolines, planeOf } from "../../analysis/page/map/isolines.js";
import {
  axisScale, colourScale, linearTicks, logTicks, tickTexts, valueOnScale,
} from "../../analysis/page/map/scales.js";
import { quantity, unpacked } from "../../analysis/page/solver/decode.js";
import { reachesAll } from "../../analysis/page/solver/made.js";
import { designOf, wordsOf } from "../../analysis/page/state/address.js";
import { short, shownIn, units, withUnit } from "../../analysis/page/state/units.js";

test("ticks are round, ascending and within the ends", () => {
  for (const [low, high] of [[0, 1], [-3, 7], [0.1234, 0.1239], [1e-9, 3e-9], [-1e12, 5e12]]) {
    const ticks = linearTicks(low, high), span = high - low;
    assert.ok(ticks.length >= 3 && ticks.length <= 10, `${low}..${high}: ${ticks}`);
    ticks.forEach((tick, i) => {
      assert.ok(tick >= low - 1e-9 * span && tick <= high + 1e-9 * span);
      assert.ok(i === 0 || tick > ticks[i - 1]);
    });
  }
  assert.deepEqual(linearTicks(0, 1), [0, 0.2, 0.4, 0.6, 0.8, 1]);
});

test("where no double is round between the ends, the ends are the ticks", () => {
  assert.deepEqual(linearTicks(1, 1 + 2 ** -52), [1, 1 + 2 ** -52]);
  assert.deepEqual(linearTicks(5, 5), [5]);
  assert.deepEqual(linearTicks(-1.7e308, 1.7e308).length > 1, true);
});

// From neighbouring doubles to 1e300: the count of ticks once had no end.
test("ticks of any two numbers are few, ascend and differ in their texts", () => {
  const seeded = ((seed) => () => (seed = (seed * 16807) % 2147483647) / 2147483647)(45);
  const number = () => (seeded() < 0.5 ? -1 : 1) * 10 ** (seeded() * 600 - 300);
  for (let i = 0; i < 20000; ++i) {
    let low = number(), high = seeded() < 0.5 ? low * (1 + 2.3e-16 * (1 + 5 * seeded())) : number();
    if (low > high) [low, high] = [high, low];
    const ticks = linearTicks(low, high), texts = tickTexts(ticks);
    assert.ok(ticks.length > 0 && ticks.length <= 12, `${low} ${high}`);
    assert.equal(new Set(texts).size, texts.length, `${low} ${high}`);
    ticks.forEach((v, k) => assert.ok(Number.isFinite(v) && (k === 0 || v > ticks[k - 1]), `${low} ${high}`));
    if (low > 0) assert.ok(logTicks(low, high).length <= 60, `${low} ${high}`);
  }
  assert.deepEqual(tickTexts(logTicks(1, 1e7)),
    ["1", "10", "100", "1000", "10000", "10⁵", "10⁶", "10⁷"]);
});

test("logarithmic ticks are 1, 2 and 5 times powers of ten", () =>
  assert.deepEqual(logTicks(0.1, 10), [0.1, 0.2, 0.5, 1, 2, 5, 10]));

test("texts of ticks differ as their values do", () => {
  assert.deepEqual(tickTexts([0.1, 0.2]), ["0.1", "0.2"]);
  assert.deepEqual(tickTexts([1e-7, 2e-7]), ["10⁻⁷", "2·10⁻⁷"]);
  assert.equal(new Set(tickTexts([1, 1 + 1e-12])).size, 2);
});

test("the value at a place of a colour scale is the one that lies there", () => {
  for (const field of [{ log: true, exponent: 1, low: 1e-3, high: 50 },
      { log: false, exponent: 1, low: -2, high: 7 }, { log: false, exponent: 0.5, low: 0, high: 3 }]) {
    const place = colourScale(field, field.low, field.high);
    for (let k = 0; k <= 10; ++k)
      assert.ok(Math.abs(place(valueOnScale(field, k / 10)) - k / 10) < 1e-12);  // roundings of exp and log
  }
});

test("a cell is found at every pixel of an axis of uneven values", () => {
  const axis = { values: [1, 2, 4, 8, 16], unit: "", log: true }, scale = axisScale(axis, 100, 600);
  axis.values.forEach((value, i) => {
    assert.equal(scale.index(scale.centre(i)), i);
    assert.ok(Math.abs(scale.value(scale.pixel(value)) - value) < 1e-12 * value);
  });
  assert.equal(scale.index(99), -1);
  assert.equal(scale.index(601), -1);
});

test("isolines of a cone are circles, closed, and none crosses a hole of it", () => {
  const n = 41, radius = (i, j) => Math.hypot(i - 20, j - 20), centre = (i) => i;
  const of = (value) => isolines(planeOf(value, n, n), 12.3, centre, centre, () => false);
  const chains = of(radius);
  assert.equal(chains.length, 1);
  const [chain] = chains;
  assert.deepEqual(chain.slice(0, 2), chain.slice(-2));
  // Linear between cells of a cone: off the circle by no more than the sag of a chord, 1 / (8 r).
  for (let k = 0; k < chain.length; k += 2)
    assert.ok(Math.abs(Math.hypot(chain[k] - 20, chain[k + 1] - 20) - 12.3) < 1 / (8 * 12.3));
  for (const line of of((i, j) => (i > 30 ? NaN : radius(i, j))))
    for (let k = 0; k < line.length; k += 2) assert.ok(line[k] <= 30);
});

test("what the explorer packs is unpacked", async () => {
  const deflated = new Response(new Blob([Uint8Array.of(1, 3, 2, 0, 0, 0)]).stream()
    .pipeThrough(new CompressionStream("deflate")));
  const data = Buffer.from(await deflated.arrayBuffer()).toString("base64");
  assert.deepEqual([...await unpacked(data)], [1, 3, 2, 0, 0, 0]);
  // counts 1, 4, 6 in steps of a half from the first, -1, on
  const values = await quantity({ data, step: 0.5, first: -2 }, [3], [0]);
  assert.deepEqual([...values], [-1, 0.5, 1.5]);
});

test("goals are reached on their bounds and by no number", () => {
  const goals = [{ field: "jump_height", least: 0.5, most: null },
    { field: "jump_time", least: null, most: 2 }];
  assert.ok(reachesAll({ jump_height: 0.5, jump_time: 2 }, goals, {}));
  assert.ok(!reachesAll({ jump_height: 0.4999, jump_time: 2 }, goals, {}));
  assert.ok(!reachesAll({ jump_height: NaN, jump_time: 1 }, goals, {}));
});

test("a design's words in an address are read back bit by bit", () => {
  const design = { slope: 0.1 + 0.2, mass_ratio: 1 / 3, mu_kinetic: NaN },
    ranges = { slope: [0, 1], mass_ratio: [0, 100], mu_kinetic: [0, 10] };
  assert.deepEqual(designOf(wordsOf(design, Object.keys(design)), ranges), design);
  assert.ok(!designOf("slope:2", ranges));
});

test("lengths are shown in millimetres of the hoop's own size, or as pure numbers", () => {
  const scene = { radius: 0.06, gravity: 9.81, mass: 0.158 };
  assert.deepEqual(shownIn("diameters", scene), [120, "mm"]);
  units.pure = true;
  assert.deepEqual(shownIn("diameters", scene), [1, "diameters"]);
  units.pure = false;
  assert.equal(withUnit(short(12.34567), "mm"), "12.35 mm");
  assert.equal(short(NaN), "none");
});
