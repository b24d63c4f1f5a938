import { manifoldOf, vectorAt, verdictAt, type Budget, type Manifold } from "./answers.js";
import { added, bodyOf, filterRow, queryRow, type Body, type BodyFilter, type QueryFilter } from "./broad_phase.js";
import type {
  BodyOptions, DetectorOptions, Frame, PairChange, PairEvent, Part, Shape, StateSource, WorldPoint,
} from "./detector_types.js";
import { Owned, STATE_NUMBERS } from "./module.js";
import type { Orchard } from "./orchard.js";
import { identity, type Pose } from "./pose.js";
import type { Tree } from "./tree.js";

const CHANGES: readonly PairChange[] = ["begin", "stay", "end", "possible"];

/** A world of bodies: who touches, begins or ceases to, or may, at each step, within a budget. */
export class Detector extends Owned {
  readonly #source: number;
  readonly #trees: Tree[] = [];

  /** Without a source the detector keeps the states and moves the bodies straight on: see setState. */
  constructor(orchard: Orchard, options: DetectorOptions = {}, source?: StateSource) {
    const { module } = orchard;
    Owned.needWorlds(module);
    const { timeStep = 1 / 60, start = 0, positionSlack = 0, watch } = options;
    if (!(timeStep > 0) || ![timeStep, start, positionSlack].every(Number.isFinite)) {
      throw new RangeError("The options of the detector are not valid: the time step must be above 0, all of them finite.");
    }
    const rest = [options.stepsToEnd, options.maxEvents];
    const number = source ? module.addSource(source) : 0;
    const watched = watch === undefined ? -1 : watch ? 1 : 0;
    const row = module.write([timeStep, start, positionSlack, watched], rest.map((value) => value ?? -1));
    super(module, module.call.detector_new!(number, source ? 1 : 0, row) >>> 0, "detector");
    this.#source = number;
  }

  /** Shapes, which any number of bodies share. */
  addTree(tree: Tree): Shape {
    const shape = this.#shape(this.module.call.detector_add_tree!(this.handle, tree.handle));
    tree.use(1);
    this.#trees.push(tree);
    return shape;
  }
  addSphere(radius: number, center: ArrayLike<number> = [0, 0, 0]): Shape {
    return this.#shape(this.module.call.detector_add_sphere!(this.handle, this.module.write(center, [radius])));
  }
  addCapsule(p: ArrayLike<number>, q: ArrayLike<number>, radius: number): Shape {
    return this.#shape(this.module.call.detector_add_capsule!(this.handle, this.module.write(p, q, [radius])));
  }
  /** Half the edges' lengths. */
  addBox(half: ArrayLike<number>): Shape {
    return this.#shape(this.module.call.detector_add_box!(this.handle, this.module.write(half)));
  }

  /** A body of one shape, or of parts, that moves. With a state it is there from now on (detectors without a source). */
  addBody(parts: Shape | readonly Part[], options: BodyOptions = {}, state?: ArrayLike<number>): Body {
    const body = this.#add("detector_add_body", parts, bodyRow(options));
    if (state) this.setState(body, state);
    return body;
  }
  addStatic(parts: Shape | readonly Part[], pose: Pose, options: BodyOptions = {}): Body {
    return this.#add("detector_add_static", parts, [...bodyRow(options), ...pose]);
  }
  /** The points with normal . x <= offset. */
  addHalfSpace(normal: ArrayLike<number>, offset: number, options: BodyOptions = {}): Body {
    const row = this.module.write(bodyRow(options), normal, [offset]);
    this.module.call.detector_add_half_space!(this.handle, row, this.module.out);
    return added(this.module.answer(2));
  }

  /** True, or false if there is no such body or what was handed over is not valid; so do the following. */
  remove(body: Body): boolean {
    return this.#change("detector_remove", body);
  }
  /** Cancels the motion bounds of the body. */
  cancel(body: Body): boolean {
    return this.#change("detector_cancel", body);
  }
  /** The body is somewhere else: it did not move there. */
  teleport(body: Body): boolean {
    return this.#change("detector_teleport", body);
  }
  sleep(body: Body): boolean {
    return this.#change("detector_sleep", body);
  }
  wake(body: Body): boolean {
    return this.#change("detector_wake", body);
  }
  moveStatic(body: Body, pose: Pose): boolean {
    return this.#change("detector_move_static", body, this.module.write(pose));
  }
  setLocal(body: Body, part: number, local: Pose): boolean {
    return this.#change("detector_set_local", body, part, this.module.write(local));
  }
  setImportance(body: Body, importance: number): boolean {
    return this.#change("detector_set_importance", body, importance);
  }
  setFilter(body: Body, filter: BodyFilter): boolean {
    return this.#change("detector_set_filter", body, this.module.write(filterRow(filter)));
  }
  /** Of detectors without a source: from the time of the last step on the body is there, and goes straight on. */
  setState(body: Body, state: ArrayLike<number>): boolean {
    return this.#change("detector_set_state", body, this.module.write(state));
  }
  setVelocity(body: Body, velocity: ArrayLike<number>): boolean {
    return this.#change("detector_set_velocity", body, this.module.write(velocity));
  }
  /** A row of 23 numbers, see STATE: at the last step without a source, else as of when it was asked for last. */
  state(body: Body, out = new Float64Array(STATE_NUMBERS)): Float64Array {
    this.module.call.detector_state!(this.handle, body.index, body.generation, this.module.out);
    out.set(this.module.answer(STATE_NUMBERS));
    return out;
  }
  get size(): number {
    return this.module.call.detector_size!(this.handle);
  }

  /** Answers every step up to `time`; with `latestOnly` the last one alone, for after a pause. Throws what the source
   * throws; the report is lost then. */
  step(time: number, budget: Budget = {}, { latestOnly = false } = {}): Frame {
    const { tests = Infinity, microseconds = Infinity } = budget;
    const { module } = this;
    const latest = latestOnly ? 1 : 0;
    module.withSource(() => module.call.detector_step!(this.handle, time, tests, microseconds, latest, module.out));
    const row = module.answer(17).slice();
    const list = (count: number, call: string) =>
      Array.from({ length: count }, (_, i) => module.call[call]!(this.handle, i) >>> 0);
    return {
      time: row[0]!,
      nextTime: row[1]!,
      steps: row[2]!,
      events: Array.from({ length: row[3]! }, (_, i) => this.#event(i)),
      pairs: row[4]!,
      certain: row[5]!,
      work: row[6]!,
      motionsAsked: row[7]!,
      worstBound: row[8]!,
      incompleteFrom: row[9]!,
      leftOver: row[10]!,
      refused: list(row[11]!, "detector_refused"),
      broken: list(row[12]!, "detector_broken"),
      timeRefused: row[13] !== 0,
      stepsLeft: row[15]!,
      skipped: row[16]!,
    };
  }
  /** Where the two bodies of an event of the last step touch, and how they come apart. */
  manifold(event: PairEvent): Manifold {
    const { module } = this;
    module.withSource(() => module.call.detector_manifold!(this.handle, event.number, module.out));
    return manifoldOf(module.answer(32));
  }

  /** What a ray meets first, up to `longest` directions. Queries are about all bodies as of the last step. */
  castRay(origin: ArrayLike<number>, direction: ArrayLike<number>, longest = Infinity, filter?: QueryFilter):
      WorldPoint | undefined {
    return this.#point("detector_cast_ray", origin, direction, [longest], queryRow(filter));
  }
  /** The point of all surfaces nearest to a point, within `limit`. */
  nearest(point: ArrayLike<number>, limit = Infinity, filter?: QueryFilter): WorldPoint | undefined {
    return this.#point("detector_nearest", point, [limit], queryRow(filter));
  }
  /** The bodies that a solid sphere touches. */
  touchingSphere(center: ArrayLike<number>, radius: number, filter?: QueryFilter): Body[] {
    const { module } = this;
    return module.lend(this.size * 8, (address) => {
      const row = module.write(center, [radius], queryRow(filter));
      const found = module.withSource(() =>
        module.call.detector_touching_sphere!(this.handle, row, address, this.size) >>> 0);
      const bodies = module.integers(address, found * 2);
      return Array.from({ length: found }, (_, i) => bodyOf(bodies, 2 * i));
    });
  }

  free(): void {
    if (!this.release("detector_free")) return;
    this.module.removeSource(this.#source);
    for (const tree of this.#trees.splice(0)) tree.use(-1);
  }

  #shape(number: number): Shape {
    if (number >>> 0 === 0xffffffff) throw new RangeError("The shape was refused: its lengths must be finite and above 0.");
    return (number >>> 0) as Shape;
  }
  #add(call: string, parts: Shape | readonly Part[], row: number[]): Body {
    const list: readonly Part[] = typeof parts === "number" ? [{ shape: parts }] : parts;
    const { module } = this;
    const numbers = [...row, ...list.flatMap((part) => [part.shape, ...(part.local ?? identity())])];
    return module.lend(numbers.length * 8, (address) => {
      module.numbers(address, numbers.length).set(numbers);
      module.call[call]!(this.handle, address, list.length, module.out);
      return added(module.answer(2));
    });
  }
  #change(call: string, body: Body, ...rest: number[]): boolean {
    return this.module.call[call]!(this.handle, body.index, body.generation, ...rest) === 1;
  }
  #event(number: number): PairEvent {
    this.module.call.detector_event!(this.handle, number, this.module.out);
    const row = this.module.answer(26);
    return {
      change: CHANGES[row[0]!]!,
      a: bodyOf(row, 1),
      b: bodyOf(row, 3),
      partA: row[5]!,
      partB: row[6]!,
      time: row[7]!,
      impactFrom: row[8]!,
      impactTo: row[9]!,
      verdict: verdictAt(row.subarray(10)),
      number,
    };
  }
  #point(call: string, ...rows: ArrayLike<number>[]): WorldPoint | undefined {
    const { module } = this;
    const row = module.write(...rows);
    if (module.withSource(() => module.call[call]!(this.handle, row, module.out)) !== 1) return undefined;
    const answer = module.answer(8);
    return {
      body: bodyOf(answer),
      part: answer[2]!,
      triangle: answer[3]!,
      distance: answer[4]!,
      point: vectorAt(answer, 5),
    };
  }
}

const bodyRow = (options: BodyOptions): number[] =>
  [options.importance ?? 0, ...filterRow(options), options.continuousSpeed ?? 0, options.reach ?? 0, 0];
