// The page by fingers: a point is dragged, a map is pinched, and a telephone has one column.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { autosave, BESIDE, launch, open, POST } from "./browser.mjs";

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

// Fingers on the page, by the browser's own protocol.
async function fingers(context, page) {
  const session = await context.newCDPSession(page);
  return (type, ...points) => session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
}

test("a finger drags a point", async () => {
  const { context, page, told } = await open(browser, "", { options: { hasTouch: true } });
  const touch = await fingers(context, page);
  await touch("touchStart", [POST.x, POST.y]);
  for (let step = 1; step <= 5; step += 1) {
    await touch("touchMove", [POST.x + ((BESIDE.x - POST.x) * step) / 5, POST.y + ((BESIDE.y - POST.y) * step) / 5]);
    await page.waitForTimeout(100);
  }
  await touch("touchEnd");
  assert.match(await autosave(page), /kind = "point"/);
  assert.deepEqual(told, []);
  await context.close();
});

test("two fingers zoom a map", async () => {
  const { context, page, told } = await open(browser, "", { options: { hasTouch: true } });
  await page.waitForTimeout(4000);
  const map = { x: 760, y: 100, width: 280, height: 160 };
  const before = await page.screenshot({ clip: map });
  const touch = await fingers(context, page);
  const at = (apart) => [[900 - apart, 180], [900 + apart, 180]];
  await touch("touchStart", ...at(20));
  for (let step = 1; step <= 6; step += 1) {
    await touch("touchMove", ...at(20 + step * 12));
    await page.waitForTimeout(100);
  }
  await touch("touchEnd");
  await page.waitForTimeout(1000);
  assert.notDeepEqual(await page.screenshot({ clip: map }), before);
  assert.deepEqual(told, []);
  await context.close();
});

test("on a telephone a point is dragged in the column", async () => {
  const options = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
  const { context, page, told } = await open(browser, "", { options });
  const touch = await fingers(context, page);
  // The post, as the scene lies in the first third of the column.
  await touch("touchStart", [198, 201]);
  for (let step = 1; step <= 5; step += 1) {
    await touch("touchMove", [198 + step * 8, 201 + step * 4]);
    await page.waitForTimeout(100);
  }
  await touch("touchEnd");
  assert.match(await autosave(page), /kind = "point"/);
  assert.deepEqual(told, []);
  await context.close();
});
