import {
  AmbientLight, Color, DirectionalLight, Group, HemisphereLight, PerspectiveCamera, Scene, Vector3, WebGLRenderer,
  type Object3D,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

/** The canvas with its camera and lights: what is added is drawn when something has changed, and only then. */
export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(32, 1, 0.01, 2000);
  readonly controls: OrbitControls;
  readonly #renderer: WebGLRenderer;
  readonly #light = new Group();
  #requested = false;
  #frame: (() => void) | undefined;

  constructor(readonly canvas: HTMLCanvasElement) {
    this.#renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.#renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    const key = new DirectionalLight("#ffffff", 2.1), fill = new DirectionalLight("#dfe8ff", 0.5);
    key.position.set(2.5, 4, 3.5);
    fill.position.set(-4, 1, -2);
    this.#light.add(key, fill);
    this.camera.add(this.#light);
    this.scene.add(this.camera, new AmbientLight("#ffffff", 0.55), new HemisphereLight("#ffffff", "#b9b4a6", 0.7));
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    new ResizeObserver(() => this.#resize()).observe(canvas.parentElement!);
    this.#resize();
  }

  /** Draws at the next frame. */
  draw(): void {
    if (this.#requested) return;
    this.#requested = true;
    requestAnimationFrame(() => {
      this.#requested = false;
      this.#frame?.();
      this.#renderer.render(this.scene, this.camera);
      if (this.#frame) this.draw();
    });
  }
  /** Calls `frame` before each frame from now on, or no more. */
  animate(frame: (() => void) | undefined): void {
    this.#frame = frame;
    this.draw();
  }

  /** Looks at a ball, from a little above. */
  look(radius: number, center = new Vector3(), from = new Vector3(0.75, 0.42, 1)): void {
    const half = Math.tan((this.camera.fov / 2) * (Math.PI / 180)) * Math.min(1, this.camera.aspect);
    this.camera.position.copy(from).normalize().multiplyScalar((1.12 * radius) / half).add(center);
    this.camera.near = radius / 100;
    this.camera.far = radius * 40;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.update();
    this.draw();
  }
  /** Turns the camera around the target, in radians. */
  turn(around: number, up: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    offset.applyAxisAngle(new Vector3(0, 1, 0), around);
    const side = new Vector3().crossVectors(new Vector3(0, 1, 0), offset).normalize();
    const tilted = offset.clone().applyAxisAngle(side, up);
    if (Math.abs(tilted.clone().normalize().y) < 0.985) offset.copy(tilted);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }
  zoom(factor: number): void {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }
  set(group: Object3D, visible: boolean): void {
    group.visible = visible;
    this.draw();
  }
  get size(): { width: number; height: number } {
    return { width: this.canvas.clientWidth, height: this.canvas.clientHeight };
  }

  #resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement!;
    if (width === 0 || height === 0) return;
    this.#renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}

/** A colour of the style sheet. */
export function cssColor(name: string): Color {
  return new Color(getComputedStyle(document.documentElement).getPropertyValue(name).trim());
}
