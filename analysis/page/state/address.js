// The address keeps what one sees: each part of the page writes its own words into it and reads them back, so
// that a link is a finding, and the browser's history undoes.

import { element } from "../dom.js";

const ADDRESS_PAUSE = 500;  // ms between two changes that are undone one by one
const ADDRESS_REST = 120;   // ms at least between two writings, of which browsers allow so many
// others: a file's map and a live one have addresses
export const address = { parts: [], steps: 0, at: 0, last: -Infinity, later: 0, reading: false, others: false,
  live: false };

/** Whether the address is being read: what is drawn then is drawn once, at the end. */
export const isReadingAddress = () => address.reading;
export const addressWords = () => new URLSearchParams(location.hash.slice(1));

/** A part of the page with write(words) and read(words) and, if it wants, done() once all have read. */
export function addressPart(part) { address.parts.push(part); }

/** Something else is seen: the address says so. What follows at once is undone with it. */
export function noteAddress() {
  if (address.reading) return;
  clearTimeout(address.later);
  const passed = performance.now() - address.last;
  if (passed < ADDRESS_REST) { address.later = setTimeout(noteAddress, ADDRESS_REST - passed); return; }
  const words = new URLSearchParams();
  for (const part of address.parts) part.write(words);
  const hash = [...words].map(([key, value]) =>
    (value === "" ? key
    : `${key}=${encodeURIComponent(value).replaceAll("%3A", ":").replaceAll("%2C", ",")}`)).join("&");
  if (`#${hash}` === location.hash) { address.steps = Math.max(address.at + 1, address.steps); return; }
  address.last = performance.now();
  if (address.steps > 0 && passed > ADDRESS_PAUSE) {
    ++address.at;
    history.pushState({ step: address.at }, "", `#${hash}`);
  } else {
    history.replaceState({ step: address.at }, "", `#${hash}`);
  }
  address.steps = Math.max(address.at + 1, 1);
  showSteps();
}

/** first: the page has only just begun, and with this address. */
export function readAddress(first = false) {
  address.reading = true;
  try {
    for (const part of address.parts) part.read(addressWords(), first);
  } finally {
    address.reading = false;
  }
  for (const part of address.parts) part.done?.();
}

function showSteps() {
  element("undo").disabled = address.at === 0;
  element("redo").disabled = address.at + 1 >= address.steps;
}

/** Undo and redo: buttons, keys and the browser's own. */
export function addressButtons() {
  address.at = history.state?.step ?? 0;
  window.addEventListener("popstate", (event) => {
    // the other of the two pages
    if (address.others && addressWords().has("live") !== address.live) { location.reload(); return; }
    address.at = event.state?.step ?? 0;
    showSteps();
    readAddress();
  });
  element("undo").addEventListener("click", () => history.back());
  element("redo").addEventListener("click", () => history.forward());
  document.addEventListener("keydown", (event) => {
    const isUndo = (event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z";
    const { target } = event;
    if (!isUndo || (target instanceof HTMLInputElement && /number|text/.test(target.type))) return;
    if (event.shiftKey ? !element("redo").disabled : !element("undo").disabled) { event.preventDefault();
        event.shiftKey ? history.forward() : history.back(); }
  });
  showSteps();
}

/** Numbers of a design as an address has them, name:value,name:value; kinetic friction that follows the
    static has none. */
export const wordsOf = (design, names) =>
  names.filter((name) => name === "mu_kinetic" || Number.isFinite(design[name]))
  .map((name) => `${name}:${Number.isFinite(design[name]) ? design[name] : "static"}`).join(",");

/** And back; null if any of it is none. */
export function designOf(text, ranges) {
  if (text === null) return null;
  const pairs = text === "" ? [] : text.split(",").map((word) => word.split(":")),
    follows = ([name, value]) => name === "mu_kinetic" && value === "static";
  const good = ([name, value]) => name in ranges && value !== "" && Number(value) >= ranges[name][0]
    && Number(value) <= ranges[name][1];
  return pairs.every((pair) => follows(pair) || good(pair))
    ? Object.fromEntries(pairs.map((pair) => [pair[0], follows(pair) ? NaN : Number(pair[1])])) : null;
}
