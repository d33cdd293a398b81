// Fetches the program and the weights with a bar that tells how much is there, and starts the program.
import start from "./apertura-page.js";

const message = document.getElementById("message");
const bar = document.getElementById("loaded");
const PROGRAM = "apertura-page_bg.wasm";
// A service worker that is not there after so long never is.
const WORKER_MILLISECONDS = 3000;
// Those for the radar of table 3.1, for others of its shape, and for the cascade of 12 x 16 pairs.
const WEIGHTS = ["live.safetensors", "live-any.safetensors", "live-cascade.safetensors"];

let loaded = 0;

// The bytes of a file as they come; the bar shows the part of `total` bytes that is there.
async function watched(name, type, total) {
  const response = await fetch(name);
  if (!response.ok) {
    throw new Error(`The program could not be loaded: ${name} gave ${response.status}.`);
  }
  const count = new TransformStream({
    transform(part, to) {
      loaded += part.byteLength;
      bar.value = Math.min(1, loaded / total);
      to.enqueue(part);
    },
  });
  return new Response(response.body.pipeThrough(count), { headers: { "Content-Type": type } });
}

// The browser lends threads to a page that is isolated from other origins. Where the host doesn't send the headers for it, a service
// worker adds them, and the page is loaded once more. Whether it is.
async function isolates() {
  if (crossOriginIsolated || !isSecureContext || !("serviceWorker" in navigator)) return false;
  try {
    if (sessionStorage.getItem("isolated")) return false;
    sessionStorage.setItem("isolated", "tried");
    await navigator.serviceWorker.register("isolate.js");
    const ready = navigator.serviceWorker.ready.then(() => true);
    const late = new Promise((resolve) => setTimeout(resolve, WORKER_MILLISECONDS, false));
    if (!(await Promise.race([ready, late]))) return false;
  } catch {
    return false;
  }
  location.reload();
  return true;
}

// Keys that the program uses and that the browser gives away.
function keepKeys() {
  const alone = ["F1", "F3", "F6", "F7", "F10"];
  const withControl = [..."123adekyz+-=0"];
  addEventListener("keydown", (event) => {
    const control = event.ctrlKey || event.metaKey;
    if (control ? withControl.includes(event.key.toLowerCase()) && !event.altKey : alone.includes(event.key)) {
      event.preventDefault();
    }
  }, { capture: true });
}

async function open() {
  if (!document.createElement("canvas").getContext("webgl2")) {
    throw new Error("This browser shows no WebGL 2, which the window is drawn with. Switch on hardware acceleration, or use another browser.");
  }
  if (await isolates()) return;
  keepKeys();
  // A link to this page that is opened in this tab.
  addEventListener("hashchange", () => location.reload());
  // The lengths that are announced are those of the compressed files: the page carries the others.
  const sizes = await (await fetch("sizes.json")).json();
  const total = [PROGRAM, ...WEIGHTS].reduce((sum, name) => sum + sizes[name], 0);
  const bytes = async (name) => new Uint8Array(await (await watched(name, "application/octet-stream", total)).arrayBuffer());
  const weights = Promise.all(WEIGHTS.map(bytes));
  // Awaited below; without this line a failure before that would be told on the console too.
  weights.catch(() => {});
  const program = await watched(PROGRAM, "application/wasm", total);
  globalThis.aperturaWeights = await weights;
  const { memory } = await start({ module_or_path: program });
  // Whoever asks how much memory the program has (the tests do) finds it here.
  globalThis.aperturaMemory = memory;
  delete globalThis.aperturaWeights;
}

open().catch((error) => {
  message.textContent = error.message ?? String(error);
  bar.hidden = true;
});
