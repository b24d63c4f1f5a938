import type { Orchard } from "orchard-runtime";
import { BoxGeometry, Color, EdgesGeometry, Group, InstancedMesh, LineBasicMaterial, LineSegments, Matrix4, MeshStandardMaterial, Quaternion, Vector3 } from "three";
import { Chart } from "./chart.js";
import { COUNT, CrowdWorld, TIME_STEP, type StepReport } from "./crowd_world.js";
import { byId, short } from "./dom.js";
import type { Model } from "./model.js";
import { cssColor, type Stage } from "./stage.js";

/** Steps that a figure is the mean of: a clock of a tenth of a millisecond tells so much about the mean of many. */
const MEAN = 60;
/** The first steps build everything, and engines compile what they run. */
const WARM = 24;

/** 1,000 bodies, and what finding their contacts takes. */
export class CrowdView {
  readonly #group = new Group();
  readonly #chart = new Chart(byId<HTMLCanvasElement>("chart"));
  readonly #budget = byId<HTMLInputElement>("crowd-budget");
  readonly #recent: StepReport[] = [];
  #world: CrowdWorld | undefined;
  #mesh: InstancedMesh | undefined;
  #frame: LineSegments | undefined;
  #paused = false;
  #steps = 0;
  #last = 0;
  #active = false;

  constructor(private readonly stage: Stage, private readonly orchard: Orchard) {
    this.#group.visible = false;
    stage.scene.add(this.#group);
    this.#budget.addEventListener("input", () => this.#sayBudget());
    byId("pause").addEventListener("click", () => {
      this.#paused = !this.#paused;
      byId("pause").textContent = this.#paused ? "Go on" : "Pause";
      if (this.#active) stage.animate(this.#paused ? undefined : () => this.#advance());
    });
    this.#sayBudget();
  }

  show(model: Model): void {
    if (!model.tree) return;
    this.#world?.free();
    this.#group.clear();
    this.#recent.length = this.#steps = 0;
    this.#world = new CrowdWorld(this.orchard, model.tree, model.center.toArray(), model.reach);
    this.#mesh = new InstancedMesh(model.geometry!.clone().translate(...model.center.clone().negate().toArray()), new MeshStandardMaterial({ roughness: 0.8, flatShading: true }), COUNT);
    const box = new EdgesGeometry(new BoxGeometry(1, 1, 1));
    this.#frame = new LineSegments(box, new LineBasicMaterial());
    this.#frame.scale.setScalar(2 * this.#world.half);
    this.#group.add(this.#mesh, this.#frame);
    if (this.#active) this.activate();
  }
  activate(): void {
    this.#active = true;
    if (!this.#world) return;
    this.stage.look(1.42 * this.#world.half, new Vector3(), new Vector3(0.62, 0.3, 1));
    this.stage.animate(this.#paused ? undefined : () => this.#advance());
    this.#place();
    this.stage.set(this.#group, true);
  }
  deactivate(): void {
    this.#active = false;
    this.stage.animate(undefined);
    this.stage.set(this.#group, false);
  }

  #budgetMs(): number {
    const share = Number(this.#budget.value) / 100;
    return share === 1 ? Infinity : 0.02 * 500 ** share;  // 0.02 to 10 ms, evenly by factors
  }
  #sayBudget(): void {
    const budget = this.#budgetMs();
    byId("crowd-budget-name").textContent = budget === Infinity ? "none" : `${short(budget)} ms a step`;
  }

  /** As many steps as time has passed since the last frame, but for the time that a slow frame takes. */
  #advance(): void {
    const now = performance.now();
    const due = Math.min(Math.max(Math.round((now - this.#last) / (1000 * TIME_STEP)), 1), 8);
    this.#last = now;
    for (let i = 0; i < due; ++i) this.#step();
    this.#place();
  }
  #step(): void {
    const report = this.#world!.step(this.#budgetMs());
    if (++this.#steps > WARM) this.#recent.push(report);
    if (this.#recent.length > 600) this.#recent.shift();
    if (this.#steps > WARM && this.#steps % 12 === 0) this.#say();
  }

  #say(): void {
    const recent = this.#recent.slice(-MEAN);
    const mean = (of: (report: StepReport) => number) => recent.reduce((sum, r) => sum + of(r), 0) / recent.length;
    const show = (id: string, value: number, text = short(value)) => {
      byId(id).textContent = text;
      byId(id).dataset.value = String(value);
    };
    show("crowd-bounds", mean((r) => r.bounds), mean((r) => r.bounds).toFixed(3));
    show("crowd-hash", mean((r) => r.hash), mean((r) => r.hash).toFixed(3));
    show("crowd-asked", mean((r) => r.asked), String(Math.round(mean((r) => r.asked))));
    show("crowd-contacts", recent.at(-1)!.contacts, String(recent.at(-1)!.contacts));
    const exact = mean((r) => r.exact), possible = recent.at(-1)!.possible, last = recent.at(-1)!;
    byId("crowd-exact").textContent =
      `Triangle-exact answers for all ${last.overlaps} overlapping pairs: ${exact.toFixed(2)} ms a step${possible ? `, ${possible} left open by the budget` : ""}.`;
    byId("crowd-exact").dataset.value = String(exact);
    byId("crowd-exact").dataset.overlaps = `${last.overlaps} ${last.hashOverlaps}`;
    byId("crowd-exact").dataset.steps = String(this.#steps);
    this.#chart.draw([
      { values: this.#recent.map((r) => r.hash), color: "--maybe" },
      { values: this.#recent.map((r) => r.bounds), color: "--accent" },
    ], MEAN);
  }

  #place(): void {
    const { positions, quaternions, touching } = this.#world!;
    const matrix = new Matrix4(), p = new Vector3(), q = new Quaternion(), one = new Vector3(1, 1, 1);
    const calm = new Color("#b9b6ac"), hit = cssColor("--yes");
    for (let i = 0; i < COUNT; ++i) {
      p.fromArray(positions, 3 * i);
      q.set(quaternions[4 * i + 1]!, quaternions[4 * i + 2]!, quaternions[4 * i + 3]!, quaternions[4 * i]!);
      this.#mesh!.setMatrixAt(i, matrix.compose(p, q, one));
      this.#mesh!.setColorAt(i, touching[i] ? hit : calm);
    }
    this.#mesh!.instanceMatrix.needsUpdate = true;
    this.#mesh!.instanceColor!.needsUpdate = true;
    (this.#frame!.material as LineBasicMaterial).color.copy(cssColor("--line"));
  }
}
