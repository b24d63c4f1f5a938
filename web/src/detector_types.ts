import type { Vector, Verdict } from "./answers.js";
import type { Body, BodyFilter } from "./broad_phase.js";
import { STATE_NUMBERS } from "./module.js";
import { identity, type Pose } from "./pose.js";

/** Where the fields of a body's state are in its row of 23 numbers. What is left as it is: at rest at the origin. */
export const STATE = {
  /** 13 numbers, see Pose. */
  pose: 0,
  translation: 9,
  velocity: 13,
  /** M: a bound on the length of the acceleration until the expiry. */
  acceleration: 16,
  drift: 17,
  halfSpace: 18,
  /** Until when the bounds hold; Infinity at first. */
  expiry: 21,
  /** An upper bound on the angular speed, in radians per second; NaN: there is no bound. */
  angularSpeed: 22,
} as const;

/** A row of a body at rest at the origin for ever, to be changed at STATE. */
export function restingState(): Float64Array {
  const row = new Float64Array(STATE_NUMBERS);
  row.set(identity());
  row[STATE.expiry] = Infinity;
  row[STATE.angularSpeed] = NaN;
  return row;
}

/** Fills row i (23 numbers, see STATE) of `states` with that of body bodies[i] at `time`. Both arrays are the module's:
 * they are valid during the call only. A source must not call the module. */
export type StateSource = (time: number, bodies: Uint32Array, states: Float64Array) => void;

declare const shapeOf: unique symbol;
/** A shape of one detector. */
export type Shape = number & { readonly [shapeOf]: true };
export interface Part {
  shape: Shape;
  /** In the body's frame; the identity by default. */
  local?: Pose;
}

export interface BodyOptions extends BodyFilter {
  /** 0, the highest class, to 255. */
  importance?: number;
  /** Above 0: contacts between two steps are found as well, for a body of at most this speed. */
  continuousSpeed?: number;
  /** How far the body reaches from its origin; as far as its parts by default. */
  reach?: number;
}

export interface DetectorOptions {
  /** Seconds; 1/60 by default. */
  timeStep?: number;
  start?: number;
  positionSlack?: number;
  /** Whether every step compares each moving body with its motion bounds; by default with a source only. */
  watch?: boolean;
  stepsToEnd?: number;
  /** A call of step() ends early once it has so many events. */
  maxEvents?: number;
}

export type PairChange = "begin" | "stay" | "end" | "possible";

export interface PairEvent {
  change: PairChange;
  a: Body;
  b: Body;
  partA: number;
  partB: number;
  time: number;
  /** Of continuous bodies: the contact was between these times; NaN otherwise. */
  impactFrom: number;
  impactTo: number;
  verdict: Verdict;
  /** Its place among the events of the step, for manifold(). */
  number: number;
}

export interface Frame {
  time: number;
  /** Nothing begins or ends before. */
  nextTime: number;
  steps: number;
  events: PairEvent[];
  /** Pairs whose spheres overlap, and those of them with a certain answer. */
  pairs: number;
  certain: number;
  /** Pair tests. */
  work: number;
  /** States that were asked for. */
  motionsAsked: number;
  worstBound: number;
  /** 256: the broad phase was not interrupted. */
  incompleteFrom: number;
  leftOver: number;
  /** The indices of bodies whose states were not valid, and of those that exceeded their motion bounds. */
  refused: number[];
  broken: number[];
  timeRefused: boolean;
  /** Not 0: maxEvents ended the call, and another one with the same time goes on. */
  stepsLeft: number;
  skipped: number;
}

export interface WorldPoint {
  body: Body;
  part: number;
  triangle: number;
  /** Along a ray: in lengths of its direction. */
  distance: number;
  point: Vector;
}
