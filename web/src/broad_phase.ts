import { Owned } from "./module.js";
import type { Orchard } from "./orchard.js";

/** A body of a world. Indices are used again, with another generation. */
export interface Body {
  readonly index: number;
  readonly generation: number;
}

/** Two bodies may be a pair if each one's mask has a bit of the other's category; of two with the same group, unless it
 * is 0: always if it is positive, never if it is negative. */
export interface BodyFilter {
  category?: number;
  mask?: number;
  group?: number;
  /** No pairs with static bodies. */
  ignoresStatic?: boolean;
}

/** Of the bodies asked about: those whose category has a bit of `mask` and whose mask has one of `category`. */
export interface QueryFilter {
  category?: number;
  mask?: number;
}

/** Where the fields of a motion are in its row of 13 numbers. What a source leaves as it is: at rest at the origin for
 * ever, with the radius 0. */
export const MOTION = {
  position: 0,
  velocity: 3,
  radius: 6,
  /** M: a bound on the length of the acceleration until the expiry. */
  acceleration: 7,
  /** A bound on how wrong the velocity is. */
  drift: 8,
  halfSpace: 9,
  /** Until when the bounds hold; Infinity at first. */
  expiry: 12,
} as const;

/** Fills row i (13 numbers, see MOTION) of `motions` with what is known of body bodies[i] at `time`. Both arrays are the
 * module's: they are valid during the call only. A source must not call the module. */
export type MotionSource = (time: number, bodies: Uint32Array, motions: Float64Array) => void;

export interface BroadPhaseOptions {
  /** Seconds; 1/60 by default. */
  timeStep?: number;
  start?: number;
  /** Steps that a window lasts; by default as it chooses. */
  window?: number;
  positionSlack?: number;
  /** For debugging: compare every motion with the bounds given before. */
  validate?: boolean;
}

export interface WorkBudget {
  /** Motions asked for. */
  work?: number;
  microseconds?: number;
}

export interface Advance {
  /** Of the step that the pairs are of; without pairs: nothing touches before. */
  time: number;
  /** Two indices of bodies for each pair, ascending. */
  pairs: Uint32Array;
  /** Bodies whose motions were not valid. */
  refused: Uint32Array;
  /** The highest class of importance that is incomplete; 256: the budget did not interrupt. */
  incompleteFrom: number;
  leftOver: number;
  work: number;
  /** The time is not finite or too far away: nothing was done. */
  timeRefused: boolean;
}

const ALL = 0xffffffff;
export const filterRow = (filter: BodyFilter = {}): number[] =>
  [filter.category ?? 1, filter.mask ?? ALL, filter.group ?? 0, filter.ignoresStatic ? 1 : 0];
export const queryRow = (filter: QueryFilter = {}): number[] => [filter.category ?? ALL, filter.mask ?? ALL];
export const bodyOf = (row: ArrayLike<number>, i = 0): Body => ({ index: row[i]!, generation: row[i + 1]! });

const NO_BODY = 0xffffffff;
/** A body that a world has just added, or the error. */
export function added(row: ArrayLike<number>): Body {
  if (row[0] === NO_BODY) throw new RangeError("The body was refused: its shapes, poses or options are not valid.");
  return bodyOf(row);
}

/** Which bounding spheres of moving bodies overlap, and until when nothing can: space-time bounds. */
export class BroadPhase extends Owned {
  readonly #source: number;

  /** Without a source there can be static bodies only. */
  constructor(orchard: Orchard, source?: MotionSource, options: BroadPhaseOptions = {}) {
    const { module } = orchard;
    Owned.needWorlds(module);
    const { timeStep = 1 / 60, start = 0, window = 0, positionSlack = 0, validate = false } = options;
    const number = source ? module.addSource(source) : 0;
    const row = module.write([timeStep, start, window, positionSlack, validate ? 1 : 0]);
    super(module, module.call.broad_new!(number, source ? 1 : 0, row) >>> 0, "broad phase");
    this.#source = number;
    if (module.call.broad_valid!(this.handle) === 0) {
      this.free();
      throw new RangeError("The options of the broad phase are not valid: the time step must be above 0, all of them finite.");
    }
  }

  get size(): number {
    return this.module.call.broad_size!(this.handle);
  }
  /** Nothing happens before; may be Infinity. */
  get nextTime(): number {
    return this.module.call.broad_next_time!(this.handle);
  }
  /** Motions that sources were asked for so far. */
  get motionsAsked(): number {
    return this.#count(0);
  }
  /** Found by the option `validate`. */
  get motionBoundViolations(): number {
    return this.#count(1);
  }
  get memoryBytes(): number {
    return this.#count(2);
  }

  /** A body that the source is asked about. Importance: 0, the highest class, to 255. */
  add(importance = 0, filter?: BodyFilter): Body {
    this.module.call.broad_add!(this.handle, importance, this.module.write(filterRow(filter)), this.module.out);
    return added(this.module.answer(2));
  }
  /** A body that stays where its motion (a row, see MOTION) says. */
  addStatic(motion: ArrayLike<number>, importance = 0, filter?: BodyFilter): Body {
    const row = this.module.write(motion, filterRow(filter));
    this.module.call.broad_add_static!(this.handle, importance, row, this.module.out);
    return added(this.module.answer(2));
  }
  /** True, or false if there is no such body; so do the following. */
  remove(body: Body): boolean {
    return this.module.call.broad_remove!(this.handle, body.index, body.generation) === 1;
  }
  /** The bounds that the source gave hold no longer: it is asked again. */
  cancel(body: Body): boolean {
    return this.module.call.broad_cancel!(this.handle, body.index, body.generation) === 1;
  }
  moveStatic(body: Body, motion: ArrayLike<number>): boolean {
    const row = this.module.write(motion);
    return this.module.call.broad_move_static!(this.handle, body.index, body.generation, row) === 1;
  }
  setImportance(body: Body, importance: number): boolean {
    return this.module.call.broad_set_importance!(this.handle, body.index, body.generation, importance) === 1;
  }
  setFilter(body: Body, filter: BodyFilter): boolean {
    const row = this.module.write(filterRow(filter));
    return this.module.call.broad_set_filter!(this.handle, body.index, body.generation, row) === 1;
  }

  /** The first step up to `time` that has pairs; to be called again with the same time until it has none. Throws what the
   * source throws; the report is lost then. */
  advance(time: number, budget: WorkBudget = {}): Advance {
    const { work = Infinity, microseconds = Infinity } = budget;
    const { module } = this;
    module.withSource(() => module.call.broad_advance!(this.handle, time, work, microseconds, module.out));
    const row = module.answer(10);
    return {
      time: row[0]!,
      pairs: module.integers(row[1]!, row[2]! * 2).slice(),
      refused: module.integers(row[3]!, row[4]!).slice(),
      incompleteFrom: row[5]!,
      leftOver: row[6]!,
      work: row[7]!,
      timeRefused: row[8] !== 0,
    };
  }
  /** Leaves out the steps before the last one that is not after `time`, for after a pause; returns how many. */
  skipTo(time: number): number {
    return this.module.withSource(() => this.module.call.broad_skip_to!(this.handle, time));
  }

  /** The time that queries are about: that of the last step reported. */
  get queryTime(): number {
    return this.module.call.broad_query_time!(this.handle);
  }
  /** The first bounding sphere that a ray enters, at origin + along * direction. */
  firstHit(origin: ArrayLike<number>, direction: ArrayLike<number>, longest = Infinity, filter?: QueryFilter):
      { body: number; along: number } | undefined {
    const row = this.module.write(origin, direction, [longest], queryRow(filter));
    const { module } = this;
    if (module.withSource(() => module.call.broad_first_hit!(this.handle, row, module.out)) !== 1) return undefined;
    const answer = module.answer(2);
    return { body: answer[0]!, along: answer[1]! };
  }
  /** Indices of the bodies whose spheres touch a sphere. */
  touchingSphere(center: ArrayLike<number>, radius: number, filter?: QueryFilter): Uint32Array {
    return this.#bodies("broad_touching_sphere", center, [radius], queryRow(filter));
  }
  touchingBox(lower: ArrayLike<number>, upper: ArrayLike<number>, filter?: QueryFilter): Uint32Array {
    return this.#bodies("broad_touching_box", lower, upper, queryRow(filter));
  }

  free(): void {
    if (this.release("broad_free")) this.module.removeSource(this.#source);
  }

  #count(which: number): number {
    this.module.call.broad_counts!(this.handle, this.module.out);
    return this.module.answer(3)[which]!;
  }
  #bodies(call: string, ...rows: ArrayLike<number>[]): Uint32Array {
    const { module } = this;
    return module.lend(Math.max(this.size, 1) * 4, (address) => {
      const row = module.write(...rows);
      const found = module.withSource(() => module.call[call]!(this.handle, row, address, this.size) >>> 0);
      if (found === ALL) throw new RangeError("A query of the broad phase needs numbers that are finite.");
      return module.integers(address, found).slice();
    });
  }
}
