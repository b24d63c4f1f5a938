/** Numbers of each kind of row that the module and this code exchange; see module/module.h. */
export const POSE_NUMBERS = 13;
export const VERDICT_NUMBERS = 16;
export const DISTANCE_NUMBERS = 10;
export const MOTION_NUMBERS = 13;
export const STATE_NUMBERS = 23;

type Call = (...numbers: number[]) => number;
/** What a world asks: bodies' indices, and the rows to fill in. */
export type Ask = (time: number, bodies: Uint32Array, rows: Float64Array) => void;

const OUT = 512; // doubles of the exchange before this place are arguments, those after it answers

/** One instance of the WebAssembly module: its functions, its memory, and the callbacks of its worlds. */
export class Instance {
  readonly call: Record<string, Call>;
  readonly #memory: WebAssembly.Memory;
  readonly #exchange: number;
  readonly #sources = new Map<number, Ask>();
  #doubles: Float64Array;
  #nextSource = 1;
  #asking = false;
  #thrown: unknown[] = [];

  constructor(module: WebAssembly.Module) {
    const rows = (size: number) => (world: number, time: number, bodies: number, count: number, to: number) =>
      this.#ask(world, time, bodies >>> 0, count, to >>> 0, size);
    const instance = new WebAssembly.Instance(module, {
      orchard: { motions: rows(MOTION_NUMBERS), states: rows(STATE_NUMBERS) },
      env: { emscripten_notify_memory_growth: () => {} },
      wasi_snapshot_preview1: {
        clock_time_get: (_clock: number, _precision: bigint, to: number) => this.#writeClock(to >>> 0),
        proc_exit: (code: number) => {
          throw new Error(`The orchard module ended with the code ${code}: it ran out of memory.`);
        },
      },
    });
    this.call = instance.exports as unknown as Record<string, Call>;
    this.#memory = instance.exports.memory as WebAssembly.Memory;
    this.#doubles = new Float64Array(this.#memory.buffer);
    this.call._initialize!();
    this.#exchange = this.call.exchange!() >>> 0;
  }

  /** The memory as doubles: never keep it, as it is another array when memory has grown. */
  get doubles(): Float64Array {
    if (this.#doubles.buffer !== this.#memory.buffer) this.#doubles = new Float64Array(this.#memory.buffer);
    return this.#doubles;
  }
  bytes(address: number, count: number): Uint8Array {
    return new Uint8Array(this.#memory.buffer, address >>> 0, count);
  }
  integers(address: number, count: number): Uint32Array {
    return new Uint32Array(this.#memory.buffer, address >>> 0, count);
  }
  numbers(address: number, count: number): Float64Array {
    return new Float64Array(this.#memory.buffer, address >>> 0, count);
  }

  /** Writes arguments, rows one after another, and returns where they are. At most 512 numbers. */
  write(...rows: ArrayLike<number>[]): number {
    if (this.#asking) throw new Error("A source of motions or states may not call the orchard module that asks it.");
    let place = this.#exchange / 8;
    for (const row of rows) {
      this.doubles.set(row, place);
      place += row.length;
    }
    return this.#exchange;
  }
  /** Where answers go. */
  get out(): number {
    return this.#exchange + OUT * 8;
  }
  /** The first `count` numbers of an answer; never keep it. */
  answer(count: number): Float64Array {
    const place = this.#exchange / 8 + OUT;
    return this.doubles.subarray(place, place + count);
  }

  /** Memory of the module for the time of `use`, aligned to 32 bytes. */
  lend<T>(bytes: number, use: (address: number) => T): T {
    const address = this.call.allocate!(Math.max(bytes, 1)) >>> 0;
    if (address === 0) throw new Error(`The orchard module has no memory for ${bytes} bytes.`);
    try {
      return use(address);
    } finally {
      this.call.release!(address);
    }
  }
  text(address: number): string {
    const all = new Uint8Array(this.#memory.buffer, address >>> 0);
    return new TextDecoder().decode(all.slice(0, all.indexOf(0)));
  }

  /** Registers a source under the number returned. */
  addSource(ask: Ask): number {
    this.#sources.set(this.#nextSource, ask);
    return this.#nextSource++;
  }
  removeSource(number: number): void {
    this.#sources.delete(number);
  }
  /** Runs what may ask a source, and throws what the source threw. */
  withSource<T>(work: () => T): T {
    if (this.#asking) throw new Error("A source of motions or states may not call the orchard module that asks it.");
    const result = work();
    if (this.#thrown.length > 0) throw this.#thrown.splice(0)[0];
    return result;
  }

  /** An exception must not cross the module, whose work it would leave half done: it is kept until the call returns. */
  #ask(world: number, time: number, bodies: number, count: number, to: number, size: number): void {
    this.#asking = true;
    try {
      this.#sources.get(world)!(time, this.integers(bodies, count), this.numbers(to, count * size));
    } catch (error) {
      this.#thrown.push(error);
    } finally {
      this.#asking = false;
    }
  }

  #writeClock(to: number): number {
    const nanoseconds = BigInt(Math.round(performance.now() * 1e6));
    new DataView(this.#memory.buffer).setBigUint64(to, nanoseconds, true);
    return 0;
  }
}

/** Something that lives in the module's memory until it is freed. */
export abstract class Owned {
  #handle: number;
  /** How many others need it. */
  protected users = 0;

  /** Throws unless the module has what worlds need. */
  protected static needWorlds({ call }: Instance): void {
    if (!("broad_new" in call)) {
      throw new Error("This orchard has no BroadPhase and no Detector: load it with loadOrchard({ worlds: true }).");
    }
  }
  protected constructor(readonly module: Instance, handle: number, private readonly kind: string) {
    if (handle === 0) throw new Error(`The orchard module has no memory for another ${kind}.`);
    this.#handle = handle;
  }
  /** For the code of this package: the address in the module. */
  get handle(): number {
    if (this.#handle === 0) throw new Error(`This ${this.kind} was freed.`);
    return this.#handle;
  }
  protected take(handle: number): void {
    this.#handle = handle;
  }
  /** For the code of this package: one more or one fewer that needs it. */
  use(change: 1 | -1): void {
    this.users += change;
  }
  protected release(call: string): boolean {
    if (this.#handle === 0) return false;
    if (this.users > 0) throw new Error(`This ${this.kind} is still used (${this.users} times): free its users first.`);
    this.module.call[call]!(this.#handle);
    this.#handle = 0;
    return true;
  }
}
