// What the page asks of the browser.

const LOCK = "lock:";
const BEAT_MILLISECONDS = 1000;
// A lock whose page has not been heard of for so long is free.
const SILENT_MILLISECONDS = 5000;

const beats = new Map();

// The files in which the window keeps a scene that is not saved.
const KEPT_SCENE = /^\/storage\/autosave(-\d+)?\.toml$/;

// The cell of a notebook that this page was made for: its server is told every scene that is not saved, one after
// the other, and nothing ("") where the scene is as it was opened.
let told = Promise.resolve();
function tellCell(scene) {
  const cell = new URLSearchParams(location.search).get("cell");
  if (!cell) return;
  const send = () => fetch(`cell/${encodeURIComponent(cell)}`, { method: "POST", body: scene });
  // The notebook may have ended; the window goes on.
  told = told.then(send).catch(() => {});
}

// The name of this tab. A reload keeps it, so that the page gets its own lock back.
function tab() {
  let name = sessionStorage.getItem("tab");
  if (!name) {
    name = crypto.randomUUID();
    sessionStorage.setItem("tab", name);
  }
  return name;
}

export function soon() {
  return new Promise((resolve) => setTimeout(resolve, 20));
}

// Whether this is the thread that draws.
export function isFirst() {
  return typeof document !== "undefined";
}

export function isIsolated() {
  return globalThis.crossOriginIsolated === true;
}

export function cores() {
  return navigator.hardwareConcurrency || 2;
}

let wake = () => {};
let problem = () => {};

export function listen(onWake, onProblem) {
  wake = onWake;
  problem = onProblem;
}

export function startThread(name, program, memory, work) {
  const thread = new Worker("worker.js", { type: "module", name });
  thread.onmessage = ({ data }) => {
    switch (data.ask) {
      case "wake": return wake();
      case "thread": return startThread(data.name, program, memory, data.work);
      case "problem": return problem(data.text);
      case "download": return download(data.name, data.bytes);
      case "forget": return forget(data.key);
      case "store":
        if (!store(data.key, data.text)) {
          problem("The browser's storage is full or forbidden: what was computed is lost when the page is closed.");
        }
        return undefined;
      case "end": return thread.terminate();
    }
  };
  // It has told why before it ended.
  thread.onerror = (event) => {
    event.preventDefault();
    thread.terminate();
  };
  thread.postMessage({ program, memory, work });
}

export function askForThread(name, work) {
  postMessage({ ask: "thread", name, work });
}

export function wakeFirst() {
  postMessage({ ask: "wake" });
}

export function tellFirst(text) {
  postMessage({ ask: "problem", text });
}

export function download(name, bytes) {
  // A copy: what lies in memory that threads share can't be handed to the browser.
  const own = bytes.slice();
  if (!isFirst()) {
    postMessage({ ask: "download", name, bytes: own }, [own.buffer]);
    return;
  }
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([own]));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

export function storedKeys() {
  try {
    return Object.keys(localStorage).filter((key) => key.startsWith("/storage/"));
  } catch {
    return [];
  }
}

export function stored(key) {
  return localStorage.getItem(key) ?? undefined;
}

// Whether the browser had room for it; from another thread than the first, which has no storage, that is told later.
export function store(key, text) {
  if (!isFirst()) {
    postMessage({ ask: "store", key, text });
    return true;
  }
  if (KEPT_SCENE.test(key)) tellCell(text);
  try {
    localStorage.setItem(key, text);
    return true;
  } catch {
    return false;
  }
}

export function forget(key) {
  if (!isFirst()) {
    postMessage({ ask: "forget", key });
    return;
  }
  if (KEPT_SCENE.test(key)) tellCell("");
  try {
    localStorage.removeItem(key);
  } catch {
    // Nothing was kept.
  }
}

export function claimLock(key) {
  try {
    const name = LOCK + key;
    const held = JSON.parse(localStorage.getItem(name) ?? "null");
    if (held && held.tab !== tab() && Date.now() - held.beat < SILENT_MILLISECONDS) {
      return false;
    }
    const beat = () => localStorage.setItem(name, JSON.stringify({ tab: tab(), beat: Date.now() }));
    beat();
    beats.set(key, setInterval(beat, BEAT_MILLISECONDS));
    return true;
  } catch {
    return true;
  }
}

export function releaseLock(key) {
  clearInterval(beats.get(key));
  beats.delete(key);
  forget(LOCK + key);
}

export function address() {
  return location.search + location.hash;
}

export function pageAddress() {
  return location.origin + location.pathname;
}

export function fetchedWeights(index) {
  return globalThis.aperturaWeights?.[index] ?? new Uint8Array();
}

export function tell(sentence) {
  const place = document.getElementById("message");
  if (place) {
    place.textContent = sentence;
    place.parentElement.hidden = sentence === "";
  }
}
