import { Instance } from "./module.js";

/** The run-time, instantiated once: what every tree and world is made with. Belongs to one thread; a worker makes its own
 * of the same `WebAssembly.Module`. */
export class Orchard {
  /** For the code of this package. */
  readonly module: Instance;
  /** For workers: `postMessage({ compiled: orchard.compiled, simd: orchard.simd })`, and there `loadOrchard(event.data)`. */
  readonly compiled: WebAssembly.Module;
  /** Whether the build with vectors is used. Answers are the same. */
  readonly simd: boolean;
  /** Whether BroadPhase and Detector are there. */
  readonly worlds: boolean;
  /** Of the run-time, as in `orchard --version`. */
  readonly version: string;

  constructor(compiled: WebAssembly.Module, simd: boolean) {
    this.module = new Instance(compiled);
    this.compiled = compiled;
    this.simd = simd;
    this.worlds = "broad_new" in this.module.call;
    this.version = this.module.text(this.module.call.version!());
  }
}

/** What loadOrchard may be told. */
export interface LoadOptions {
  /** Whether to load the module that has BroadPhase and Detector as well, of about twice the length. */
  worlds?: boolean;
  /** The build with vectors or the plain one; by default what the engine can run. */
  simd?: boolean;
  /** Where the .wasm file is, for bundlers that move it: an address, its bytes, or a response. */
  wasm?: string | URL | ArrayBuffer | Uint8Array | Response | PromiseLike<Response>;
  /** A module compiled already, from another thread's `orchard.compiled`: goes with `simd` of the same. */
  compiled?: WebAssembly.Module;
}

/** A function with one instruction of the vectors: valid only where they are known. */
const VECTORS = new Uint8Array([
  0, 97, 115, 109, 1, 0, 0, 0, 1, 5, 1, 96, 0, 1, 123, 3, 2, 1, 0, 10, 10, 1, 8, 0, 65, 0, 253, 15, 253, 98, 11,
]);
/** Whether this engine runs the build with vectors. */
export const hasSimd = (): boolean => WebAssembly.validate(VECTORS);

/** The four builds of the module. */
export type Build = "pairs-simd" | "pairs-plain" | "worlds-simd" | "worlds-plain";

/** For the entries of this package: `read` gives the bytes of a build. */
export async function loadWith(options: LoadOptions, read: (build: Build) => Promise<BufferSource>): Promise<Orchard> {
  const simd = options.simd ?? hasSimd();
  if (options.compiled) return new Orchard(options.compiled, simd);
  const build: Build = `${options.worlds ? "worlds" : "pairs"}-${simd ? "simd" : "plain"}`;
  const bytes = options.wasm === undefined ? await read(build) : await bytesOf(options.wasm);
  return new Orchard(await WebAssembly.compile(bytes), simd);
}

async function bytesOf(from: NonNullable<LoadOptions["wasm"]>): Promise<BufferSource> {
  if (from instanceof ArrayBuffer) return from;
  if (from instanceof Uint8Array) return from as Uint8Array<ArrayBuffer>;
  return fetched(typeof from === "string" || from instanceof URL ? fetch(from) : from);
}

export async function fetched(response: Response | PromiseLike<Response>): Promise<ArrayBuffer> {
  const got = await response;
  if (!got.ok) {
    throw new Error(`The orchard module was not found at ${got.url} (status ${got.status}): pass its address as the option "wasm", or import "orchard-runtime/single".`);
  }
  return got.arrayBuffer();
}
