/** The measure for space-time bounds: a spatial hash that is rebuilt from all positions at each step, as games have it. A
 * cell is as wide as the largest body, bodies are sorted by cell, and each is compared with those of half of the neighbours.
 * Arrays are reused; nothing is allocated in a step. */
export class NaiveHash {
  readonly #heads: Int32Array;
  readonly #next: Int32Array;
  readonly #cells: Int32Array;
  readonly #mask: number;

  constructor(private readonly count: number) {
    const slots = 2 ** Math.ceil(Math.log2(2 * count));
    this.#heads = new Int32Array(slots);
    this.#next = new Int32Array(count);
    this.#cells = new Int32Array(3 * count);
    this.#mask = slots - 1;
  }

  /** How many pairs of bounding spheres overlap. Positions are three numbers each, radii are all the same. */
  pairs(positions: Float64Array, radius: number): number {
    const heads = this.#heads.fill(-1), next = this.#next, cells = this.#cells, scale = 1 / (2 * radius);
    for (let i = 0; i < this.count; ++i) {
      const x = Math.floor(positions[3 * i]! * scale), y = Math.floor(positions[3 * i + 1]! * scale), z = Math.floor(positions[3 * i + 2]! * scale);
      cells[3 * i] = x;
      cells[3 * i + 1] = y;
      cells[3 * i + 2] = z;
      const slot = this.#slot(x, y, z);
      next[i] = heads[slot]!;
      heads[slot] = i;
    }
    let found = 0;
    for (let i = 0; i < this.count; ++i) {
      for (let n = 0; n < 14; ++n) {  // the own cell, and half of the 26 around it
        const x = cells[3 * i]! + OFFSETS[3 * n]!, y = cells[3 * i + 1]! + OFFSETS[3 * n + 1]!, z = cells[3 * i + 2]! + OFFSETS[3 * n + 2]!;
        for (let j = heads[this.#slot(x, y, z)]!; j >= 0; j = next[j]!) {
          if (n === 0 && j <= i) continue;
          if (cells[3 * j] !== x || cells[3 * j + 1] !== y || cells[3 * j + 2] !== z) continue;
          const dx = positions[3 * i]! - positions[3 * j]!, dy = positions[3 * i + 1]! - positions[3 * j + 1]!, dz = positions[3 * i + 2]! - positions[3 * j + 2]!;
          if (dx * dx + dy * dy + dz * dz <= 4 * radius * radius) ++found;
        }
      }
    }
    return found;
  }

  #slot(x: number, y: number, z: number): number {
    return (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & this.#mask;
  }
}

const OFFSETS = Int32Array.from([
  0, 0, 0, 1, 0, 0, -1, 1, 0, 0, 1, 0, 1, 1, 0, -1, -1, 1, 0, -1, 1, 1, -1, 1, -1, 0, 1, 0, 0, 1, 1, 0, 1, -1, 1, 1, 0, 1, 1, 1, 1, 1,
]);
