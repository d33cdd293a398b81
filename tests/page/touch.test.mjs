// The page by fingers: a point is dragged, a map is pinched, and a telephone has one column.
import assert from "node:assert/strict";
import { autosave, BESIDE, POST, testPage } from "./browser.mjs";

// Moves fingers, by the browser's own protocol; `at` has their places at each part of the way.
async function move(page, context, at) {
  const session = await context.newCDPSession(page);
  const touch = (type, points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await touch("touchStart", at(0));
  for (let step = 1; step <= 6; step += 1) {
    await touch("touchMove", at(step / 6));
    await page.waitForTimeout(100);
  }
  await touch("touchEnd", []);
}

const telephone = { viewport: { width: 390, height: 844 }, isMobile: true };
for (const [name, from, to, screen] of [
  ["a finger drags a point", POST, BESIDE, {}],
  // The post, as the scene lies in the first third of the column.
  ["on a telephone a point is dragged in the column", { x: 198, y: 201 }, { x: 238, y: 221 }, telephone],
]) {
  testPage(name, { options: { hasTouch: true, ...screen } }, async ({ page, context }) => {
    await move(page, context, (part) => [[from.x + (to.x - from.x) * part, from.y + (to.y - from.y) * part]]);
    assert.match(await autosave(page), /kind = "point"/);
  });
}

testPage("two fingers zoom a map", { options: { hasTouch: true } }, async ({ page, context }) => {
  await page.waitForTimeout(4000);
  const map = { x: 760, y: 100, width: 280, height: 160 };
  const before = await page.screenshot({ clip: map });
  await move(page, context, (part) => [[880 - 72 * part, 180], [920 + 72 * part, 180]]);
  await page.waitForTimeout(1000);
  assert.notDeepEqual(await page.screenshot({ clip: map }), before);
});
