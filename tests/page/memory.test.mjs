// Memory of the page: it doesn't grow while a scene is dragged.
import assert from "node:assert/strict";
import { BESIDE, frames, POST, testPage } from "./browser.mjs";

const DRAGS = Number(process.env.DRAGS ?? 100);
const MOST_MEBIBYTES = 20;

testPage(`memory grows by less than ${MOST_MEBIBYTES} MiB over ${DRAGS} drags`, {}, async ({ page }) => {
  const mebibytes = () => page.evaluate(() => globalThis.aperturaMemory.buffer.byteLength / 2 ** 20);
  const drags = async (count) => {
    for (let drag = 0; drag < count; drag += 1) {
      const [from, to] = drag % 2 ? [BESIDE, POST] : [POST, BESIDE];
      await page.mouse.move(from.x, from.y);
      await page.mouse.down();
      await page.mouse.move((from.x + to.x) / 2, (from.y + to.y) / 2);
      await frames(page);
      await page.mouse.move(to.x, to.y);
      await page.mouse.up();
      await frames(page);
    }
  };
  // Everything has been used once by then.
  await drags(20);
  await page.waitForTimeout(5000);
  const before = await mebibytes();
  await drags(DRAGS);
  await page.waitForTimeout(5000);
  const grown = (await mebibytes()) - before;
  console.log(`${before.toFixed(0)} MiB, ${grown.toFixed(1)} MiB more after ${DRAGS} drags`);
  assert.ok(grown < MOST_MEBIBYTES, `${grown} MiB`);
});
