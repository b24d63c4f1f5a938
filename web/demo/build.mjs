// Builds the demo into a folder that any host can serve: node demo/build.mjs FOLDER
import { cp, copyFile, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const [folder] = process.argv.slice(2);
if (!folder) throw new Error("Usage: node demo/build.mjs FOLDER");
const here = (path) => fileURLToPath(new URL(path, import.meta.url));

execFileSync(process.execPath, [here("../node_modules/typescript/bin/tsc"), "-p", here("tsconfig.json")], { stdio: "inherit" });
await rm(folder, { recursive: true, force: true });
await mkdir(folder, { recursive: true });
const shared = { bundle: true, minify: true, logLevel: "warning", legalComments: "none" };
await build({ ...shared, entryPoints: [here("src/main.ts")], outfile: join(folder, "demo.js"), format: "esm", target: "es2022" });
await build({ ...shared, entryPoints: [here("style.css")], outfile: join(folder, "demo.css"), loader: { ".woff2": "file" },
  assetNames: "[name]" });
await copyFile(here("index.html"), join(folder, "index.html"));
for (const variant of ["simd", "plain"]) {
  await copyFile(here(`../dist/orchard-worlds-${variant}.wasm`), join(folder, `orchard-worlds-${variant}.wasm`));
}
await cp(here("models"), join(folder, "models"), { recursive: true });

const licence = async (title, path) => `${title}\n\n${await readFile(here(path), "utf8")}`;
await writeFile(join(folder, "licences.txt"), [
  await licence("orchard's run-time and this page", "../../runtime/LICENSE"),
  await licence("three.js", "../node_modules/three/LICENSE"),
  await licence("Inter", "../node_modules/@fontsource-variable/inter/LICENSE"),
].join("\n\n\n"));
