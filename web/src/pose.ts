import type { Orchard } from "./orchard.js";

/** 13 numbers: a rotation (row-major, 9), a translation (3) and a scale. world = scale * rotation * body + translation.
 * The rotation is a proper one to 1e-12: `poseOf` makes it so. A query about a pose that is none says `refused`. */
export type Pose = Float64Array | readonly number[];

/** What `poseOf` makes a pose of. */
export interface Placement {
  /** In the world's units; the origin by default. */
  translation?: ArrayLike<number>;
  /** The real part first (w, x, y, z), of any length; no rotation by default. */
  quaternion?: ArrayLike<number>;
  /** Above 0; 1 by default. */
  scale?: number;
}

/** No rotation, no translation, the scale 1. */
export function identity(): Float64Array {
  return new Float64Array([1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1]);
}

/** A pose from a quaternion and a translation, with the same bits as `pose_from_quaternion` of the run-time.
 * Throws a RangeError if the quaternion is zero or a number is not finite. */
export function poseOf(orchard: Orchard, placement: Placement): Float64Array {
  const { module } = orchard;
  const { quaternion = [1, 0, 0, 0], translation = [0, 0, 0], scale = 1 } = placement;
  const row = module.write(quaternion, translation);
  if (quaternion.length !== 4 || translation.length !== 3 || !(scale > 0) ||
      module.call.pose_from_quaternion!(row, row + 32, module.out) === 0) {
    throw new RangeError("A pose needs a quaternion of four numbers that are not all zero, a translation of three, all finite, and a scale above 0.");
  }
  const pose = module.answer(13).slice();
  pose[12] = scale;
  return pose;
}

/** The nearest pose whose rotation is one, where rounding has spoilt it by at most 1e-3 (a rotation of floats, say);
 * undefined if it is farther off. */
export function madeRigid(orchard: Orchard, pose: Pose): Float64Array | undefined {
  const row = orchard.module.write(pose);
  return orchard.module.call.make_rigid!(row) === 0 ? undefined : orchard.module.numbers(row, 13).slice();
}
