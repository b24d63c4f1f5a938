import type { Pair, Pose, Verdict } from "orchard-runtime";

/** The answer after a level: what it costs to get there from the start. */
export interface Row {
  verdict: Verdict;
  microseconds: number;
}

/** Long enough that a clock of a tenth of a millisecond can tell. */
const MEASURE_MS = 1.5;

function run(pair: Pair, poseA: Pose, poseB: Pose, steps: number): Verdict {
  let verdict = pair.start(poseA, poseB);
  for (let step = 0; step < steps && !verdict.finished; ++step) verdict = pair.refine();
  return verdict;
}

/** Goes down all levels to the triangles. Each row is run again and again until its time can be told. */
export function descend(pair: Pair, poseA: Pose, poseB: Pose): Row[] {
  const rows: Row[] = [];
  for (let steps = 0; ; ++steps) {
    let runs = 0, batch = 1, verdict = run(pair, poseA, poseB, steps);
    const start = performance.now();
    let elapsed = 0;
    while (elapsed < MEASURE_MS && runs < 20_000) {
      for (let i = 0; i < batch; ++i) verdict = run(pair, poseA, poseB, steps);
      runs += batch;
      batch *= 2;
      elapsed = performance.now() - start;
    }
    const before = rows.at(-1)?.microseconds ?? 0;
    rows.push({ verdict, microseconds: Math.max(before, (1000 * elapsed) / runs) });
    if (verdict.finished) return rows;
  }
}

/** The last row that a budget reaches; the first one costs next to nothing and is always there. */
export function reached(rows: readonly Row[], microseconds: number): number {
  const beyond = rows.findIndex((row) => row.microseconds > microseconds);
  return beyond < 0 ? rows.length - 1 : Math.max(beyond - 1, 0);
}
