import { identity, Pair, poseOf, type Orchard } from "orchard-runtime";
import {
  BufferAttribute, BufferGeometry, Group, Line, LineBasicMaterial, Mesh, MeshBasicMaterial, Plane, Quaternion, Raycaster,
  SphereGeometry, Vector2, Vector3, type InstancedMesh, type MeshStandardMaterial,
} from "three";
import { descend, reached, type Row } from "./descent.js";
import { byId, short } from "./dom.js";
import { bodyMaterial, sphereMesh, type Model } from "./model.js";
import { cssColor, type Stage } from "./stage.js";

const WORDS = { no: "No", maybe: "Maybe", yes: "Yes" } as const;

/** Two bodies: one is dragged onto the other, and the answer goes down the levels. */
export class CollideView {
  readonly #group = new Group();
  readonly #body = new Group();
  readonly #witness: Line;
  readonly #contact: Mesh;
  readonly #budget = byId<HTMLInputElement>("budget");
  #meshes: [Mesh, Mesh] | undefined;
  #spheres: [InstancedMesh, InstancedMesh] | undefined;
  #models: [Model, Model] | undefined;
  #pair: Pair | undefined;
  #rows: Row[] = [];
  #shownLevel = -1;
  #active = false;

  constructor(private readonly stage: Stage, private readonly orchard: Orchard) {
    const line = new BufferGeometry().setAttribute("position", new BufferAttribute(new Float32Array(6), 3));
    this.#witness = new Line(line, new LineBasicMaterial());
    this.#contact = new Mesh(new SphereGeometry(1, 20, 14), new MeshBasicMaterial({ depthTest: false }));
    this.#contact.renderOrder = this.#witness.renderOrder = 5;
    this.#group.add(this.#body, this.#witness, this.#contact);
    this.#group.visible = false;
    stage.scene.add(this.#group);
    this.#budget.addEventListener("input", () => this.#say());
    this.#listen(stage.canvas);
  }

  /** Starts with the two apart. */
  show(a: Model, b: Model): void {
    if (!a.tree || !b.tree) return;
    this.#pair?.free();
    this.#pair = new Pair(a.tree, b.tree);
    this.#models = [a, b];
    if (this.#meshes) this.#group.remove(this.#meshes[0]);
    this.#body.clear();
    this.#meshes = [new Mesh(a.geometry, bodyMaterial("#c9c4b6")), new Mesh(b.geometry, bodyMaterial("#8fb3b0"))];
    this.#group.add(this.#meshes[0]);
    this.#body.add(this.#meshes[1]);
    if (this.#spheres) this.#group.remove(this.#spheres[0]);
    this.#spheres = undefined;
    this.#shownLevel = -1;
    this.#body.quaternion.setFromAxisAngle(new Vector3(0.2, 1, 0.1).normalize(), 0.6);
    this.#body.position.copy(a.center).sub(b.center.clone().applyQuaternion(this.#body.quaternion));
    this.#body.position.x += a.reach + b.reach;
    for (let step = 0; step < 20; ++step) {  // near: nearer by less than the distance, again and again
      const { lower } = this.#pair.distance(identity(), this.#pose(), 0.1);
      this.#body.position.x -= Math.max(lower - 0.05 * a.reach, 0);
    }
    if (this.#active) this.activate();
  }
  activate(): void {
    this.#active = true;
    this.stage.animate(undefined);
    if (this.#models) {
      const [a, b] = this.#models, other = b.center.clone().applyQuaternion(this.#body.quaternion).add(this.#body.position);
      const middle = a.center.clone().add(other).multiplyScalar(0.5);
      this.stage.look(0.82 * (Math.max(a.reach, b.reach) + 0.5 * other.distanceTo(a.center)), middle, new Vector3(0.2, 0.35, 1));
      this.#ask();
    }
    this.stage.set(this.#group, true);
  }
  deactivate(): void {
    this.#active = false;
    this.stage.set(this.#group, false);
  }

  /** An arrow key's effect; true if it had one. */
  key(event: KeyboardEvent): boolean {
    if (!this.#models) return false;
    const step = (event.shiftKey ? 0.05 : 0.01) * this.#models[0].reach;
    const [right, up, toward] = [new Vector3(), new Vector3(), new Vector3()];
    this.stage.camera.matrixWorld.extractBasis(right, up, toward);
    const moves: Record<string, Vector3> = {
      ArrowLeft: right.clone().negate(), ArrowRight: right, ArrowUp: up, ArrowDown: up.clone().negate(),
      PageUp: toward.clone().negate(), PageDown: toward,
    };
    const turns: Record<string, [Vector3, number]> = { q: [up, 1], e: [up, -1], w: [right, -1], s: [right, 1] };
    if (event.key in moves) this.#body.position.addScaledVector(moves[event.key]!, step);
    else if (event.key in turns) {
      const [axis, sense] = turns[event.key]!;
      this.#body.quaternion.premultiply(new Quaternion().setFromAxisAngle(axis, 0.06 * sense));
    } else return false;
    this.#ask();
    return true;
  }

  #listen(canvas: HTMLCanvasElement): void {
    const ray = new Raycaster(), plane = new Plane(), grip = new Vector3();
    let dragging = false;
    const aim = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      ray.setFromCamera(new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height),
        this.stage.camera);
    };
    canvas.addEventListener("pointerdown", (event) => {
      if (!this.#active || !this.#meshes || event.button !== 0) return;
      aim(event);
      this.#group.updateMatrixWorld();
      const hits = ray.intersectObjects([...this.#meshes]);
      if (hits[0]?.object !== this.#meshes[1]) return;
      dragging = true;
      this.stage.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
      plane.setFromNormalAndCoplanarPoint(this.stage.camera.getWorldDirection(new Vector3()), hits[0].point);
      grip.copy(hits[0].point).sub(this.#body.position);
      event.stopImmediatePropagation();
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
      if (!dragging) return;
      aim(event);
      const point = ray.ray.intersectPlane(plane, new Vector3());
      if (!point) return;
      this.#body.position.copy(point.sub(grip));
      this.#ask();
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, () => {
        dragging = false;
        this.stage.controls.enabled = true;
      });
    }
  }

  /** The pose of the second body, as queries want it. */
  #pose(): Float64Array {
    const { x, y, z, w } = this.#body.quaternion, p = this.#body.position;
    return poseOf(this.orchard, { quaternion: [w, x, y, z], translation: [p.x, p.y, p.z] });
  }

  #ask(): void {
    if (!this.#pair) return;
    const pose = this.#pose();
    this.#rows = descend(this.#pair, identity(), pose);
    this.#say();
    this.#point(pose);
    this.stage.draw();
  }

  #say(): void {
    if (this.#rows.length === 0) return;
    const share = Number(this.#budget.value) / 100;
    const budget = share === 1 ? Infinity : 0.1 * 5000 ** share;  // 0.1 to 500 microseconds, evenly by factors
    byId("budget-name").textContent = share === 1 ? "none" : `${short(budget)} µs`;
    const last = reached(this.#rows, budget), { verdict } = this.#rows[last]!;
    byId("descent").querySelector("tbody")!.innerHTML = this.#rows.map((row, i) => this.#rowText(row, i, i > last)).join("");
    const answer = byId("answer");
    answer.dataset.answer = verdict.answer;
    answer.querySelector("strong")!.textContent = WORDS[verdict.answer];
    answer.querySelector("span")!.textContent =
      verdict.answer === "yes" ? "The surfaces meet, and two triangles prove it."
      : verdict.answer === "no" ? `The surfaces are at least ${short(verdict.lowerBound)} apart.`
      : `Not excluded so far; the solids are at most ${short(verdict.separationBound)} apart.`;
    const level = Math.min(last, this.#levels() - 1);
    this.#showSpheres(level, last >= this.#levels());
    this.stage.draw();
  }
  #levels(): number {
    const [a, b] = this.#models!;
    return Math.max(a.tree!.depth, b.tree!.depth) + 1;
  }
  #rowText({ verdict, microseconds }: Row, i: number, beyond: boolean): string {
    const exact = i >= this.#levels();
    return `<tr${beyond ? ' class="beyond"' : ""}><td>${exact ? "triangles" : i === 0 ? "roots" : i}</td>
      <td data-answer="${verdict.answer}">${verdict.answer}</td><td>${verdict.answer === "no" ? "–" : short(verdict.separationBound)}</td>
      <td>${verdict.tests.toLocaleString("en")}</td><td>${short(microseconds)}</td></tr>`;
  }

  /** Spheres of the level where the answer stands, in its colour; none where it was the triangles that decided. */
  #showSpheres(level: number, exact: boolean): void {
    const [a, b] = this.#models!;
    if (this.#shownLevel !== level) {
      this.#shownLevel = level;
      if (this.#spheres) {
        this.#group.remove(this.#spheres[0]);
        this.#body.remove(this.#spheres[1]);
      }
      this.#spheres = [a, b].map((m) => sphereMesh(m.tree!, Math.min(level, m.tree!.depth), 1)) as [InstancedMesh, InstancedMesh];
      this.#group.add(this.#spheres[0]);
      this.#body.add(this.#spheres[1]);
    }
    const tint = cssColor(`--${byId("answer").dataset.answer}`);
    for (const mesh of this.#spheres!) {
      const material = mesh.material as MeshStandardMaterial;
      for (let i = 0; i < mesh.count; ++i) mesh.setColorAt(i, tint);
      mesh.instanceColor!.needsUpdate = true;
      material.transparent = true;
      material.depthWrite = false;
      material.opacity = level === 0 ? 0.16 : 0.3;
      mesh.visible = !exact;
    }
  }

  /** The contact, or the shortest way between the two. */
  #point(pose: Float64Array): void {
    const { verdict } = this.#rows.at(-1)!;
    const yes = verdict.answer === "yes", reach = this.#models![0].reach;
    this.#contact.visible = yes;
    this.#witness.visible = verdict.answer === "no";
    if (yes) {
      this.#contact.position.set(...verdict.contact.center);
      this.#contact.scale.setScalar(0.022 * reach);
      (this.#contact.material as MeshBasicMaterial).color.copy(cssColor("--yes"));
    } else {
      const { onA, onB } = this.#pair!.distance(identity(), pose, 0.01);
      const places = this.#witness.geometry.attributes.position!;
      places.setXYZ(0, ...onA);
      places.setXYZ(1, ...onB);
      places.needsUpdate = true;
      this.#witness.geometry.computeBoundingSphere();
      (this.#witness.material as LineBasicMaterial).color.copy(cssColor("--no"));
    }
  }
}
