// The page computes what the native program computes: the arrays that both export agree.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { exported, launch, open, shared } from "./browser.mjs";
import { readNpz } from "./npz.mjs";

const PROGRAM = process.env.APERTURA;
const SCENES = process.env.SCENES;
const folder = mkdtempSync(join(tmpdir(), "apertura-page-"));

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

function native(scene, floor, method) {
  const to = join(folder, "native.npz");
  const options = ["--floor", floor, "--method", method, "-o", to];
  execFileSync(PROGRAM, ["maps", join(SCENES, `${scene}.toml`), ...options], { env: { ...process.env, APERTURA_SIMD: "portable" } });
  return readNpz(readFileSync(to));
}

async function ofThePage(scene, floor, method) {
  const text = shared(readFileSync(join(SCENES, `${scene}.toml`), "utf8"), { floor, method });
  const { context, page, told } = await open(browser, `#${text}`);
  const arrays = readNpz(readFileSync(await exported(page, "Export maps")));
  assert.deepEqual(told, []);
  await context.close();
  return arrays;
}

const largest = (values) => values.reduce((a, b) => Math.max(a, b), -Infinity);
const smallest = (values) => values.reduce((a, b) => Math.min(a, b), Infinity);

// The largest difference of two arrays, relative to the largest magnitude of the second.
function difference(ours, theirs) {
  assert.equal(ours.length, theirs.length);
  const peak = largest(theirs.map(Math.abs));
  return largest(ours.map((v, i) => Math.abs(v - theirs[i]))) / peak;
}

// Squared error and share of the target's cells that are found.
function figures({ polar_full: decades, output }) {
  const [low, high] = [smallest(decades), largest(decades)];
  let [error, found, there] = [0, 0, 0];
  output.forEach((value, i) => {
    const target = (decades[i] - low) / (high - low);
    error += (value - target) ** 2;
    there += target > 0.9;
    found += target > 0.9 && value > 0.8;
  });
  return { error, detection: found / there };
}

// Every scene, floor and method, but in a quarter of their combinations unless all are asked for.
const ALL = process.env.ALL === "1";

for (const [i, scene] of ["four-reflectors", "street", "test-set-1"].entries()) {
  for (const [j, floor] of ["thesis", "exact"].entries()) {
    for (const [k, method] of ["live", "nomp", "hybrid", "iaa"].entries()) {
      if (!ALL && (i + 2 * j + k) % 4 !== 0) continue;
      test(`${scene} over the floor ${floor} by ${method} is the native program's`, async () => {
        const [ours, theirs] = [await ofThePage(scene, floor, method), native(scene, floor, method)];
        assert.ok(theirs.output && ours.output, "both have an output");
        for (const end of ["sub0", "sub1"]) assert.ok(difference(ours[end], theirs[end]) < 1e-12, end);
        const amplitudes = (archive) => archive.polar_full.map((decades) => 10 ** decades);
        const apart = difference(amplitudes(ours), amplitudes(theirs));
        assert.ok(apart < 1e-12, `amplitudes differ by ${apart} of the peak`);
        const [here, there] = [figures(ours), figures(theirs)];
        const told = `${JSON.stringify(here)} in the page, ${JSON.stringify(there)} natively`;
        assert.ok(Math.abs(here.error / there.error - 1) < 1e-3, told);
        assert.ok(Math.abs(here.detection - there.detection) < 1e-3, told);
      });
    }
  }
}
