import { fetched, loadWith, type Build, type LoadOptions, type Orchard } from "./orchard.js";
export * from "./api.js";

/** Loads the run-time: a .wasm file beside this one, unless the options say otherwise. */
export function loadOrchard(options: LoadOptions = {}): Promise<Orchard> {
  return loadWith(options, (build) => fetched(fetch(FILES[build]())));
}

// Written out, as bundlers look for just this form.
const FILES: Record<Build, () => URL> = {
  "pairs-simd": () => new URL("./orchard-pairs-simd.wasm", import.meta.url),
  "pairs-plain": () => new URL("./orchard-pairs-plain.wasm", import.meta.url),
  "worlds-simd": () => new URL("./orchard-worlds-simd.wasm", import.meta.url),
  "worlds-plain": () => new URL("./orchard-worlds-plain.wasm", import.meta.url),
};
