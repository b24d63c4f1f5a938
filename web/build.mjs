// Assembles dist/, the package, from the modules in two folders: node build.mjs SIMD PLAIN
import { copyFile, mkdir, readFile, writeFile } from "node:fs/promises";
import { execFileSync } from "node:child_process";
import { join } from "node:path";
import { fileURLToPath } from "node:url";

const [simd, plain] = process.argv.slice(2);
if (!plain) throw new Error("Usage: node build.mjs SIMD PLAIN, folders with orchard_pairs.wasm and orchard_worlds.wasm");
const here = (path) => fileURLToPath(new URL(path, import.meta.url));

await mkdir(here("dist"), { recursive: true });
execFileSync(process.execPath, [here("node_modules/typescript/bin/tsc"), "-p", here("tsconfig.json")], { stdio: "inherit" });
for (const module of ["pairs", "worlds"]) {
  let text = "";
  for (const [name, folder] of [["simd", simd], ["plain", plain]]) {
    const file = join(folder, `orchard_${module}.wasm`);
    await copyFile(file, here(`dist/orchard-${module}-${name}.wasm`));
    text += `export const ${name.toUpperCase()} = "${(await readFile(file)).toString("base64")}";\n`;
  }
  await writeFile(here(`dist/wasm_${module}.js`), text);
}
await copyFile(here("../runtime/LICENSE"), here("LICENSE"));
