// Run times on one thread: the page's against the native program's, which `scripts/measure-page` measures before.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { launch, PATIENCE_MILLISECONDS, address } from "./browser.mjs";

const MOST = 1.4;

test("the page takes little longer on one thread than the native program", { skip: !process.env.NATIVE }, async () => {
  const browser = await launch();
  const page = await browser.newPage();
  await page.goto(`${address}?measure`);
  const told = () => document.getElementById("message").textContent.trim();
  await page.waitForFunction(() => document.getElementById("message").textContent.trim().startsWith("["), null, { timeout: PATIENCE_MILLISECONDS });
  const ours = JSON.parse(await page.evaluate(told));
  await browser.close();
  const theirs = JSON.parse(readFileSync(process.env.NATIVE, "utf8"));
  const ratios = theirs.map(({ name, milliseconds }, i) => {
    const ratio = ours[i].milliseconds / milliseconds;
    console.log(`${name}: ${ours[i].milliseconds.toFixed(2)} ms in the page, ${milliseconds.toFixed(2)} ms natively, ratio ${ratio.toFixed(2)}`);
    return ratio;
  });
  assert.ok(Math.max(...ratios) < MOST, `the largest ratio is ${Math.max(...ratios).toFixed(2)}`);
});
