// Links to the page: what they open, and what becomes of damaged ones.
import assert from "node:assert/strict";
import { deflateSync } from "node:zlib";
import { test } from "node:test";
import { address, BESIDE, drag, open, POST, run, shared } from "./browser.mjs";

const SCENE = "[[object]]\nkind = \"point\"\nx_metres = 3.0\ny_metres = 12.0\n";
const settled = (page) => page.waitForTimeout(4000);
const options = { permissions: ["clipboard-read", "clipboard-write"] };

// The link that the page would copy.
async function copied(page) {
  await run(page, "Copy link");
  await page.waitForTimeout(1000);
  return page.evaluate(() => navigator.clipboard.readText());
}

test("a link that was copied opens the same in a second page", async () => {
  const { context, page, told } = await open("", { options });
  await drag(page, POST, BESIDE);
  await settled(page);
  const link = await copied(page);
  assert.ok(link.startsWith(`${address}#apertura:1:`), link.slice(0, 80));
  const second = await open(link.slice(address.length), { options });
  await settled(second.page);
  assert.equal(await copied(second.page), link);
  assert.deepEqual([...told, ...second.told], []);
  await context.close();
  await second.context.close();
});

test("addresses open a scene, a lesson and a recording", async () => {
  const pictures = [];
  for (const where of ["", "?scene=street", "?lesson=two-ends", "?recording=chip-8"]) {
    const { context, page, told } = await open(where);
    await settled(page);
    pictures.push((await page.screenshot()).toString("base64"));
    assert.deepEqual(told, [], where);
    await context.close();
  }
  assert.equal(new Set(pictures).size, pictures.length, "each shows something else");
});

test("a link that is cut, forged or too long leaves the default scene", async () => {
  const whole = shared(SCENE);
  const bomb = `apertura:1:${deflateSync(Buffer.alloc(64 << 20, "#")).toString("base64url")}`;
  const strange = `apertura:1:${deflateSync(Buffer.from("smell = 1\n")).toString("base64url")}`;
  const plain = await open("", { options });
  const usual = await copied(plain.page);
  await plain.context.close();
  const links = { cut: whole.slice(0, -9), bomb, strange, long: `apertura:1:${"A".repeat(1 << 20)}` };
  const places = Object.entries(links).map(([name, text]) => [name, `#${text}`]);
  for (const [name, where] of [...places, ["no scene", "?scene=nowhere"], ["no question", "?weather=rain"]]) {
    const { context, page, told } = await open(where, { options });
    await settled(page);
    assert.equal(await copied(page), usual, name);
    assert.deepEqual(told, [], name);
    await context.close();
  }
});
