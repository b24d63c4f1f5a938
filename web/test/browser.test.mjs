// The demo in headless Chromium: node --test test/browser.test.mjs (tools/web --test runs it). ORCHARD_SITE is its folder.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { serve } from "../serve.mjs";
import { openBrowser, openDemo, press, settle, slide } from "./browser.mjs";
import { difference, shades } from "./pictures.mjs";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
/** Milliseconds that a step of the crowd may take in the mean, on a slow machine that draws by software at the same time. */
const BUDGETS = { bounds: 8, exact: 60 };
/** The share of pixels of a picture that may differ visibly from the reference: other fonts' edges, other versions of ANGLE. */
const TOLERANCE = 0.03;

let site, browser;
before(async () => {
  site = await serve(0, { "/": process.env.ORCHARD_SITE, "/dist/": here("../dist/"), "/test/": here("./"),
    ...(process.env.ORCHARD_RECORDING && { "/recording/": process.env.ORCHARD_RECORDING.replace(/[^/]*$/, "") }) });
  browser = await openBrowser();
});
after(async () => {
  await browser?.close();
  site?.server.close();
});

/** Runs `work` with a page of the demo, which must not have asked another host for anything, nor reported an error. */
async function withDemo(options, work) {
  const { page, seen } = await openDemo(browser.browser, site.address, options);
  try {
    await work(page, seen);
    assert.deepEqual(seen, { foreign: [], errors: [] });
  } finally {
    await page.close();
  }
}
const text = (page, selector) => page.$eval(selector, (element) => element.textContent.trim());
/** Waits until `check` of the page holds. */
const until = (page, check) => page.waitForFunction(check, { timeout: 120_000, polling: 200 });

async function drop(page, name, bytes) {
  await page.evaluate((file, base64) => {
    const data = new DataTransfer();
    data.items.add(new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], file));
    dispatchEvent(new DragEvent("drop", { dataTransfer: data, cancelable: true }));
  }, name, Buffer.from(bytes).toString("base64"));
}

for (const [name, options] of [["levels", {}], ["levels-phone", { width: 390, height: 844 }], ["levels-dark", { dark: true }],
  ["collide", { hash: "#collide" }], ["collide-phone", { width: 390, height: 844, hash: "#collide" }]]) {
  test(`the picture ${name} looks like the reference`, async () => {
    await withDemo(options, async (page) => {
      // Times differ from run to run.
      await page.addStyleTag({ content: "#descent td:last-child, #descent th:last-child { visibility: hidden }" });
      await settle(page);
      const picture = await page.screenshot();
      const reference = here(`pictures/${name}.png`);
      if (process.env.ORCHARD_NEW_PICTURES) {
        const { writeFile } = await import("node:fs/promises");
        return writeFile(reference, picture);
      }
      const share = await difference(page, picture, await readFile(reference));
      assert.ok(share <= TOLERANCE, `${(100 * share).toFixed(2)} % of the pixels differ`);
      assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), "nothing is wider than the window");
    });
  });
}

test("the slider of levels shows more and tighter spheres, in colours", async () => {
  await withDemo({}, async (page) => {
    let before = { count: 0, worst: Infinity };
    for (const level of [0, 1, 2, 3]) {
      await slide(page, "#level", level);
      const [count] = (await text(page, "#level-note")).replace(/,/g, "").match(/\d+/);
      const worst = Number(await page.$eval("#level", (slider) => slider.dataset.worst));
      assert.ok(Number(count) > before.count && worst < before.worst, `level ${level}`);
      before = { count: Number(count), worst };
    }
    await settle(page);
    assert.ok(await shades(page, await (await page.$("#stage")).screenshot()) > 40, "the stage has spheres in many shades");
  });
});

test("the axis is shown by radius, thickness and structure, each with its legend", async () => {
  await withDemo({}, async (page) => {
    const pictures = [];
    for (const [color, legend] of [["radius", /Radius of the ball/], ["thickness", /Thickness where/], ["structure", /seams/]]) {
      await press(page, `[name=axis-color][value=${color}]`);
      await settle(page);
      assert.match(await text(page, "#legend"), legend);
      pictures.push(await (await page.$("#stage")).screenshot());
    }
    for (const [a, b] of [[0, 1], [0, 2], [1, 2]]) assert.ok(await difference(page, pictures[a], pictures[b]) > 0.01);
  });
});

test("arrow keys move the second body onto the first, and the answer goes down the levels to yes", async () => {
  await withDemo({ hash: "#collide" }, async (page) => {
    const answers = new Set([await text(page, "#answer strong")]);
    assert.deepEqual([...answers], ["No"]);
    await page.focus("#canvas");
    for (let i = 0; i < 60 && !answers.has("Yes"); ++i) {
      await page.keyboard.press("ArrowLeft");
      answers.add(await text(page, "#answer strong"));
    }
    assert.ok(answers.has("Yes"), [...answers].join());
    const rows = await page.$$eval("#descent tbody tr", (all) => all.map((row) => [...row.cells].map((cell) => cell.textContent)));
    assert.equal(rows.at(-1)[1], "yes");
    assert.equal(rows[0][1], "maybe");
    const pairs = rows.map((row) => Number(row[3].replace(/,/g, "")));
    assert.deepEqual(pairs, [...pairs].sort((a, b) => a - b));
    await slide(page, "#budget", 0);
    assert.equal(await text(page, "#answer strong"), "Maybe");
    assert.match(await text(page, "#answer span"), /at most .* apart/);
    await slide(page, "#budget", 100);
    assert.equal(await text(page, "#answer strong"), "Yes");
  });
});

test("a body is dragged", async () => {
  await withDemo({ hash: "#collide" }, async (page) => {
    const before = await text(page, "#answer span");
    await page.mouse.move(560, 640);  // on the faucet's foot
    await page.mouse.down();
    await page.mouse.move(500, 630, { steps: 2 });
    await page.mouse.up();
    assert.notEqual(await text(page, "#answer span"), before);
    assert.equal(await text(page, "#answer strong"), "Yes");
  });
});

test("everything is reached by the keyboard", async () => {
  await withDemo({}, async (page) => {
    const reached = new Set();
    for (let i = 0; i < 24; ++i) {
      await page.keyboard.press("Tab");
      reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.name || document.activeElement.textContent));
    }
    for (const id of ["tab-levels", "ground", "canvas", "model", "Open a file", "level", "show-axis", "axis-color"]) {
      assert.ok(reached.has(id), `${id} is not among ${[...reached].join(", ")}`);
    }
    await page.focus("#tab-levels");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.evaluate(() => document.body.dataset.view), "collide");
  });
});

test("files that are dropped are shown", async () => {
  await withDemo({}, async (page) => {
    await drop(page, "mine.orchard", await readFile(here("../demo/models/ship.orchard")));
    await until(page, () => document.querySelector("#models input:checked").value === "mine.orchard");
    await drop(page, "triangle.ma", "4 6 2\nv 0 0 0 .5\nv 1 0 0 .5\nv 0 1 0 .5\nv 1 1 0 .2\ne 0 1\ne 0 2\ne 1 2\ne 1 3\ne 2 3\ne 0 3\nf 0 1 2\nf 1 2 3\n");
    await until(page, () => document.querySelector("#models input:checked").value === "triangle.ma");
    assert.equal(await page.$eval("#message", (message) => message.hidden), true);
    assert.match(await text(page, "#legend"), /Radius/);
  });
});

test("a wrong file is refused with a clear message, and what was shown stays", async () => {
  await withDemo({}, async (page) => {
    const tree = await readFile(here("../demo/models/lamp.orchard"));
    for (const [name, bytes, reason] of [["notes.txt", "hello", /reads \.orchard files .* and \.ma files/],
      ["broken.orchard", tree.subarray(0, 5000), /broken\.orchard is not shown.*No tree was loaded/],
      ["text.orchard", "not a tree", /No tree was loaded/], ["axis.ma", "2 0 0\nv 0 0 0 1\nv 0 0 x 1\n", /Line 3: .* should be a number, not "x"/],
      ["short.ma", "2 0 0\nv 0 0 0 1\n", /ends after line 2, where vertex 1 should follow/]]) {
      await drop(page, name, bytes);
      await page.waitForFunction((expected) => document.querySelector("#message").textContent.startsWith(expected), {}, name);
      assert.match(await text(page, "#message"), reason);
      assert.equal(await page.$eval("#message", (message) => message.hidden), false);
    }
    assert.equal(await page.$eval("#models input:checked", (input) => input.value), "Lamp");
  });
});

test("the answers in the browser are the native ones, bit for bit", async (t) => {
  const path = process.env.ORCHARD_RECORDING;
  if (!path) return t.skip("ORCHARD_RECORDING names no recording: tools/web --test makes one");
  await withDemo({}, async (page) => {
    const result = await page.evaluate(async (recording) => {
      const api = await import("/dist/browser.js");
      const { replay } = await import("/test/replay.mjs");
      const bytes = async (file) => (await fetch(file)).arrayBuffer();
      const orchard = await api.loadOrchard({ worlds: true });
      const trees = await Promise.all(["lamp", "faucet", "ship"].map(async (m) => api.Tree.load(orchard, await bytes(`/models/${m}.orchard`))));
      return { ...replay(api, orchard, trees, new Float64Array(await bytes(recording))), simd: orchard.simd };
    }, `/recording/${path.split("/").at(-1)}`);
    t.diagnostic(`${result.count} queries, with vectors: ${result.simd}`);
    assert.equal(result.different, 0, result.differing.join("\n"));
  });
});

test("1,000 bodies: overlaps are those of the hash, in milliseconds within the budget", async (t) => {
  await withDemo({ width: 420, height: 500, hash: "#crowd" }, async (page) => {  // few pixels, drawn by software
    await until(page, () => Number(document.querySelector("#crowd-exact").dataset.steps) >= 60);
    await press(page, "#pause");
    const value = (selector) => page.$eval(selector, (element) => Number(element.dataset.value));
    const figures = { bounds: await value("#crowd-bounds"), hash: await value("#crowd-hash"), exact: await value("#crowd-exact") };
    t.diagnostic(JSON.stringify(figures));
    for (const [name, limit] of Object.entries(BUDGETS)) assert.ok(figures[name] <= limit, `${name}: ${figures[name]} ms`);
    const [bounds, hash] = (await page.$eval("#crowd-exact", (element) => element.dataset.overlaps)).split(" ").map(Number);
    assert.equal(bounds, hash);
    assert.ok(bounds > 50);
    assert.ok(await value("#crowd-asked") < 500, "most bodies are not asked about");
  });
});

test("the single file works from a bundle, in a worker", async () => {
  const { build } = await import("esbuild");
  const { outputFiles } = await build({ bundle: true, write: false, format: "esm", logLevel: "error", absWorkingDir: here(".."),
    stdin: { resolveDir: here(".."), contents: `
      import { identity, loadOrchard, Tree } from "orchard-runtime/single";
      loadOrchard().then((orchard) => postMessage(Tree.box(orchard, [1, 1, 1]).contains(identity(), [0.5, 0, 0])));` } });
  await withDemo({}, async (page) => {
    const answer = await page.evaluate((code) => new Promise((resolve, reject) => {
      const worker = new Worker(URL.createObjectURL(new Blob([code], { type: "text/javascript" })), { type: "module" });
      worker.onmessage = (event) => resolve(event.data);
      worker.onerror = (event) => reject(new Error(event.message));
    }), outputFiles[0].text);
    assert.equal(answer, "yes");
  });
});
