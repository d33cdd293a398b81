// The page in a real browser: `scripts/test-page` builds it, serves it and runs this.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { chromium } from "playwright-core";

const address = process.env.PAGE ?? "http://127.0.0.1:8000/";
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const software = ["--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"];

// Where things are in a window of 1440 x 900: the post of the default scene, and a place beside it.
const POST = { x: 263, y: 271 };
const BESIDE = { x: 320, y: 240 };
const AUTOSAVE = "/storage/autosave.toml";
const PATIENCE_MILLISECONDS = 60000;

let browser;
before(async () => {
  browser = await chromium.launch({ executablePath, args: [...quiet, ...software] });
});
after(() => browser.close());

// A page that is open, with what it asked of the network and told on the console.
async function open(where = "", context = null) {
  context ??= await browser.newContext({ viewport: { width: 1440, height: 900 }, acceptDownloads: true });
  const page = await context.newPage();
  const told = [];
  const asked = [];
  page.on("console", (m) => m.type() === "error" && told.push(m.text()));
  page.on("pageerror", (e) => told.push(String(e)));
  page.on("request", (r) => asked.push(r.url()));
  await page.goto(address + where);
  await page.waitForFunction(() => document.getElementById("cover").hidden, null, { timeout: PATIENCE_MILLISECONDS });
  await page.waitForTimeout(2000);
  return { context, page, told, asked };
}

async function drag(page, from, to) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= 5; step += 1) {
    await page.mouse.move(from.x + ((to.x - from.x) * step) / 5, from.y + ((to.y - from.y) * step) / 5);
    await page.waitForTimeout(100);
  }
  await page.mouse.up();
}

async function autosave(page) {
  await page.waitForFunction((key) => localStorage.getItem(key), AUTOSAVE, { timeout: PATIENCE_MILLISECONDS });
  return page.evaluate((key) => localStorage.getItem(key), AUTOSAVE);
}

test("the page opens without an error and without a foreign request", async () => {
  const { context, told, asked } = await open();
  assert.deepEqual(told, []);
  const origin = new URL(address).origin;
  assert.deepEqual(asked.filter((url) => !url.startsWith(origin) && !url.startsWith("blob:")), []);
  await context.close();
});

test("a dragged reflector is in the autosave", async () => {
  const { context, page, told } = await open();
  await drag(page, POST, BESIDE);
  const text = await autosave(page);
  assert.match(text, /kind = "point"/);
  assert.deepEqual(told, []);
  await context.close();
});

test("a reload keeps what was dragged", async () => {
  const { context, page } = await open();
  await drag(page, POST, BESIDE);
  const text = await autosave(page);
  await page.close();
  const again = await open("", context);
  await again.page.waitForTimeout(2000);
  assert.equal(await autosave(again.page), text);
  assert.deepEqual(again.told, []);
  await context.close();
});

test("a picture of the window is a whole PNG", async () => {
  const { context, page } = await open();
  await page.mouse.move(700, 870);
  const [download] = await Promise.all([
    page.waitForEvent("download", { timeout: PATIENCE_MILLISECONDS }),
    page.keyboard.press("Control+e"),
  ]);
  const bytes = await readFile(await download.path());
  assert.deepEqual([...bytes.subarray(0, 8)], [137, 80, 78, 71, 13, 10, 26, 10]);
  assert.equal(bytes.subarray(-8, -4).toString("latin1"), "IEND");
  await context.close();
});

test("addresses open a scene, a lesson and a recording", async () => {
  for (const where of ["?scene=near-field", "?lesson=two-ends", "?recording=chip-8", "?scene=nowhere", "#apertura:1:cut"]) {
    const { context, told } = await open(where);
    assert.deepEqual(told, [], where);
    await context.close();
  }
});

test("without WebGL there is a sentence", async () => {
  const bare = await chromium.launch({ executablePath, args: [...quiet, "--disable-gpu", "--disable-software-rasterizer"] });
  const page = await bare.newPage();
  await page.goto(address);
  await page.waitForFunction(() => document.getElementById("message").textContent.includes("WebGL"), null, { timeout: PATIENCE_MILLISECONDS });
  await bare.close();
});
