// A canvas that writes down what is drawn on it as SVG: of all that contexts can do, what this page's
// pictures use.

/** Looks like `canvas` to whoever draws; text(): the picture. */
export function svgCanvas(canvas) {
  const parts = [], stack = [], box = canvas.getBoundingClientRect(),
    measure = document.createElement("canvas").getContext("2d");
  const escaped = (text) => String(text).replaceAll("&", "&amp;").replaceAll("<", "&lt;")
    .replaceAll('"', "&quot;");
  const number = (v) => Number(v.toFixed(2));
  let path = "", clips = 0, open = 0;  // groups that are open, of clips and turns
  const style = { fillStyle: "#000000", strokeStyle: "#000000", lineWidth: 1, font: "10px sans-serif",
    textAlign: "left", textBaseline: "alphabetic", globalAlpha: 1, lineJoin: "miter",
    imageSmoothingEnabled: true };
  let dashes = [];
  const dashed = () => (dashes.length ? ` stroke-dasharray="${dashes.map(number).join(" ")}"` : "");
  const stroke = () =>
    `fill="none" stroke="${escaped(context.strokeStyle)}" stroke-width="${number(context.lineWidth)}"` +
    `${dashed()} stroke-opacity="${context.globalAlpha}"`;
  const fill = () => `fill="${escaped(context.fillStyle)}" fill-opacity="${context.globalAlpha}"`;
  const group = (attribute) => { parts.push(`<g ${attribute}>`); ++open; };
  const picture = (source, x, y, w, h) =>
    parts.push(`<image x="${number(x)}" y="${number(y)}" width="${number(w)}" height="${number(h)}" ` +
    `preserveAspectRatio="none" image-rendering="pixelated" href="${source.toDataURL("image/png")}"/>`);
  const context = {
    ...style, canvas: null,
    save() { stack.push({ dashes, open,
      ...Object.fromEntries(Object.keys(style).map((key) => [key, context[key]])) }); },
    restore() {
      const before = stack.pop();
      for (; open > before.open; --open) parts.push("</g>");
      dashes = before.dashes;
      for (const key of Object.keys(style)) context[key] = before[key];
    },
    translate(x, y) { group(`transform="translate(${number(x)} ${number(y)})"`); },
    rotate(angle) { group(`transform="rotate(${number(angle * 180 / Math.PI)})"`); },
    setLineDash(lengths) { dashes = lengths; },
    beginPath() { path = ""; },
    closePath() { path += "Z"; },
    moveTo(x, y) { path += `M${number(x)} ${number(y)}`; },
    lineTo(x, y) { path += `${path === "" ? "M" : "L"}${number(x)} ${number(y)}`; },
    rect(x, y, w, h) { path += `M${number(x)} ${number(y)}h${number(w)}v${number(h)}h${number(-w)}Z`; },
    arc(x, y, r) { path +=
      `M${number(x - r)} ${number(y)}a${number(r)} ${number(r)} 0 1 0 ${number(2 * r)} 0a${number(r)} ` +
      `${number(r)} 0 1 0 ${number(-2 * r)} 0`; },
    clip() { ++clips; parts.push(`<clipPath id="clip${clips}"><path d="${path}"/></clipPath>`);
      group(`clip-path="url(#clip${clips})"`); },
    stroke() { if (path) parts.push(`<path d="${path}" ${stroke()}/>`); },
    fill() { if (path) parts.push(`<path d="${path}" ${fill()}/>`); },
    strokeRect(x, y, w, h) {
      parts.push(`<rect x="${number(x)}" y="${number(y)}" width="${number(w)}" height="${number(h)}" ` +
      `${stroke()}/>`); },
    fillRect(x, y, w, h) {
      parts.push(`<rect x="${number(x)}" y="${number(y)}" width="${number(w)}" height="${number(h)}" ` +
      `${fill()}/>`); },
    clearRect() {},
    measureText(text) { measure.font = context.font; return measure.measureText(text); },
    fillText(text, x, y) {
      const [size] = context.font.match(/[\d.]+px/),
        anchor = { left: "start", center: "middle", right: "end" }[context.textAlign],
        base = { top: 0.8, middle: 0.35 }[context.textBaseline] ?? 0;
      parts.push(`<text x="${number(x)}" y="${number(y + base * parseFloat(size))}" font-size="${size}" ` +
        `text-anchor="${anchor}" ${fill()}>${escaped(text)}</text>`);
    },
    createImageData: (w, h) => new ImageData(w, h),
    putImageData(image, x, y) {
      const cells = document.createElement("canvas");
      [cells.width, cells.height] = [image.width, image.height];
      cells.getContext("2d").putImageData(image, 0, 0);
      picture(cells, x, y, image.width, image.height);
    },
    drawImage(source, x, y, w = source.width, h = source.height) { picture(source, x, y, w, h); },
  };
  const like = {
    width: canvas.width, height: canvas.height, dataset: {}, getBoundingClientRect: () => box,
    getContext: () => context,
    // Read as HTML and written as XML, it gets its namespace.
    text() {
      const svg = `<svg viewBox="0 0 ${like.width} ${like.height}" font-family="system-ui, 'DejaVu Sans', ` +
        `sans-serif">${parts.join("\n")}${"</g>".repeat(open)}</svg>`;
      return new XMLSerializer().serializeToString(new DOMParser()
        .parseFromString(svg, "text/html").querySelector("svg"));
    },
  };
  context.canvas = like;
  return like;
}
