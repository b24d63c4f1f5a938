/** What a .ma file holds: balls, and the edges and triangles between them (docs/reference/formats.md of orchard). */
export interface MedialAxis {
  centers: Float32Array;
  radii: Float32Array;
  edges: Uint32Array;
  triangles: Uint32Array;
  /** The part of the structure that each triangle is in; without a structure section all are in part 0. */
  sheets: Uint32Array;
  /** Edges of the structure, two vertices each. */
  lines: Record<"seam" | "border" | "curve", number[]>;
}

/** A file that is no medial axis, with the line and the reason. */
export class MedialError extends Error {}

interface Line { words: string[]; number: number }

function* linesOf(text: string): Generator<Line> {
  let number = 0;
  for (const line of text.split(/\r?\n/)) {
    ++number;
    const words = line.trim().split(/\s+/);
    if (words[0] !== "" && !words[0]!.startsWith("#")) yield { words, number };
  }
}

class Reader {
  readonly #lines: Generator<Line>;
  #number = 0;
  constructor(text: string) { this.#lines = linesOf(text); }
  next(what: string): string[] {
    const { value, done } = this.#lines.next();
    if (done) throw new MedialError(`The file ends after line ${this.#number}, where ${what} should follow. It was cut off?`);
    this.#number = value.number;
    return value.words;
  }
  /** Undefined at the end of the file. */
  more(): string[] | undefined {
    const { value, done } = this.#lines.next();
    return done ? undefined : value.words;
  }
  number(word: string | undefined, what: string): number {
    const value = Number(word);
    if (word === undefined || !Number.isFinite(value)) this.fail(`${what} should be a number, not "${word ?? ""}"`);
    return value;
  }
  index(word: string | undefined, count: number, what: string): number {
    const value = this.number(word, what);
    if (!Number.isInteger(value) || value < 0 || value >= count) this.fail(`${what} should be from 0 to ${count - 1}, not ${word}`);
    return value;
  }
  fail(why: string): never { throw new MedialError(`Line ${this.#number}: ${why}.`); }
}

const MOST = 20_000_000;

/** Reads a .ma file; flags at the ends of lines are skipped, but for cells that are deleted. Throws a MedialError. */
export function readMedialAxis(text: string): MedialAxis {
  const reader = new Reader(text);
  const head = reader.next("the numbers of vertices, edges and triangles");
  if (head.length < 3) reader.fail("a .ma file begins with the numbers of vertices, edges and triangles");
  const [vertices, edges, faces] = [0, 1, 2].map((i) => reader.index(head[i], MOST, "A number of cells")) as [number, number, number];
  const centers: number[] = [], radii: number[] = [], lines: number[] = [], triangles: number[] = [];
  for (let i = 0; i < vertices; ++i) {
    const words = reader.next(`vertex ${i}`);
    if (words[0] !== "v") reader.fail(`vertex ${i} should begin with "v"`);
    const [x, y, z, r] = [1, 2, 3, 4].map((k) => reader.number(words[k], "A coordinate or radius")) as [number, number, number, number];
    if (r < 0) reader.fail("a radius should not be negative");
    centers.push(x, y, z);
    radii.push(r);
  }
  for (let i = 0; i < edges; ++i) {
    const words = reader.next(`edge ${i}`);
    if (words[0] !== "e") reader.fail(`edge ${i} should begin with "e"`);
    lines.push(...[1, 2].map((k) => reader.index(words[k], vertices, "A vertex of an edge")));
  }
  for (let i = 0; i < faces; ++i) {
    const words = reader.next(`triangle ${i}`);
    if (words[0] !== "f") reader.fail(`triangle ${i} should begin with "f"`);
    triangles.push(...[1, 2, 3].map((k) => reader.index(words[k], vertices, "A vertex of a triangle")));
  }
  const axis: MedialAxis = {
    centers: Float32Array.from(centers), radii: Float32Array.from(radii), edges: Uint32Array.from(lines),
    triangles: Uint32Array.from(triangles), sheets: new Uint32Array(faces), lines: { seam: [], border: [], curve: [] },
  };
  addStructure(axis, reader);
  return axis;
}

/** The structure section after the triangles, where there is one: each part's number, kind and cells. */
function addStructure(axis: MedialAxis, reader: Reader): void {
  const words: number[] = [];
  for (let line = reader.more(); line; line = reader.more()) words.push(...line.map(Number));
  if (words.length === 0 || words.some((word) => !Number.isInteger(word) || word < 0)) return;
  const kinds = { 1: "seam", 2: "border", 4: "curve" } as const;
  for (let place = 1; place + 2 < words.length;) {
    const [number, kind, count] = words.slice(place, place + 3) as [number, number, number];
    for (const cell of words.slice(place + 3, place + 3 + count)) {
      if (kind === 0 && cell < axis.sheets.length) axis.sheets[cell] = number;
      const name = kinds[kind as 1 | 2 | 4];
      if (name && 2 * cell + 1 < axis.edges.length) axis.lines[name].push(axis.edges[2 * cell]!, axis.edges[2 * cell + 1]!);
    }
    place += 3 + count;
  }
}

/** The thickness of the solid at each triangle: the diameter of its ball where the two walls that it touches face each
 * other, at 120 degrees or more as seen from its centre; NaN elsewhere. A ball's radius changes along a sheet by the cosine
 * of half that angle. */
export function thicknessOf({ centers, radii, triangles }: MedialAxis): Float32Array {
  const result = new Float32Array(triangles.length / 3).fill(NaN);
  for (let t = 0; t < result.length; ++t) {
    const [a, b, c] = [0, 1, 2].map((k) => triangles[3 * t + k]!) as [number, number, number];
    const side = (p: number, q: number) => [0, 1, 2].map((k) => centers[3 * q + k]! - centers[3 * p + k]!);
    const dot = (p: number[], q: number[]) => p[0]! * q[0]! + p[1]! * q[1]! + p[2]! * q[2]!;
    const u = side(a, b), v = side(a, c), uu = dot(u, u), uv = dot(u, v), vv = dot(v, v);
    const du = radii[b]! - radii[a]!, dv = radii[c]! - radii[a]!, area = uu * vv - uv * uv;
    const slope2 = area > 0 ? (du * du * vv - 2 * du * dv * uv + dv * dv * uu) / area : 1;
    if (slope2 <= 0.25) result[t] = (2 / 3) * (radii[a]! + radii[b]! + radii[c]!);
  }
  return result;
}
