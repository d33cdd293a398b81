// Reads NumPy archives: a zip of .npy files, stored or deflated.
import { inflateRawSync } from "node:zlib";

const END_OF_DIRECTORY = 0x06054b50;

function entries(bytes) {
  let end = bytes.length - 22;
  while (bytes.readUInt32LE(end) !== END_OF_DIRECTORY) end -= 1;
  let at = bytes.readUInt32LE(end + 16);
  return Array.from({ length: bytes.readUInt16LE(end + 10) }, () => {
    const [packed, name, extra, comment] = [at + 20, at + 28, at + 30, at + 32].map((p, i) => (i === 0 ? bytes.readUInt32LE(p) : bytes.readUInt16LE(p)));
    const local = bytes.readUInt32LE(at + 42);
    const method = bytes.readUInt16LE(at + 10);
    const start = local + 30 + bytes.readUInt16LE(local + 26) + bytes.readUInt16LE(local + 28);
    const body = bytes.subarray(start, start + packed);
    const entry = { name: bytes.toString("utf8", at + 46, at + 46 + name), data: method === 8 ? inflateRawSync(body) : body };
    at += 46 + name + extra + comment;
    return entry;
  });
}

// The numbers of an array of f64, f32 or complex128 (real and imaginary parts in turn); others are left out.
function numbers(npy) {
  const header = npy.toString("latin1", 10, 10 + npy.readUInt16LE(8));
  const kind = /'descr': '<(\w\d+)'/.exec(header)?.[1];
  const data = npy.subarray(10 + npy.readUInt16LE(8));
  const own = data.buffer.slice(data.byteOffset, data.byteOffset + data.byteLength);
  if (kind === "f8" || kind === "c16") return new Float64Array(own);
  if (kind === "f4") return new Float32Array(own);
  return null;
}

export function readNpz(bytes) {
  const named = entries(bytes).map(({ name, data }) => [name.replace(/\.npy$/, ""), numbers(data)]);
  return Object.fromEntries(named.filter(([, array]) => array));
}
