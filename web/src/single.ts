import { loadWith, type LoadOptions, type Orchard } from "./orchard.js";
import { PLAIN, SIMD } from "./wasm_pairs.js";
export * from "./api.js";

/** Loads the run-time, without BroadPhase and Detector: its builds are inside this file, so that no bundler or host has to find
 * another one. */
export function loadOrchard(options: LoadOptions = {}): Promise<Orchard> {
  return loadWith(options, async (build) =>
    Uint8Array.from(atob(build.endsWith("simd") ? SIMD : PLAIN), (byte) => byte.charCodeAt(0)));
}
