// Run times on one thread, for `scripts/measure-page`: the page's against the native program's.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { test } from "node:test";
import { launch, MAX_WAIT_MILLISECONDS, address } from "./browser.mjs";

const MOST = 1.4;

const MOST_UNTIL_MAPS_MILLISECONDS = 3000;

// Where the target's map is in a window of 1440 x 900. Its picture compresses to many more bytes than the empty plot does.
const TARGET = { x: 560, y: 340, width: 340, height: 200 };
const BYTES_OF_A_MAP = 20000;

test("the first maps are there soon after the page is opened", { skip: !process.env.MEASURE }, async () => {
  const browser = await launch();
  const context = await browser.newContext({ viewport: { width: 1440, height: 900 } });
  const page = await context.newPage();
  const began = performance.now();
  await page.goto(address);
  let bytes = 0;
  while (bytes < BYTES_OF_A_MAP && performance.now() - began < MAX_WAIT_MILLISECONDS) {
    bytes = (await page.screenshot({ clip: TARGET })).length;
  }
  const milliseconds = performance.now() - began;
  console.log(`first maps ${milliseconds.toFixed(0)} ms after the address was opened`);
  await browser.close();
  assert.ok(milliseconds < MOST_UNTIL_MAPS_MILLISECONDS, `${milliseconds} ms`);
});

test("the page takes little longer on one thread than the native program", { skip: !process.env.MEASURE }, async () => {
  const browser = await launch();
  const page = await browser.newPage();
  await page.goto(`${address}?measure`);
  const told = () => document.getElementById("message").textContent.trim();
  await page.waitForFunction(() => document.getElementById("message").textContent.trim().startsWith("["), null, { timeout: MAX_WAIT_MILLISECONDS });
  const ours = JSON.parse(await page.evaluate(told));
  await browser.close();
  const env = { ...process.env, RAYON_NUM_THREADS: "1", APERTURA_SIMD: "portable" };
  const theirs = JSON.parse(execFileSync(process.env.APERTURA, ["bench", "--one-thread", "--json"], { env }));
  const ratios = theirs.map(({ name, milliseconds }, i) => {
    const ratio = ours[i].milliseconds / milliseconds;
    console.log(`${name}: ${ours[i].milliseconds.toFixed(2)} ms in the page, ${milliseconds.toFixed(2)} ms natively, ratio ${ratio.toFixed(2)}`);
    return ratio;
  });
  assert.ok(Math.max(...ratios) < MOST, `the largest ratio is ${Math.max(...ratios).toFixed(2)}`);
});
