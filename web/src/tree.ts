import { answerOf, vectorAt, type Answer, type Vector } from "./answers.js";
import { Owned } from "./module.js";
import type { Orchard } from "./orchard.js";
import type { Pose } from "./pose.js";

/** A file that is no tree, with the reason. */
export class LoadError extends Error {
  override readonly name = "LoadError";
}

export interface RayHit {
  /** The factor of the direction at the first hit. */
  along: number;
}
export interface NearestPoint {
  /** Negative inside the solid. */
  distance: number;
  point: Vector;
  /** The direction in which the distance grows. */
  normal: Vector;
  triangle: number;
}

/** A packed sphere-tree in the module's memory. Queries only read it, and any number of pairs may share it. Free it when
 * all that use it are freed; what is never freed lives as long as the module. */
export class Tree extends Owned {
  /** R of the mesh, and how far a stored vertex may lie from the mesh's own, in mesh units. */
  readonly boundingRadius: number;
  readonly vertexError: number;
  readonly branching: number;
  /** Levels below the root. */
  readonly depth: number;
  readonly nodeCount: number;
  readonly vertexCount: number;
  readonly triangleCount: number;

  private constructor(orchard: Orchard, handle: number) {
    super(orchard.module, handle, "tree");
    this.module.call.tree_facts!(handle, this.module.out);
    const facts = this.module.answer(7);
    this.boundingRadius = facts[0]!;
    this.vertexError = facts[1]!;
    this.branching = facts[2]!;
    this.depth = facts[3]!;
    this.nodeCount = facts[4]!;
    this.vertexCount = facts[5]!;
    this.triangleCount = facts[6]!;
  }

  /** Reads the bytes of an .orchard file. Any bytes are either refused with a LoadError or safe to query. */
  static load(orchard: Orchard, bytes: ArrayBuffer | Uint8Array): Tree {
    const { module } = orchard;
    const file = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
    const handle = module.lend(file.length + 8, (address) => {
      module.bytes(address, file.length).set(file);
      const error = address + Math.ceil(file.length / 4) * 4;
      const tree = module.call.tree_load!(address, file.length, error) >>> 0;
      if (tree === 0) throw new LoadError(`No tree was loaded: ${module.text(module.integers(error, 1)[0]!)}.`);
      return tree;
    });
    return new Tree(orchard, handle);
  }

  /** Trees of simple shapes, for queries between trees. A sphere or capsule is a point or segment with a margin. */
  static point(orchard: Orchard, point: ArrayLike<number>): Tree {
    return new Tree(orchard, orchard.module.call.point_tree!(orchard.module.write(point)) >>> 0);
  }
  static segment(orchard: Orchard, p: ArrayLike<number>, q: ArrayLike<number>): Tree {
    return new Tree(orchard, orchard.module.call.segment_tree!(orchard.module.write(p, q)) >>> 0);
  }
  /** A box around the origin of half the edges' lengths `half`, all positive. */
  static box(orchard: Orchard, half: ArrayLike<number>): Tree {
    return new Tree(orchard, orchard.module.call.box_tree!(orchard.module.write(half)) >>> 0);
  }
  /** The convex hull of points, three numbers each. Throws a RangeError if they lie in a plane or are not finite. */
  static hull(orchard: Orchard, points: ArrayLike<number>): Tree {
    const { module } = orchard;
    const handle = module.lend(points.length * 8, (address) => {
      module.numbers(address, points.length).set(points);
      return module.call.hull_tree!(address, Math.floor(points.length / 3)) >>> 0;
    });
    if (handle === 0) throw new RangeError("A hull needs points that are finite and do not lie in a plane.");
    return new Tree(orchard, handle);
  }

  /** The spheres of a level, and those that end above it: x, y, z, radius and error of each, where the error bounds how
   * far a point of the ball is from the solid. In the tree's own frame. */
  spheres(level: number): Float64Array {
    const { module } = this;
    const count = module.call.tree_spheres!(this.handle, level, 0);
    return module.lend(count * 40, (address) => {
      module.call.tree_spheres!(this.handle, level, address);
      return module.numbers(address, count * 5).slice();
    });
  }
  /** The mesh that the tree is of: coordinates of vertices, and three vertices for each triangle. */
  mesh(): { vertices: Float64Array; triangles: Uint32Array } {
    const { module, vertexCount, triangleCount } = this;
    return module.lend(vertexCount * 24 + triangleCount * 12, (address) => {
      const second = address + vertexCount * 24;
      module.call.tree_mesh!(this.handle, address, second);
      return {
        vertices: module.numbers(address, vertexCount * 3).slice(),
        triangles: module.integers(second, triangleCount * 3).slice(),
      };
    });
  }

  /** Whether a point of the world lies in the solid. */
  contains(pose: Pose, point: ArrayLike<number>): Answer {
    return answerOf(this.module.call.contains!(this.handle, this.module.write(pose, point)));
  }
  /** Whether the points within `radius` of the segment from p to q touch the surface. */
  capsuleTouches(pose: Pose, p: ArrayLike<number>, q: ArrayLike<number>, radius: number): Answer {
    return answerOf(this.module.call.capsule_touches!(this.handle, this.module.write(pose, p, q, [radius])));
  }
  /** Whether a solid box around its pose's origin, of half the edges' lengths `half`, touches the surface. */
  boxTouches(pose: Pose, half: ArrayLike<number>, box: Pose): Answer {
    return answerOf(this.module.call.box_touches!(this.handle, this.module.write(pose, half, box)));
  }
  /** The first hit of a ray up to `longest` directions; undefined if there is none, or nothing can be said. */
  castRay(pose: Pose, origin: ArrayLike<number>, direction: ArrayLike<number>, longest = Infinity): RayHit | undefined {
    const row = this.module.write(pose, origin, direction, [longest]);
    if (this.module.call.cast_ray!(this.handle, row, this.module.out) !== 1) return undefined;
    return { along: this.module.answer(1)[0]! };
  }
  /** Rays take about half of their time from now on, for some 60 bytes a triangle. */
  indexRays(): void {
    this.module.call.index_rays!(this.handle);
  }
  /** The point of the surface nearest to `point`; undefined if it is not within `limit`, or nothing can be said. */
  nearestPoint(pose: Pose, point: ArrayLike<number>, limit = Infinity): NearestPoint | undefined {
    const row = this.module.write(pose, point, [limit]);
    if (this.module.call.nearest_point!(this.handle, row, this.module.out) !== 1) return undefined;
    const answer = this.module.answer(8);
    return { distance: answer[0]!, point: vectorAt(answer, 1), normal: vectorAt(answer, 4), triangle: answer[7]! };
  }

  /** Throws if a pair or a detector still uses the tree. */
  free(): void {
    this.release("tree_close");
  }
}
