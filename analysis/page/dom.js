// What every part of the page has to do with its elements.

/** The element of the page with that name; its kind is known to who asks.
    @type {(id: string) => any} */
export const element = (id) => document.getElementById(id);

export function notice(text) {
  const message = element("message");
  message.hidden = text === "";
  message.textContent = text;
}
export const complain = (error) => notice(`This page cannot be shown: ${error.message ?? error}`);

export function option(select, value, text) {
  const made = document.createElement("option");
  made.value = value;
  made.textContent = text;
  select.append(made);
}

/** Lets arrow keys change a number by a round hundredth or so of its span(), where any number may be typed.
    */
export function stepsOf(input, span) {
  input.addEventListener("keydown", (event) => {
    const way = { ArrowUp: 1, ArrowDown: -1 }[event.key];
    if (!way || input.value === "") return;
    event.preventDefault();
    const step = 10 ** Math.floor(Math.log10(span() / 50));
    input.value = Number((Number(input.value) + way * step * (event.shiftKey ? 10 : 1)).toPrecision(12));
    for (const kind of ["input", "change"]) input.dispatchEvent(new Event(kind));
  });
}
