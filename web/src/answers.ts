/** `no`: the surfaces do not touch, certain. `yes`: a triangle of one meets a triangle of the other. `maybe`: not known
 * so far. */
export type Answer = "no" | "maybe" | "yes";
export const ANSWERS: readonly Answer[] = ["no", "maybe", "yes"];

export type Vector = [number, number, number];

/** Limits of one call, which stops at the first one that it reaches. What is left out does not limit. */
export interface Budget {
  /** Pair tests: the same number gives the same answer on every machine. */
  tests?: number;
  /** As exact as the clock: browsers round it to 5 or 100 microseconds. */
  microseconds?: number;
}

/** Everything in a verdict is certain, however early a budget ended the query. */
export interface Verdict {
  answer: Answer;
  /** The solids are no farther apart; may be Infinity. */
  separationBound: number;
  /** The surfaces are no nearer; 0 if nothing is known. */
  lowerBound: number;
  /** A ball that the contact lies in if there is one, and a guess of the normal from a to b. */
  contact: { center: Vector; radius: number; normal: Vector };
  /** Of `yes`: triangles that meet. */
  triangles: [number, number] | null;
  /** The level of spheres that is decided, from 0 for the roots. */
  level: number;
  /** Refining changes nothing any more. */
  finished: boolean;
  /** The poses are not rigid, or too far apart or too different in scale: nothing is known. */
  refused: boolean;
  /** Pair tests since the start; as a budget it repeats a run that time cut short. */
  tests: number;
}

/** lower <= distance of the surfaces <= upper, with a point on each at the distance `upper`. */
export interface Distance {
  lower: number;
  upper: number;
  onA: Vector;
  onB: Vector;
  triangles: [number, number] | null;
}

/** As Distance; where the surfaces meet it is negative, and b leaves a when it is moved so far along the normal. */
export interface SignedDistance {
  lower: number;
  upper: number;
  onA: Vector;
  onB: Vector;
  normal: Vector;
}

export interface ContactPoint {
  point: Vector;
  triangles: [number, number];
  /** How far b moves along the normal until these two triangles are apart. */
  depth: number;
}

/** Where two bodies touch, and how they come apart. */
export interface Manifold {
  answer: Answer;
  /** Up to four. */
  points: ContactPoint[];
  /** From a to b. */
  normal: Vector;
  /** b moved so far along the normal touches a no more. */
  depth: number;
  /** `maybe`: the radius of a ball around the only point, which is a guess. */
  error: number;
  complete: boolean;
}

const NO_TRIANGLE = 0xffffffff;

export const vectorAt = (row: ArrayLike<number>, i: number): Vector => [row[i]!, row[i + 1]!, row[i + 2]!];
const trianglesAt = (row: ArrayLike<number>, i: number): [number, number] | null =>
  row[i] === NO_TRIANGLE || row[i + 1] === NO_TRIANGLE ? null : [row[i]!, row[i + 1]!];

/** The verdict number `index` of the rows that `collideAll` fills. */
export function verdictAt(rows: ArrayLike<number>, index = 0): Verdict {
  const i = index * 16;
  return {
    answer: ANSWERS[rows[i]!]!,
    separationBound: rows[i + 1]!,
    lowerBound: rows[i + 2]!,
    contact: { center: vectorAt(rows, i + 3), radius: rows[i + 6]!, normal: vectorAt(rows, i + 7) },
    triangles: trianglesAt(rows, i + 10),
    level: rows[i + 12]!,
    finished: rows[i + 13] !== 0,
    refused: rows[i + 14] !== 0,
    tests: rows[i + 15]!,
  };
}

/** The distance number `index` of the rows that `distanceAll` fills. */
export function distanceAt(rows: ArrayLike<number>, index = 0): Distance {
  const i = index * 10;
  return {
    lower: rows[i]!,
    upper: rows[i + 1]!,
    onA: vectorAt(rows, i + 2),
    onB: vectorAt(rows, i + 5),
    triangles: trianglesAt(rows, i + 8),
  };
}

export function manifoldOf(row: ArrayLike<number>): Manifold {
  const points = Array.from({ length: row[1]! }, (_, k) => {
    const i = 8 + 6 * k;
    return { point: vectorAt(row, i), triangles: [row[i + 3]!, row[i + 4]!] as [number, number], depth: row[i + 5]! };
  });
  return {
    answer: ANSWERS[row[0]!]!,
    points,
    normal: vectorAt(row, 2),
    depth: row[5]!,
    error: row[6]!,
    complete: row[7] !== 0,
  };
}

/** 1, 0 or -1 of the module. */
export const answerOf = (number: number): Answer => (number === 1 ? "yes" : number === 0 ? "no" : "maybe");
