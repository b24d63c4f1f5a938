// Asks the module what orchard_web_recorder asked the native run-time, and counts the answers that differ in a bit.
// Runs in Node and in browsers: `api` is the package, `orchard` what loadOrchard() gave.

/** Names of the kinds, in the order of recorder/record.h. */
const KINDS = ["pose", "collide", "levels", "distance", "collideAgain", "nearestPoint", "castRay", "inside", "closerThan",
  "contacts", "signedDistance", "batch", "broadPhase", "detector"];
const ANSWERS = ["no", "maybe", "yes"];
const CHANGES = ["begin", "stay", "end", "possible"];
const NO_TRIANGLE = 0xffffffff;

const trianglesRow = (triangles) => triangles ?? [NO_TRIANGLE, NO_TRIANGLE];
const verdictRow = (v) => [ANSWERS.indexOf(v.answer), v.separationBound, v.lowerBound, ...v.contact.center, v.contact.radius,
  ...v.contact.normal, ...trianglesRow(v.triangles), v.level, Number(v.finished), Number(v.refused), v.tests];
const number = (answer) => (answer === "yes" ? 1 : answer === "no" ? 0 : -1);

class Replay {
  constructor(api, orchard, trees) {
    Object.assign(this, { api, orchard, trees });
    this.pairs = trees.map((a) => trees.map((b) => new api.Pair(a, b)));
  }
  // Two trees and two poses at the beginning of the arguments.
  question(row) {
    return { a: this.trees[row[0]], b: this.trees[row[1]], pair: this.pairs[row[0]][row[1]],
      poses: [row.slice(2, 15), row.slice(15, 28)] };
  }

  pose(row) {
    return [...this.api.poseOf(this.orchard, { quaternion: row.slice(0, 4), translation: row.slice(4, 7) })];
  }
  collide(row) {
    const { pair, poses } = this.question(row);
    return verdictRow(pair.collide(...poses, { tests: row[28] }));
  }
  levels(row) {
    const { pair, poses } = this.question(row);
    const all = [pair.start(...poses)];
    while (!all.at(-1).finished) all.push(pair.refine());
    return all.flatMap(verdictRow);
  }
  distance(row) {
    const { pair, poses } = this.question(row);
    const d = pair.distance(...poses, row[28]);
    return [d.lower, d.upper, ...d.onA, ...d.onB, ...trianglesRow(d.triangles)];
  }
  collideAgain(row) {
    const { pair, poses } = this.question(row);
    return [0, 1, 2].flatMap(() => {
      poses[1][9] += 0.01;
      return verdictRow(pair.collideAgain(...poses));
    });
  }
  nearestPoint(row) {
    const found = this.trees[row[0]].nearestPoint(row.slice(1, 14), row.slice(14, 17));
    return [Number(found !== undefined), found.distance, ...found.point, ...found.normal, found.triangle];
  }
  castRay(row) {
    const hit = this.trees[row[0]].castRay(row.slice(1, 14), row.slice(14, 17), row.slice(17, 20));
    return hit ? [1, hit.along] : [0, 0];
  }
  inside(row) {
    const tree = this.trees[row[0]], pose = row.slice(1, 14);
    return [number(tree.contains(pose, row.slice(14, 17))),
      number(tree.capsuleTouches(pose, row.slice(14, 17), row.slice(17, 20), row[20]))];
  }
  closerThan(row) {
    const { a, b, poses } = this.question(row);
    return [number(this.api.closerThan(a, poses[0], b, poses[1], row[28]))];
  }
  contacts(row) {
    const { a, b, poses } = this.question(row);
    const m = this.api.contacts(a, poses[0], b, poses[1], row[28]);
    return [ANSWERS.indexOf(m.answer), m.points.length, ...m.normal, m.depth, m.error, Number(m.complete),
      ...m.points.flatMap((p) => [...p.point, ...p.triangles, p.depth])];
  }
  signedDistance(row) {
    const { a, b, poses } = this.question(row);
    const d = this.api.signedDistance(a, poses[0], b, poses[1]);
    return [d.lower, d.upper, ...d.onA, ...d.onB, ...d.normal];
  }
  // As one batch, and each verdict asked for alone must be the same.
  batch(row) {
    const count = row.length / 28;
    const rows = Array.from({ length: count }, (_, i) => row.slice(28 * i, 28 * i + 28));
    const poses = (from) => Float64Array.from(rows.flatMap((r) => [...r.slice(from, from + 13)]));
    const trees = (which) => rows.map((r) => this.trees[r[which]]);
    const answers = this.api.collideAll(trees(0), poses(2), trees(1), poses(15));
    return Array.from({ length: count }, (_, i) => verdictRow(this.api.verdictAt(answers, i))).flat();
  }
  broadPhase(row) {
    const [timeStep, steps, bodies] = row;
    const world = new this.api.BroadPhase(this.orchard, (time, asked, motions) => {
      asked.forEach((body, i) => {
        const flight = row.subarray(3 + 7 * body, 10 + 7 * body);
        for (let k = 0; k < 3; ++k) {
          motions[13 * i + k] = flight[k] + time * flight[3 + k];
          motions[13 * i + 3 + k] = flight[3 + k];
        }
        motions[13 * i + 6] = flight[6];
      });
    }, { timeStep });
    for (let i = 0; i < bodies; ++i) world.add();
    const answers = [];
    for (let step = 0; step < steps; ++step) {
      let report;
      do {
        report = world.advance(step * timeStep);
        answers.push(report.time, report.pairs.length / 2, ...report.pairs);
      } while (report.pairs.length > 0);
    }
    world.free();
    return answers;
  }
  detector(row) {
    const [timeStep, steps, bodies] = row;
    const { api } = this;
    const world = new api.Detector(this.orchard, { timeStep });
    const shapes = this.trees.map((tree) => world.addTree(tree));
    for (let i = 0; i < bodies; ++i) {
      const body = row.subarray(3 + 17 * i, 20 + 17 * i);
      const state = api.restingState();
      state.set(body.subarray(1, 14), api.STATE.pose);
      state.set(body.subarray(14, 17), api.STATE.velocity);
      world.addBody(shapes[body[0]], {}, state);
    }
    const answers = [];
    for (let step = 1; step <= steps; ++step) {
      const frame = world.step(step * timeStep);
      answers.push(frame.time, frame.pairs, frame.certain, frame.work, frame.events.length);
      for (const e of frame.events) {
        answers.push(CHANGES.indexOf(e.change), e.a.index, e.b.index, e.time, ...verdictRow(e.verdict));
      }
    }
    world.free();
    return answers;
  }
}

/** Compares everything; `differing` describes the first few queries that differ. */
export function replay(api, orchard, trees, recording) {
  const all = new Replay(api, orchard, trees);
  const count = recording[0], differing = [], asked = {};
  let place = 1, different = 0;
  for (let query = 0; query < count; ++query) {
    const kind = KINDS[recording[place]];
    const row = recording.slice(place + 2, place + 2 + recording[place + 1]);
    place += 2 + row.length;
    const expected = recording.subarray(place + 1, place + 1 + recording[place]);
    place += 1 + expected.length;
    const got = all[kind](row);
    asked[kind] = (asked[kind] ?? 0) + 1;
    const at = got.length === expected.length ? got.findIndex((value, i) => !Object.is(value, expected[i])) : -2;
    if (at === -1) continue;
    ++different;
    if (differing.length < 5) {
      differing.push(`query ${query} (${kind}): ${got.length} numbers, ${expected.length} recorded; number ${at} is ${got[at]}, recorded ${expected[at]}`);
    }
  }
  for (const pair of all.pairs.flat()) pair.free();
  return { count, different, differing, asked };
}
