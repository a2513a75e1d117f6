// The address keeps what one sees: each part of the page writes its own words into it and reads them back, so
// that a link is a finding, and the browser's history undoes.

const ADDRESS_PAUSE = 500;  // ms between two changes that are undone one by one
const ADDRESS_REST = 120;   // ms at least between two writings, of which browsers allow so many
// others: a file's map and a live one have addresses
const address = { parts: [], steps: 0, at: 0, last: -Infinity, later: 0, reading: false, others: false,
  live: false };

const addressWords = () => new URLSearchParams(location.hash.slice(1));

/** A part of the page with write(words) and read(words). */
function addressPart(part) { address.parts.push(part); }

/** Something else is seen: the address says so. What follows at once is undone with it. */
function noteAddress() {
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
function readAddress(first = false) {
  address.reading = true;
  try {
    for (const part of address.parts) part.read(addressWords(), first);
  } finally {
    address.reading = false;
  }
}

function showSteps() {
  element("undo").disabled = address.at === 0;
  element("redo").disabled = address.at + 1 >= address.steps;
}

/** Undo and redo: buttons, keys and the browser's own. */
function addressButtons() {
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
    if (!isUndo || event.target.matches("input[type=number], input[type=text]")) return;
    if (event.shiftKey ? !element("redo").disabled : !element("undo").disabled) { event.preventDefault();
        event.shiftKey ? history.forward() : history.back(); }
  });
  showSteps();
}
