import { hasSimd, loadOrchard, type Orchard } from "orchard-runtime";
import { CollideView } from "./collide.js";
import { CrowdView } from "./crowd.js";
import { byId } from "./dom.js";
import { LevelsView } from "./levels.js";
import { BUNDLED, loadBundled, loadFile, type Model } from "./model.js";
import { Stage } from "./stage.js";

type ViewName = "levels" | "collide" | "crowd";
const NAMES: readonly ViewName[] = ["levels", "collide", "crowd"];
const HINTS: Record<ViewName, string> = {
  levels: "Drag to turn, scroll or pinch to come nearer.<span> Keys: arrows, + and −.</span>",
  collide: "Drag the green body onto the other.<span> Keys: arrows and Page Up, Page Down move it, Q E W S turn it.</span>",
  crowd: "Red: in contact now. Drag to turn.",
};

class Demo {
  readonly #models: Model[] = [];
  readonly #views: { levels: LevelsView; collide: CollideView; crowd: CrowdView };
  #view: ViewName = "levels";
  #crowdStarted = false;

  constructor(private readonly stage: Stage, private readonly orchard: Orchard) {
    this.#views = { levels: new LevelsView(stage), collide: new CollideView(stage, orchard), crowd: new CrowdView(stage, orchard) };
    this.#listenTabs();
    this.#listenFiles();
    this.#listenKeys();
    for (const id of ["body-a", "body-b"]) byId(id).addEventListener("change", () => this.#collide());
    byId("ground").addEventListener("click", () => {
      setGround(document.documentElement.dataset.ground === "dark" ? "light" : "dark");
      stage.draw();
    });
  }

  add(model: Model, select: boolean): void {
    const old = this.#models.findIndex((other) => other.name === model.name);
    if (old >= 0) this.#models[old] = model;
    else this.#models.push(model);
    this.#listModels(model, select);
    if (select) this.#views.levels.show(model);
  }
  start(): void {
    byId<HTMLSelectElement>("body-b").value = this.#models[1]!.name;
    this.#collide();
    this.go(NAMES.find((name) => `#${name}` === location.hash) ?? "levels");
    byId("loading").hidden = true;
  }
  go(view: ViewName): void {
    this.#views[this.#view].deactivate();
    this.#view = view;
    document.body.dataset.view = view;
    for (const name of NAMES) {
      const tab = byId(`tab-${name}`), shown = name === view;
      tab.setAttribute("aria-selected", String(shown));
      tab.tabIndex = shown ? 0 : -1;
      byId(name).hidden = !shown;
    }
    byId("hint").innerHTML = HINTS[view];
    history.replaceState(null, "", `#${view}`);
    if (view === "crowd" && !this.#crowdStarted) {
      this.#crowdStarted = true;
      this.#views.crowd.show(this.#models.find((model) => model.name === "Lamp")!);
    }
    this.#views[view].activate();
  }

  #collide(): void {
    const trees = this.#models.filter((model) => model.tree);
    const chosen = ["body-a", "body-b"].map((id) => trees.find((m) => m.name === byId<HTMLSelectElement>(id).value) ?? trees[0]!);
    this.#views.collide.show(chosen[0]!, chosen[1]!);
  }

  #listModels(added: Model, select: boolean): void {
    const list = byId("models"), current = select ? added.name : this.#models[0]!.name;
    list.replaceChildren(...this.#models.map((model) => {
      const label = document.createElement("label"), input = document.createElement("input"), text = document.createElement("span");
      Object.assign(input, { type: "radio", name: "model", value: model.name, checked: model.name === current });
      input.addEventListener("change", () => this.#views.levels.show(model));
      text.textContent = model.name;
      label.append(input, text);
      return label;
    }));
    const open = document.createElement("button");
    Object.assign(open, { type: "button", textContent: "Open a file" });
    open.addEventListener("click", () => byId<HTMLInputElement>("file").click());
    list.append(open);
    const trees = this.#models.filter((model) => model.tree);
    for (const [id, standard] of [["body-a", 0], ["body-b", 1]] as const) {
      const menu = byId<HTMLSelectElement>(id), before = menu.value;
      menu.replaceChildren(...trees.map((model) => new Option(model.name, model.name)));
      menu.value = trees.some((model) => model.name === before) && before !== "" ? before : trees[Math.min(standard, trees.length - 1)]?.name ?? "";
    }
  }

  #listenTabs(): void {
    for (const [i, name] of NAMES.entries()) {
      byId(`tab-${name}`).addEventListener("click", () => this.go(name));
      byId(`tab-${name}`).addEventListener("keydown", (event) => {
        const to = event.key === "ArrowRight" ? i + 1 : event.key === "ArrowLeft" ? i + NAMES.length - 1 : -1;
        if (to < 0) return;
        this.go(NAMES[to % NAMES.length]!);
        byId(`tab-${this.#view}`).focus();
      });
    }
  }
  #listenKeys(): void {
    this.stage.canvas.addEventListener("keydown", (event) => {
      const turns: Record<string, [number, number]> = {
        ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1],
      };
      const known = this.#view === "collide" && this.#views.collide.key(event);
      if (!known && event.key in turns) this.stage.turn(...turns[event.key]!);
      else if (!known && "+=".includes(event.key)) this.stage.zoom(0.9);
      else if (!known && event.key === "-") this.stage.zoom(1.1);
      else if (!known) return;
      event.preventDefault();
    });
  }
  #listenFiles(): void {
    const input = byId<HTMLInputElement>("file");
    input.addEventListener("change", () => {
      if (input.files?.[0]) void this.#open(input.files[0]);
      input.value = "";
    });
    addEventListener("dragover", (event) => {
      event.preventDefault();
      byId("stage").classList.add("dropping");
    });
    addEventListener("dragleave", (event) => {
      if (!event.relatedTarget) byId("stage").classList.remove("dropping");
    });
    addEventListener("drop", (event) => {
      event.preventDefault();
      byId("stage").classList.remove("dropping");
      const file = event.dataTransfer?.files[0];
      if (file) void this.#open(file);
    });
  }
  async #open(file: File): Promise<void> {
    try {
      const model = await loadFile(this.orchard, file);
      say(undefined);
      this.go("levels");
      this.add(model, true);
    } catch (error) {
      say(`${file.name} is not shown. ${(error as Error).message}`);
    }
  }
}

function say(message: string | undefined): void {
  const place = byId("message");
  place.hidden = message === undefined;
  place.textContent = message ?? "";
}

function setGround(ground: "light" | "dark"): void {
  document.documentElement.dataset.ground = ground;
}

setGround(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
try {
  const orchard = await loadOrchard({ worlds: true, wasm: `orchard-worlds-${hasSimd() ? "simd" : "plain"}.wasm` });
  const demo = new Demo(new Stage(byId<HTMLCanvasElement>("canvas")), orchard);
  const models = await Promise.all(BUNDLED.map((name) => loadBundled(orchard, name)));
  models.forEach((model, i) => demo.add(model, i === 0));
  demo.start();
  document.body.dataset.ready = "true";
} catch (error) {
  byId("loading").hidden = true;
  say(`This page cannot start here. ${(error as Error).message}`);
}
