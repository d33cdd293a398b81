// A thread of the program: the same program over the same memory.
import start, { enterThread } from "./apertura-page.js";

self.onmessage = async ({ data }) => {
  self.onmessage = null;
  const program = await start({ module_or_path: data.program, memory: data.memory });
  enterThread(data.work);
  program.__wbindgen_thread_destroy?.();
  self.postMessage({ ask: "end" });
};
