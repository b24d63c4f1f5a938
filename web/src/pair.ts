import {
  answerOf, distanceAt, manifoldOf, vectorAt, verdictAt,
  type Answer, type Budget, type Distance, type Manifold, type SignedDistance, type Verdict,
} from "./answers.js";
import { DISTANCE_NUMBERS, Owned, POSE_NUMBERS, VERDICT_NUMBERS } from "./module.js";
import type { Pose } from "./pose.js";
import type { Tree } from "./tree.js";

/** Queries about two trees, whose memory is reserved once: no query allocates. The poses are those of a and of b. */
export class Pair extends Owned {
  constructor(readonly a: Tree, readonly b: Tree) {
    if (a.module !== b.module) throw new Error("The trees of a pair must belong to the same orchard.");
    super(a.module, a.module.call.pair_new!(a.handle, b.handle) >>> 0, "pair");
    a.use(1);
    b.use(1);
  }

  /** The whole question, the triangles first, as far as the budget goes: yes or no without one. */
  collide(poseA: Pose, poseB: Pose, budget: Budget = {}): Verdict {
    const { tests = Infinity, microseconds = Infinity } = budget;
    const row = this.module.write(poseA, poseB);
    this.module.call.pair_collide!(this.handle, row, tests, microseconds, this.module.out);
    return this.#verdict();
  }
  /** The yes and no of collide() for less, for a pair that moves a little between calls. */
  collideAgain(poseA: Pose, poseB: Pose): Verdict {
    this.module.call.pair_collide_again!(this.handle, this.module.write(poseA, poseB), this.module.out);
    return this.#verdict();
  }
  /** Begins level by level, with the roots. */
  start(poseA: Pose, poseB: Pose): Verdict {
    this.module.call.pair_start!(this.handle, this.module.write(poseA, poseB), this.module.out);
    return this.#verdict();
  }
  /** Goes on to the end of the next level or of the budget; the next call continues there. */
  refine(budget: Budget = {}): Verdict {
    const { tests = Infinity, microseconds = Infinity } = budget;
    this.module.call.pair_refine!(this.handle, tests, microseconds, this.module.out);
    return this.#verdict();
  }
  /** Until upper <= (1 + tolerance) * lower, but for rounding. */
  distance(poseA: Pose, poseB: Pose, tolerance = 0): Distance {
    this.module.call.pair_distance!(this.handle, this.module.write(poseA, poseB), tolerance, this.module.out);
    return distanceAt(this.module.answer(DISTANCE_NUMBERS));
  }

  free(): void {
    if (!this.release("pair_free")) return;
    this.a.use(-1);
    this.b.use(-1);
  }

  #verdict(): Verdict {
    return verdictAt(this.module.answer(VERDICT_NUMBERS));
  }
}

/** Whether the surfaces are within `margin` of each other; `maybe` if the poses are refused. */
export function closerThan(a: Tree, poseA: Pose, b: Tree, poseB: Pose, margin: number): Answer {
  return answerOf(a.module.call.closer_than!(a.handle, b.handle, a.module.write(poseA, poseB), margin));
}

/** Where two bodies touch, and how they come apart. With a margin, surfaces so near have a point before they touch. */
export function contacts(a: Tree, poseA: Pose, b: Tree, poseB: Pose, margin = 0): Manifold {
  a.module.call.contacts!(a.handle, b.handle, a.module.write(poseA, poseB), margin, a.module.out);
  return manifoldOf(a.module.answer(32));
}

/** The distance, negative where the surfaces meet: minus the depth of the manifold. */
export function signedDistance(a: Tree, poseA: Pose, b: Tree, poseB: Pose, tolerance = 0): SignedDistance {
  a.module.call.signed_distance!(a.handle, b.handle, a.module.write(poseA, poseB), tolerance, a.module.out);
  const row = a.module.answer(11);
  return {
    lower: row[0]!,
    upper: row[1]!,
    onA: vectorAt(row, 2),
    onB: vectorAt(row, 5),
    normal: vectorAt(row, 8),
  };
}

/** One tree for all pairs, or one for each. */
export type Trees = Tree | readonly Tree[];

/** Pair i of a batch is a[i] at the i-th pose of posesA, and b[i] at that of posesB; a pose is 13 numbers. Returns rows
 * of 16 numbers, in `out` if it is given: `verdictAt(rows, i)` reads one. */
export function collideAll(
  a: Trees, posesA: Float64Array, b: Trees, posesB: Float64Array,
  out = new Float64Array((posesA.length / POSE_NUMBERS) * VERDICT_NUMBERS),
): Float64Array {
  batch(a, posesA, b, posesB, VERDICT_NUMBERS * 8, (module, count, trees, rows, to) => {
    module.call.collide_all!(trees[0], rows[0], trees[1], rows[1], count, to);
    out.set(module.numbers(to, count * VERDICT_NUMBERS));
  });
  return out;
}

/** The same of `distance`, in rows of 10 numbers: `distanceAt(rows, i)` reads one. */
export function distanceAll(
  a: Trees, posesA: Float64Array, b: Trees, posesB: Float64Array, tolerance = 0,
  out = new Float64Array((posesA.length / POSE_NUMBERS) * DISTANCE_NUMBERS),
): Float64Array {
  batch(a, posesA, b, posesB, DISTANCE_NUMBERS * 8, (module, count, trees, rows, to) => {
    module.call.distance_all!(trees[0], rows[0], trees[1], rows[1], count, tolerance, to);
    out.set(module.numbers(to, count * DISTANCE_NUMBERS));
  });
  return out;
}

/** The same of `closerThan`: 1 for yes, 0 for no, -1 for maybe. */
export function closerThanAll(
  a: Trees, posesA: Float64Array, b: Trees, posesB: Float64Array, margin: number,
  out = new Int32Array(posesA.length / POSE_NUMBERS),
): Int32Array {
  batch(a, posesA, b, posesB, 4, (module, count, trees, rows, to) => {
    module.call.closer_than_all!(trees[0], rows[0], trees[1], rows[1], count, margin, to);
    out.set(new Int32Array(module.bytes(to, count * 4).slice().buffer));
  });
  return out;
}

type Ask = (module: Tree["module"], count: number, trees: [number, number], rows: [number, number], to: number) => void;

function batch(a: Trees, posesA: Float64Array, b: Trees, posesB: Float64Array, answerBytes: number, ask: Ask): void {
  const count = posesA.length / POSE_NUMBERS;
  if (!Number.isInteger(count) || posesB.length !== posesA.length) {
    throw new RangeError("A batch needs as many poses of a as of b, of 13 numbers each.");
  }
  const lists = [a, b].map((trees) => (Array.isArray(trees) ? trees : Array<Tree>(count).fill(trees as Tree)));
  if (lists.some((list) => list.length !== count)) throw new RangeError("A batch needs one tree, or one for each pair.");
  if (count === 0) return;
  const { module } = lists[0]![0]!;
  if (lists.some((list) => list.some((tree) => tree.module !== module))) {
    throw new Error("The trees of a batch must belong to the same orchard.");
  }
  const rowBytes = posesA.length * 8;
  module.lend(2 * rowBytes + count * (answerBytes + 8), (address: number) => {
    const to = address + 2 * rowBytes, handles = to + count * answerBytes;
    module.numbers(address, posesA.length).set(posesA);
    module.numbers(address + rowBytes, posesB.length).set(posesB);
    module.integers(handles, count).set(lists[0]!.map((tree) => tree.handle));
    module.integers(handles + count * 4, count).set(lists[1]!.map((tree) => tree.handle));
    ask(module, count, [handles, handles + count * 4], [address, address + rowBytes], to);
  });
}
