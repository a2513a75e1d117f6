// What is shown, saved: a canvas as PNG or SVG, the animation as WebM.

import { element } from "../dom.js";
import { svgCanvas } from "./svg.js";

/** Offers bytes as a file. */
export function saveAs(blob, name) {
  const link = document.createElement("a");
  Object.assign(document.body.dataset, { saved: name, bytes: blob.size });
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** Saves a canvas as PNG at the screen's own resolution. */
function savePicture(canvas, name) {
  canvas.toBlob((blob) => { if (blob) saveAs(blob, name); }, "image/png");
}

/** Saves what draw(canvas) draws as SVG, as large as the canvas is. */
function saveSvg(canvas, name, draw) {
  const like = svgCanvas(canvas);
  draw(like);
  saveAs(new Blob([like.text()], { type: "image/svg+xml" }), name);
}

/** The two buttons that save a picture: as it stands, and as draw(canvas) draws it anew; name(): of the file.
    */
export function saveButtons(id, canvas, name, draw) {
  element(`${id}-png`).addEventListener("click", () => savePicture(canvas, `${name()}.png`));
  element(`${id}-svg`).addEventListener("click", () => saveSvg(canvas, `${name()}.svg`, draw));
}

/** Records a canvas while play() runs, until the promise that it returns is kept. Returns the film, or null
    where the browser has no recorder. */
export async function recorded(canvas, play) {
  const type = ["video/webm;codecs=vp8", "video/webm;codecs=vp9", "video/webm"].find((each) =>
    window.MediaRecorder?.isTypeSupported(each));
  if (!type || !canvas.captureStream) return null;
  const recorder = new MediaRecorder(canvas.captureStream(60), { mimeType: type, videoBitsPerSecond: 8e6 }),
    parts = [];
  recorder.ondataavailable = ({ data }) => { if (data.size > 0) parts.push(data); };
  const stopped = new Promise((keep) => { recorder.onstop = keep; });
  recorder.start();
  await play();
  recorder.stop();
  await stopped;
  return new Blob(parts, { type: "video/webm" });
}
