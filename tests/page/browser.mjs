// Tools of the page's tests: a browser, open pages, and a person's actions in them.
import assert from "node:assert/strict";
import { after, test } from "node:test";
import { deflateSync } from "node:zlib";
import { chromium } from "playwright-core";

export const address = process.env.PAGE ?? "http://127.0.0.1:8000/";
// The same page from a host that sends no headers.
export const plainAddress = process.env.PLAIN_PAGE ?? address;

const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
const quiet = ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const software = ["--enable-unsafe-swiftshader", "--use-gl=angle", "--use-angle=swiftshader"];

export const MAX_WAIT_MILLISECONDS = 120000;
export const AUTOSAVE = "/storage/autosave.toml";
export const DESK = { width: 1440, height: 900 };

// Where things are in a window of 1440 x 900: the post of the default scene, and a place beside it.
export const POST = { x: 263, y: 245 };
export const BESIDE = { x: 320, y: 261 };

export const launch = () => chromium.launch({ executablePath, args: [...quiet, ...software] });
export const launchWithoutGraphics = () =>
  chromium.launch({ executablePath, args: [...quiet, "--disable-gpu", "--disable-software-rasterizer"] });

// The browser of a file of tests, from its first page to its end.
let browser;
after(async () => (await browser)?.close());

// A page that is open, with what it asked of the network and told on the console.
export async function open(where = "", { context = null, options = {}, at = address } = {}) {
  browser ??= launch();
  context ??= await (await browser).newContext({ viewport: DESK, acceptDownloads: true, ...options });
  const page = await context.newPage();
  const told = [];
  const asked = [];
  page.on("console", (m) => m.type() === "error" && told.push(m.text()));
  page.on("pageerror", (e) => told.push(String(e)));
  page.on("request", (r) => asked.push(r.url()));
  await page.goto(at + where);
  await page.waitForFunction(() => document.getElementById("cover").hidden, null, { timeout: MAX_WAIT_MILLISECONDS });
  await page.waitForTimeout(2000);
  return { context, page, told, asked };
}

// A test of one page, opened as by `open`, that may tell no error on the console.
export function testPage(name, { where, ...how }, act) {
  test(name, async () => {
    const opened = await open(where, how);
    await act(opened);
    assert.deepEqual(opened.told, []);
    await opened.context.close();
  });
}

export async function drag(page, from, to, steps = 5) {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= steps; step += 1) {
    await page.mouse.move(from.x + ((to.x - from.x) * step) / steps, from.y + ((to.y - from.y) * step) / steps);
    await page.waitForTimeout(100);
  }
  await page.mouse.up();
}

export async function autosave(page) {
  await page.waitForFunction((key) => localStorage.getItem(key), AUTOSAVE, { timeout: MAX_WAIT_MILLISECONDS });
  return page.evaluate((key) => localStorage.getItem(key), AUTOSAVE);
}

// Waits until the window has been drawn some times.
export const frames = (page) =>
  page.evaluate(async () => {
    for (let frame = 0; frame < 5; frame += 1) {
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  });

// Runs a command by its name in the palette.
export async function run(page, name) {
  await page.keyboard.press("Control+k");
  await frames(page);
  await page.keyboard.insertText(name);
  await frames(page);
  await page.keyboard.press("Enter");
  await frames(page);
}

export async function exported(page, name) {
  const download = page.waitForEvent("download", { timeout: MAX_WAIT_MILLISECONDS });
  await run(page, name);
  return (await download).path();
}

// A link's text: a scene file of the program, looked at over a floor (as the command line names it) by a method.
export function shared(scene, { floor = "thesis", method = "live", eta = 0.9 } = {}) {
  const [level, decibels] = floor.split("=");
  const written = decibels ? `{ ${level} = ${Number(decibels).toFixed(1)} }` : JSON.stringify(level);
  const view = [
    "", "[shared]", `floor = ${written}`, 'normalisation = "min-max"', 'colours = "inferno"', "cartesian = false",
    `target_eta = ${eta}`, `method = ${JSON.stringify(method)}`, "marks = false", "theory = false",
    "[shared.range_angle_part]", "left = 0.0", "bottom = 0.0", "right = 1.0", "top = 1.0",
    "[shared.cartesian_part]", "left = 0.0", "bottom = 0.0", "right = 1.0", "top = 1.0", "",
  ];
  return `apertura:1:${deflateSync(Buffer.from(scene + view.join("\n"))).toString("base64url")}`;
}
