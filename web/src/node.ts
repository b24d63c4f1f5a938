import { readFile } from "node:fs/promises";
import { loadWith, type LoadOptions, type Orchard } from "./orchard.js";
export * from "./api.js";

/** Loads the run-time: a .wasm file beside this one, unless the options say otherwise. */
export function loadOrchard(options: LoadOptions = {}): Promise<Orchard> {
  return loadWith(options, async (build) =>
    new Uint8Array(await readFile(new URL(`./orchard-${build}.wasm`, import.meta.url))));
}
