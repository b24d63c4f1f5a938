// The package in Node: node --test test/package.test.mjs (tools/web --test runs it)
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { Worker } from "node:worker_threads";
import { gzipSync } from "node:zlib";
import * as api from "orchard-runtime";
import * as single from "orchard-runtime/single";
import * as singleWorlds from "orchard-runtime/single-worlds";
import { replay } from "./replay.mjs";

const here = (path) => new URL(path, import.meta.url);
const MODELS = ["lamp", "faucet", "ship"];
const bytesOf = (model) => readFile(here(`../demo/models/${model}.orchard`));
const treesOf = async (orchard) => Promise.all(MODELS.map(async (m) => api.Tree.load(orchard, await bytesOf(m))));

/** Bytes that a module may have compressed, and what it may import. */
const LIMITS = { pairs: 150_000, worlds: 335_000 };
const IMPORTS = ["orchard.motions", "orchard.states", "env.emscripten_notify_memory_growth",
  "wasi_snapshot_preview1.clock_time_get", "wasi_snapshot_preview1.proc_exit"];

for (const module of ["pairs", "worlds"]) {
  for (const build of ["simd", "plain"]) {
    test(`the module ${module}-${build} is small and needs nothing but a clock`, async (t) => {
      const file = await readFile(here(`../dist/orchard-${module}-${build}.wasm`));
      const size = gzipSync(file, { level: 9 }).length;
      t.diagnostic(`${file.length} bytes, compressed ${size}`);
      assert.ok(size < LIMITS[module], `${size} bytes`);
      const imports = WebAssembly.Module.imports(new WebAssembly.Module(file)).map((i) => `${i.module}.${i.name}`);
      assert.deepEqual(imports.filter((name) => !IMPORTS.includes(name)), []);
    });
  }
}

for (const simd of [true, false]) {
  test(`the answers are the native ones, bit for bit, ${simd ? "with" : "without"} vectors`, async (t) => {
    const path = process.env.ORCHARD_RECORDING;
    if (!path) return t.skip("ORCHARD_RECORDING names no recording: tools/web --test makes one");
    const orchard = await api.loadOrchard({ worlds: true, simd });
    const file = await readFile(path);
    const recording = new Float64Array(file.buffer, file.byteOffset, file.length / 8);
    const start = performance.now();
    const { count, different, differing, asked } = replay(api, orchard, await treesOf(orchard), recording);
    t.diagnostic(`${count} queries in ${Math.round(performance.now() - start)} ms: ${JSON.stringify(asked)}`);
    assert.equal(different, 0, differing.join("\n"));
    assert.ok(count >= 1000);
  });
}

test("the single files answer as the others do", async () => {
  const other = await api.loadOrchard();
  for (const { loadOrchard, Tree, Pair } of [single, singleWorlds]) {
    const orchard = await loadOrchard();
    const bytes = await bytesOf("lamp");
    const verdicts = [[orchard, Tree, Pair], [other, api.Tree, api.Pair]].map(([o, T, P]) => {
      const tree = T.load(o, bytes);
      return new P(tree, tree).collide(api.identity(), api.poseOf(other, { translation: [1, 0.5, 0] }));
    });
    assert.deepEqual(verdicts[0], verdicts[1]);
  }
});

test("an instance of the pairs' module says how to get worlds", async () => {
  const orchard = await api.loadOrchard();
  assert.equal(orchard.worlds, false);
  assert.throws(() => new api.Detector(orchard), /worlds: true/);
  assert.throws(() => new api.BroadPhase(orchard), /worlds: true/);
});

test("a file that is no tree, or is cut off or altered, is refused with the reason", async () => {
  const orchard = await api.loadOrchard();
  const bytes = await bytesOf("lamp");
  const altered = Uint8Array.from(bytes);
  altered[5000] ^= 1;
  for (const [file, reason] of [[new Uint8Array(0), /No tree/], [new TextEncoder().encode("solid cube"), /No tree/],
    [bytes.subarray(0, 4096), /No tree/], [altered, /No tree/]]) {
    assert.throws(() => api.Tree.load(orchard, file), (error) => error instanceof api.LoadError && reason.test(error.message));
  }
  assert.ok(api.Tree.load(orchard, bytes).triangleCount > 0);
});

test("levels go from no answer to the triangles' one, and bounds only get better", async () => {
  const orchard = await api.loadOrchard();
  const [lamp, faucet] = await treesOf(orchard);
  const pair = new api.Pair(lamp, faucet);
  const poses = [api.identity(), api.poseOf(orchard, { translation: [0.8, 0.3, 0] })];
  let verdict = pair.start(...poses);
  for (let bound = verdict.separationBound; !verdict.finished; bound = verdict.separationBound) {
    verdict = pair.refine();
    assert.ok(verdict.separationBound <= bound);
  }
  assert.equal(verdict.answer, pair.collide(...poses).answer);
  assert.equal(pair.collide(...poses, { tests: 0 }).answer, "maybe");
  assert.ok(pair.collide(new Float64Array(13), poses[1]).refused);
});

test("spheres cover the mesh, level by level", async () => {
  const orchard = await api.loadOrchard();
  const [lamp] = await treesOf(orchard);
  const { vertices, triangles } = lamp.mesh();
  assert.equal(triangles.length, 3 * lamp.triangleCount);
  for (let level = 0; level <= lamp.depth; ++level) {
    const spheres = lamp.spheres(level);
    for (let v = 0; v < vertices.length; v += 3) {
      let inside = false;
      for (let s = 0; s < spheres.length && !inside; s += 5) {
        const d = Math.hypot(...[0, 1, 2].map((k) => vertices[v + k] - spheres[s + k]));
        inside = d <= spheres[s + 3] * (1 + 1e-6);
      }
      assert.ok(inside, `vertex ${v / 3} at level ${level}`);
    }
  }
  assert.equal(lamp.spheres(0).length, 5);
});

test("what is freed is not used, and what is used is not freed", async () => {
  const orchard = await api.loadOrchard();
  const [lamp] = await treesOf(orchard);
  const pair = new api.Pair(lamp, lamp);
  assert.throws(() => lamp.free(), /still used \(2 times\)/);
  pair.free();
  pair.free();
  assert.throws(() => pair.start(api.identity(), api.identity()), /was freed/);
  lamp.free();
  assert.throws(() => lamp.spheres(0), /was freed/);
});

test("what a source throws arrives at the caller, and it may not call the module", async () => {
  const orchard = await api.loadOrchard({ worlds: true });
  for (const [source, reason] of [[() => { throw new TypeError("no such body"); }, /no such body/],
    [() => api.poseOf(orchard, {}), /may not call/]]) {
    const world = new api.BroadPhase(orchard, source);
    world.add();
    assert.throws(() => world.advance(1), reason);
    world.free();
  }
});

test("a detector keeps states, reports a contact that begins and its manifold", async () => {
  const orchard = await api.loadOrchard({ worlds: true });
  const [lamp] = await treesOf(orchard);
  const world = new api.Detector(orchard, { timeStep: 1 / 60 });
  const shape = world.addTree(lamp);
  const [still, moving] = [[0, 0], [10, -3]].map(([x, v]) => {
    const state = api.restingState();
    state[api.STATE.translation] = x;
    state[api.STATE.velocity] = v;
    return world.addBody(shape, {}, state);
  });
  let begun;
  for (let step = 0; step < 300 && !begun; ++step) begun = world.step(step / 60).events.find((e) => e.change === "begin");
  assert.deepEqual([begun.a, begun.b], [still, moving]);
  assert.equal(begun.verdict.answer, "yes");
  assert.ok(world.manifold(begun).points.length >= 1);
  const hit = world.castRay([-20, 0.5, 0], [1, 0, 0]);
  assert.ok(hit === undefined || hit.body.index <= 1);
  assert.ok(world.touchingSphere([0, 0, 0], 50).length === 2);
  assert.throws(() => lamp.free(), /still used/);
  world.free();
  lamp.free();
});

test("a worker uses the module that was compiled here", async () => {
  const orchard = await api.loadOrchard();
  const worker = new Worker(here("worker.mjs"), { workerData: { compiled: orchard.compiled, simd: orchard.simd } });
  const answer = await new Promise((resolve, reject) => worker.once("message", resolve).once("error", reject));
  assert.deepEqual(answer, { version: orchard.version, inside: "yes" });
});
