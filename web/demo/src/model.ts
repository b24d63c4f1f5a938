import { Tree, type Orchard } from "orchard-runtime";
import {
  Box3, BufferAttribute, BufferGeometry, Color, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, Mesh, MeshBasicMaterial,
  MeshStandardMaterial, SphereGeometry, Vector3, DoubleSide,
} from "three";
import { readMedialAxis, thicknessOf, type MedialAxis } from "./medial.js";
import { LINES, NONE, sheetColor, viridis } from "./palette.js";

/** A tree with its mesh, or an axis alone, or both. */
export interface Model {
  name: string;
  tree?: Tree;
  geometry?: BufferGeometry;
  axis?: MedialAxis;
  /** A ball that holds all of it. */
  center: Vector3;
  reach: number;
}

export const BUNDLED = ["lamp", "faucet", "ship"] as const;

async function bytesOf(path: string): Promise<ArrayBuffer> {
  const response = await fetch(path);
  if (!response.ok) throw new Error(`${path} is not there (status ${response.status}).`);
  return response.arrayBuffer();
}

export async function loadBundled(orchard: Orchard, name: string): Promise<Model> {
  const [tree, axis] = await Promise.all([bytesOf(`models/${name}.orchard`), bytesOf(`models/${name}.ma`)]);
  const model = modelOfTree(orchard, name[0]!.toUpperCase() + name.slice(1), new Uint8Array(tree));
  return { ...model, axis: readMedialAxis(new TextDecoder().decode(axis)) };
}

/** The model of a dropped file. Throws an error with a sentence for people. */
export async function loadFile(orchard: Orchard, file: File): Promise<Model> {
  const bytes = new Uint8Array(await file.arrayBuffer());
  if (/\.ma(_dup|_struct)?$/i.test(file.name)) {
    const axis = readMedialAxis(new TextDecoder().decode(bytes));
    if (axis.radii.length === 0) throw new Error("It holds no ball.");
    return { name: file.name, axis, ...ballAround(axis.centers, axis.radii) };
  }
  if (!/\.orchard$/i.test(file.name)) {
    throw new Error("This page reads .orchard files (orchard build MESH -o DIR makes one) and .ma files (orchard medial MESH -o DIR).");
  }
  return modelOfTree(orchard, file.name, bytes);
}

function modelOfTree(orchard: Orchard, name: string, bytes: Uint8Array): Model {
  const tree = Tree.load(orchard, bytes);
  const { vertices, triangles } = tree.mesh();
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(Float32Array.from(vertices), 3));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return { name, tree, geometry, ...ballAround(vertices) };
}

/** Around the middle of the box. */
function ballAround(points: ArrayLike<number>, radii?: ArrayLike<number>): { center: Vector3; reach: number } {
  const box = new Box3(), point = new Vector3();
  const at = (i: number) => point.set(points[3 * i]!, points[3 * i + 1]!, points[3 * i + 2]!);
  for (let i = 0; 3 * i < points.length; ++i) box.expandByPoint(at(i));
  const center = box.getCenter(new Vector3());
  let reach = 0;
  for (let i = 0; 3 * i < points.length; ++i) reach = Math.max(reach, at(i).distanceTo(center) + (radii?.[i] ?? 0));
  return { center, reach };
}

/** The spheres of a level, by how far each reaches beyond the solid: from dark to light up to `most`. */
export function sphereMesh(tree: Tree, level: number, most: number): InstancedMesh {
  const spheres = tree.spheres(level), count = spheres.length / 5;
  const opacity = [0.16, 0.34, 0.62, 0.92][Math.min(level, 3)]!;
  const material = new MeshStandardMaterial({ roughness: 0.55, transparent: opacity < 1, opacity, depthWrite: level > 1 });
  const mesh = new InstancedMesh(new SphereGeometry(1, count > 400 ? 16 : 32, count > 400 ? 12 : 24), material, count);
  const matrix = new Matrix4(), color = new Color();
  for (let i = 0; i < count; ++i) {
    const [x, y, z, r, error] = spheres.subarray(5 * i, 5 * i + 5) as unknown as [number, number, number, number, number];
    matrix.makeScale(r, r, r).setPosition(x, y, z);
    mesh.setMatrixAt(i, matrix);
    mesh.setColorAt(i, viridis(Number.isFinite(error) ? error / most : 1, color));
  }
  return mesh;
}

export function bodyMaterial(color: string): MeshStandardMaterial {
  return new MeshStandardMaterial({ color, roughness: 0.75, metalness: 0.02, flatShading: true, side: DoubleSide });
}

export type AxisColor = "radius" | "thickness" | "structure";
export interface AxisView {
  object: Mesh;
  /** The range of what the colours mean; structure has none. */
  range?: [number, number];
}

/** The triangles of an axis in colours, with the lines where its sheets end and meet. */
export function axisView(axis: MedialAxis, by: AxisColor): AxisView {
  const count = axis.triangles.length / 3, positions = new Float32Array(count * 9), colors = new Float32Array(count * 9);
  const thickness = by === "thickness" ? thicknessOf(axis) : undefined;
  const values = by === "radius" ? axis.radii : thickness ?? new Float32Array(0);
  const range = by === "structure" ? undefined : rangeOf(values);
  const color = new Color();
  for (let t = 0; t < count; ++t) {
    for (let k = 0; k < 3; ++k) {
      const vertex = axis.triangles[3 * t + k]!, place = 9 * t + 3 * k;
      positions.set(axis.centers.subarray(3 * vertex, 3 * vertex + 3), place);
      const value = by === "radius" ? axis.radii[vertex]! : thickness?.[t] ?? NaN;
      if (!range) sheetColor(axis.sheets[t]!, color);
      else if (Number.isNaN(value)) color.copy(NONE);
      else viridis((value - range[0]) / (range[1] - range[0] || 1), color);
      colors.set([color.r, color.g, color.b], place);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(positions, 3));
  geometry.setAttribute("color", new BufferAttribute(colors, 3));
  geometry.computeVertexNormals();
  const object = new Mesh(geometry, by === "structure"
    ? new MeshStandardMaterial({ vertexColors: true, side: DoubleSide, roughness: 0.9 })
    : new MeshBasicMaterial({ vertexColors: true, side: DoubleSide }));
  addLines(object, axis, by);
  return range ? { object, range } : { object };
}

function addLines(object: Mesh, axis: MedialAxis, by: AxisColor): void {
  const add = (vertices: ArrayLike<number>, color: string) => {
    if (vertices.length === 0) return;
    const geometry = new BufferGeometry();
    const places = Array.from(vertices).flatMap((v) => Array.from(axis.centers.subarray(3 * v, 3 * v + 3)));
    geometry.setAttribute("position", new BufferAttribute(Float32Array.from(places), 3));
    object.add(new LineSegments(geometry, new LineBasicMaterial({ color })));
  };
  if (by === "structure") for (const kind of ["border", "seam", "curve"] as const) add(axis.lines[kind], LINES[kind]);
  else if (axis.triangles.length === 0) add(axis.edges, "#21918c");
}

function rangeOf(values: ArrayLike<number>): [number, number] {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < values.length; ++i) {
    const value = values[i]!;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [0, 1];
}
