// Fetches the program with a bar that tells how much is there, and starts it.
import start from "./apertura-page.js";

const message = document.getElementById("message");
const bar = document.getElementById("loaded");
const PROGRAM = "apertura-page_bg.wasm";

// The program's bytes as they come; the bar shows the part of `total` bytes that is there.
function watched(response, total) {
  let loaded = 0;
  const count = new TransformStream({
    transform(part, to) {
      loaded += part.byteLength;
      bar.value = total > 0 ? Math.min(1, loaded / total) : 0;
      to.enqueue(part);
    },
  });
  return new Response(response.body.pipeThrough(count), { headers: { "Content-Type": "application/wasm" } });
}

async function open() {
  if (!document.createElement("canvas").getContext("webgl2")) {
    throw new Error("This browser shows no WebGL 2, which the window is drawn with. Switch on hardware acceleration, or use another browser.");
  }
  const response = await fetch(PROGRAM);
  if (!response.ok) {
    throw new Error(`The program could not be loaded: ${PROGRAM} gave ${response.status}.`);
  }
  // The length that is announced is that of the compressed file: the page carries the other.
  const sizes = await (await fetch("sizes.json")).json();
  await start({ module_or_path: watched(response, sizes[PROGRAM]) });
}

open().catch((error) => {
  // The window itself goes on by such an exception.
  if (String(error).includes("Using exceptions for control flow")) return;
  message.textContent = error.message ?? String(error);
  bar.hidden = true;
});
