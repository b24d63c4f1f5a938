import { BroadPhase, Detector, MOTION, poseOf, STATE, type Body, type Frame, type Orchard, type Tree } from "orchard-runtime";
import { NaiveHash } from "./hash.js";

export const COUNT = 1000;
export const TIME_STEP = 1 / 60;

/** What a step took, and what it found. */
export interface StepReport {
  /** Milliseconds: overlaps by space-time bounds, the same by the hash, and exact answers by the detector. */
  bounds: number;
  hash: number;
  exact: number;
  overlaps: number;
  hashOverlaps: number;
  asked: number;
  contacts: number;
  possible: number;
}

/** The same numbers at each visit. */
function random(seed: number): () => number {
  return () => {
    seed = Math.imul(seed ^ (seed >>> 15), seed | 1);
    seed ^= seed + Math.imul(seed ^ (seed >>> 7), seed | 61);
    return ((seed ^ (seed >>> 14)) >>> 0) / 4294967296;
  };
}

/** Bodies that fly straight on and spin, until they touch a wall or each other. */
export class CrowdWorld {
  readonly half: number;
  readonly positions = new Float64Array(3 * COUNT);
  readonly quaternions = new Float64Array(4 * COUNT);
  readonly touching = new Uint8Array(COUNT);
  readonly #velocities = new Float64Array(3 * COUNT);
  readonly #axes = new Float64Array(3 * COUNT);
  readonly #rates = new Float64Array(COUNT);
  /** When and where each one's flight began. */
  readonly #since = new Float64Array(COUNT);
  readonly #origins = new Float64Array(3 * COUNT);
  readonly #hash = new NaiveHash(COUNT);
  readonly #broad: BroadPhase;
  readonly #detector: Detector;
  readonly #bodies: Body[] = [];
  readonly #broadBodies: Body[] = [];
  #steps = 0;
  #time = 0;

  /** `center` and `radius`: a ball that holds the tree's body. */
  constructor(orchard: Orchard, tree: Tree, center: readonly number[], readonly radius: number) {
    this.half = 18 * radius;
    const draw = random(1995), signed = () => 2 * draw() - 1;
    for (let i = 0; i < COUNT; ++i) {
      for (let k = 0; k < 3; ++k) {
        this.#origins[3 * i + k] = signed() * (this.half - radius);
        this.#velocities[3 * i + k] = signed() * 2.4 * radius;
      }
      const axis = [signed(), signed(), signed()], length = Math.hypot(...axis) || 1;
      this.#axes.set(axis.map((x) => x / length), 3 * i);
      this.#rates[i] = 0.3 + draw();
    }
    this.#broad = new BroadPhase(orchard, (time, bodies, motions) => {
      for (let i = 0; i < bodies.length; ++i) this.#motion(time, bodies[i]!, motions, 13 * i);
    }, { timeStep: TIME_STEP });
    this.#detector = new Detector(orchard, { timeStep: TIME_STEP, watch: false }, (time, bodies, states) => {
      for (let i = 0; i < bodies.length; ++i) this.#state(time, bodies[i]!, states, 23 * i);
    });
    const shape = this.#detector.addTree(tree);
    const part = { shape, local: poseOf(orchard, { translation: center.map((x) => -x) }) };
    for (let i = 0; i < COUNT; ++i) {
      this.#broadBodies.push(this.#broad.add());
      this.#bodies.push(this.#detector.addBody([part]));
    }
    this.#move();
  }

  /** One step, answered three times; `budget` limits the exact answers, in milliseconds. */
  step(budget: number): StepReport {
    this.#time = ++this.#steps * TIME_STEP;  // the very times that the run-time counts with
    this.#move();
    this.#bounce();
    const asked = this.#broad.motionsAsked;
    const start = performance.now();
    let overlaps = 0;  // a report is of the first step that has pairs, up to the time, and then of the next one
    for (let report = this.#broad.advance(this.#time); report.pairs.length > 0; report = this.#broad.advance(this.#time)) {
      overlaps = report.pairs.length / 2;
    }
    const bounds = performance.now();
    const hashOverlaps = this.#hash.pairs(this.positions, this.radius);
    const hash = performance.now();
    const frame = this.#detector.step(this.#time, { microseconds: 1000 * budget });
    const exact = performance.now();
    this.#respond(frame);
    return {
      bounds: bounds - start, hash: hash - bounds, exact: exact - hash,
      overlaps, hashOverlaps, asked: this.#broad.motionsAsked - asked,
      contacts: frame.events.filter((e) => e.verdict.answer === "yes" && e.change !== "end").length,
      possible: frame.events.filter((e) => e.change === "possible").length,
    };
  }

  free(): void {
    this.#broad.free();
    this.#detector.free();
  }

  #move(): void {
    for (let i = 0; i < COUNT; ++i) {
      const flown = this.#time - this.#since[i]!;
      for (let k = 0; k < 3; ++k) this.positions[3 * i + k] = this.#origins[3 * i + k]! + flown * this.#velocities[3 * i + k]!;
      this.#turn(i, this.#time, this.quaternions, 4 * i);
    }
  }
  /** w, x, y, z of a body's rotation. */
  #turn(i: number, time: number, to: Float64Array, at: number): void {
    const half = (this.#rates[i]! * time) / 2, s = Math.sin(half);
    to[at] = Math.cos(half);
    for (let k = 0; k < 3; ++k) to[at + 1 + k] = s * this.#axes[3 * i + k]!;
  }
  /** Changes the velocity from now on, and cancels the bounds that held before. */
  #redirect(i: number, velocity: readonly number[]): void {
    this.#origins.set(this.positions.subarray(3 * i, 3 * i + 3), 3 * i);
    this.#velocities.set(velocity, 3 * i);
    this.#since[i] = this.#time;
    this.#broad.cancel(this.#broadBodies[i]!);
    this.#detector.cancel(this.#bodies[i]!);
  }
  #bounce(): void {
    const wall = this.half - this.radius;
    for (let i = 0; i < COUNT; ++i) {
      const velocity = Array.from(this.#velocities.subarray(3 * i, 3 * i + 3));
      const mirrored = velocity.map((v, k) => {
        const x = this.positions[3 * i + k]!;
        return x * v > 0 && Math.abs(x) > wall ? -v : v;
      });
      if (mirrored.some((v, k) => v !== velocity[k])) this.#redirect(i, mirrored);
    }
  }
  /** Bodies that begin to touch exchange their velocities along the normal, as equal masses do. */
  #respond(frame: Frame): void {
    this.touching.fill(0);
    for (const { change, a, b, verdict } of frame.events) {
      if (verdict.answer !== "yes" || change === "end") continue;
      this.touching[a.index] = this.touching[b.index] = 1;
      const [i, j] = [3 * a.index, 3 * b.index];
      const between = [0, 1, 2].map((k) => this.positions[j + k]! - this.positions[i + k]!), length = Math.hypot(...between) || 1;
      const normal = between.map((x) => x / length);
      const closing = normal.reduce((sum, n, k) => sum + n * (this.#velocities[i + k]! - this.#velocities[j + k]!), 0);
      if (closing <= 0) continue;
      this.#redirect(a.index, normal.map((n, k) => this.#velocities[i + k]! - closing * n));
      this.#redirect(b.index, normal.map((n, k) => this.#velocities[j + k]! + closing * n));
    }
  }

  #motion(time: number, i: number, rows: Float64Array, at: number): void {
    const flown = time - this.#since[i]!;
    for (let k = 0; k < 3; ++k) {
      rows[at + MOTION.position + k] = this.#origins[3 * i + k]! + flown * this.#velocities[3 * i + k]!;
      rows[at + MOTION.velocity + k] = this.#velocities[3 * i + k]!;
    }
    rows[at + MOTION.radius] = this.radius;
  }
  #state(time: number, i: number, rows: Float64Array, at: number): void {
    const flown = time - this.#since[i]!, turn = this.#turned;
    this.#turn(i, time, turn, 0);
    const [w, x, y, z] = turn as unknown as [number, number, number, number];
    rows[at] = 1 - 2 * (y * y + z * z); rows[at + 1] = 2 * (x * y - w * z); rows[at + 2] = 2 * (x * z + w * y);
    rows[at + 3] = 2 * (x * y + w * z); rows[at + 4] = 1 - 2 * (x * x + z * z); rows[at + 5] = 2 * (y * z - w * x);
    rows[at + 6] = 2 * (x * z - w * y); rows[at + 7] = 2 * (y * z + w * x); rows[at + 8] = 1 - 2 * (x * x + y * y);
    for (let k = 0; k < 3; ++k) {
      rows[at + STATE.translation + k] = this.#origins[3 * i + k]! + flown * this.#velocities[3 * i + k]!;
      rows[at + STATE.velocity + k] = this.#velocities[3 * i + k]!;
    }
    rows[at + STATE.angularSpeed] = this.#rates[i]!;
  }
  readonly #turned = new Float64Array(4);
}
