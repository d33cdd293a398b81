// What the page asks of the browser.

const LOCK = "lock:";
const BEAT_MILLISECONDS = 1000;
// A lock whose page has not been heard of for so long is free.
const SILENT_MILLISECONDS = 5000;

const beats = new Map();

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

export function download(name, bytes) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([bytes]));
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

export function store(key, text) {
  try {
    localStorage.setItem(key, text);
    return true;
  } catch {
    return false;
  }
}

export function forget(key) {
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

export function tell(sentence) {
  const place = document.getElementById("message");
  if (place) {
    place.textContent = sentence;
    place.parentElement.hidden = sentence === "";
  }
}
