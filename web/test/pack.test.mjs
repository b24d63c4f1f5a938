// What `npm pack` packs, as others use it: installed elsewhere, run in Node, typed, bundled.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const run = (folder, command, ...options) => execFileSync(command, options, { cwd: folder, encoding: "utf8" });

let folder, files;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), "orchard-pack-"));
  const [packed] = JSON.parse(run(here(".."), "npm", "pack", "--json", "--pack-destination", folder));
  files = packed.files.map((file) => file.path);
  await writeFile(join(folder, "package.json"), '{ "type": "module" }');
  run(folder, "npm", "install", "--silent", "--offline", "--no-audit", "--no-fund", join(folder, packed.filename));
});
after(() => rm(folder, { recursive: true, force: true }));

const PROGRAM = `
  import { collideAll, identity, loadOrchard, Pair, poseOf, Tree, verdictAt, type Verdict } from "orchard-runtime";
  const orchard = await loadOrchard();
  const box: Tree = Tree.box(orchard, [1, 1, 1]);
  const pair = new Pair(box, box);
  const verdict: Verdict = pair.collide(identity(), poseOf(orchard, { translation: [3, 0, 0] }), { tests: 1000 });
  const rows: Float64Array = collideAll(box, identity(), box, identity());
  console.log(verdict.answer, pair.distance(identity(), poseOf(orchard, { translation: [3, 0, 0] })).upper, verdictAt(rows).answer);
`;

/** Compiles a program in the folder; throws what the compiler says of it. */
async function check(name, program) {
  await writeFile(join(folder, name), program);
  await writeFile(join(folder, "tsconfig.json"), JSON.stringify({ files: [name],
    compilerOptions: { strict: true, target: "es2022", module: "nodenext", types: [], lib: ["es2022", "dom"] } }));
  run(folder, process.execPath, here("../node_modules/typescript/bin/tsc"));
}

test("it holds the modules, the types, the licence and a page to read, and nothing of the demo", () => {
  for (const path of ["dist/browser.js", "dist/browser.d.ts", "dist/single.js", "dist/orchard-pairs-simd.wasm",
    "dist/orchard-worlds-plain.wasm", "LICENSE", "README.md", "package.json"]) assert.ok(files.includes(path), path);
  assert.deepEqual(files.filter((path) => !/^(dist\/|LICENSE$|README\.md$|package\.json$)/.test(path)), []);
});

test("a program in TypeScript is checked against its types, and runs in Node", async () => {
  await check("program.ts", PROGRAM);
  assert.match(run(folder, process.execPath, "program.js"), /^no 1(\.0+\d*)? yes\n$/);
});

test("a wrong program is refused by the types", async () => {
  await assert.rejects(check("wrong.ts", PROGRAM.replace("{ tests: 1000 }", "{ test: 1000 }")),
    (error) => /'test' does not exist/.test(error.stdout));
});

test("a bundle for browsers finds no Node in it, and names the .wasm files as bundlers look for them", async () => {
  await writeFile(join(folder, "entry.js"), 'export { loadOrchard } from "orchard-runtime";');
  const { outputFiles } = await build({ entryPoints: [join(folder, "entry.js")], bundle: true, write: false, format: "esm",
    platform: "browser", absWorkingDir: folder, logLevel: "error" });
  assert.match(outputFiles[0].text, /new URL\("\.\/orchard-pairs-simd\.wasm", import\.meta\.url\)/);
});

test("the version is that of the run-time", async () => {
  const { version } = JSON.parse(await readFile(here("../package.json"), "utf8"));
  const { loadOrchard } = await import("orchard-runtime");
  assert.equal((await loadOrchard()).version, version);
});
