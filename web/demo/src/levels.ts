import { Group, Mesh, MeshStandardMaterial, DoubleSide, type InstancedMesh } from "three";
import { byId, short } from "./dom.js";
import { axisView, sphereMesh, type AxisColor, type AxisView, type Model } from "./model.js";
import { LINES, VIRIDIS_CSS } from "./palette.js";
import type { Stage } from "./stage.js";

/** The view of one model: spheres of a level, the mesh behind them, the axis inside. */
export class LevelsView {
  readonly #group = new Group();
  readonly #level = byId<HTMLInputElement>("level");
  #model: Model | undefined;
  #spheres: InstancedMesh | undefined;
  #mesh: Mesh | undefined;
  #axis: AxisView | undefined;
  #axisColor: AxisColor | undefined;

  constructor(private readonly stage: Stage) {
    stage.scene.add(this.#group);
    this.#level.addEventListener("input", () => this.#update());
    for (const id of ["show-spheres", "show-mesh", "show-axis"]) byId(id).addEventListener("change", () => this.#update());
    document.querySelectorAll("[name=axis-color]").forEach((input) => input.addEventListener("click", () => {
      byId<HTMLInputElement>("show-axis").checked = true;
      if (this.#model?.tree) byId<HTMLInputElement>("show-spheres").checked = false;
      this.#update();
    }));
  }

  show(model: Model): void {
    this.#group.clear();
    this.#model = model;
    this.#mesh = this.#axis = this.#spheres = this.#axisColor = undefined;
    if (model.geometry) {
      this.#mesh = new Mesh(model.geometry, new MeshStandardMaterial({ color: "#b9b6ac", roughness: 0.8, flatShading: true, side: DoubleSide }));
      this.#group.add(this.#mesh);
    }
    if (model.tree) this.#level.max = String(model.tree.depth);
    byId<HTMLInputElement>("show-axis").checked = !model.tree;
    byId<HTMLInputElement>("show-spheres").checked = Boolean(model.tree);
    for (const [id, has] of [["show-spheres", model.tree], ["show-mesh", model.geometry], ["show-axis", model.axis]] as const) {
      byId<HTMLInputElement>(id).disabled = !has;
      byId(id).parentElement!.hidden = !has;
    }
    this.#level.closest("label")!.hidden = byId("level-note").hidden = !model.tree;
    document.querySelectorAll<HTMLInputElement>("[name=axis-color]").forEach((input) => (input.disabled = !model.axis));
    document.querySelector("[name=axis-color]")!.closest("fieldset")!.hidden = !model.axis;
    this.#update();
    this.activate();
  }
  activate(): void {
    this.stage.animate(undefined);
    if (this.#model) this.stage.look(this.#model.reach, this.#model.center);
    this.stage.set(this.#group, true);
  }
  deactivate(): void {
    this.stage.set(this.#group, false);
  }

  #update(): void {
    const shown = (id: string) => byId<HTMLInputElement>(id).checked && !byId<HTMLInputElement>(id).disabled;
    const spheres = shown("show-spheres"), axis = shown("show-axis");
    const color = document.querySelector<HTMLInputElement>("[name=axis-color]:checked")!.value as AxisColor;
    this.#updateSpheres(spheres);
    this.#updateAxis(axis, color);
    if (this.#mesh) {
      const material = this.#mesh.material as MeshStandardMaterial;
      const clear = axis || spheres;
      material.transparent = clear;
      material.opacity = axis ? 0.14 : spheres ? 0.55 : 1;
      material.depthWrite = !axis;
      material.needsUpdate = true;
      this.#mesh.renderOrder = axis ? 2 : 0;
      this.#mesh.visible = shown("show-mesh");
    }
    this.#legend(axis, spheres, color);
    this.stage.draw();
  }

  #updateSpheres(visible: boolean): void {
    const tree = this.#model?.tree;
    if (!tree) return;
    const level = Math.min(Number(this.#level.value), tree.depth);
    const rows = tree.spheres(level);
    let worst = 0;
    for (let i = 4; i < rows.length; i += 5) worst = Math.max(worst, rows[i]!);
    if (this.#spheres) {
      this.#group.remove(this.#spheres);
      this.#spheres.geometry.dispose();
    }
    this.#spheres = sphereMesh(tree, level, worst || 1);
    this.#spheres.visible = visible;
    this.#spheres.renderOrder = 1;
    this.#group.add(this.#spheres);
    byId("level-name").textContent = `${level} of ${tree.depth}`;
    const count = rows.length / 5;
    byId("level-note").textContent =
      `${count.toLocaleString("en")} ${count === 1 ? "sphere" : "spheres"}, reaching at most ${short((100 * worst) / tree.boundingRadius)} % of the radius beyond the solid`;
    this.#level.dataset.worst = String(worst);
  }

  #updateAxis(visible: boolean, color: AxisColor): void {
    const axis = this.#model?.axis;
    if (!axis) return;
    if (this.#axisColor !== color) {
      if (this.#axis) this.#group.remove(this.#axis.object);
      this.#axis = axisView(axis, color);
      this.#axisColor = color;
      this.#group.add(this.#axis.object);
    }
    this.#axis!.object.visible = visible;
  }

  #legend(axis: boolean, spheres: boolean, color: AxisColor): void {
    const bar = (title: string, low: string, high: string) =>
      `<span>${title}</span><div class="bar" style="background:${VIRIDIS_CSS}"></div><div class="ends"><span>${low}</span><span>${high}</span></div>`;
    const legend = byId("legend");
    if (axis && color === "structure") {
      const item = (tint: string, text: string) => `<li><i style="background:${tint}"></i>${text}</li>`;
      legend.innerHTML = `<ul>${item("#6fb8ae", "sheets, a colour each")}${item(LINES.seam, "seams")}${item(LINES.border, "borders")}${item(LINES.curve, "curves")}</ul>`;
    } else if (axis && this.#axis?.range) {
      const title = color === "radius" ? "Radius of the ball that touches the surface"
        : "Thickness where two walls face each other; grey elsewhere";
      legend.innerHTML = bar(title, short(this.#axis.range[0]), short(this.#axis.range[1]));
    } else if (spheres) {
      legend.innerHTML = bar("How far a sphere reaches beyond the solid", "0", short(Number(this.#level.dataset.worst)));
    } else legend.innerHTML = "";
  }
}
