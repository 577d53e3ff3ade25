// The stage: canvas, camera, lights, floor. It draws when something has changed, and never else.

import {
  BoxGeometry, Color, DirectionalLight, GridHelper, HemisphereLight, LineBasicMaterial, LineSegments, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, PerspectiveCamera, Quaternion, Scene, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { vector } from "./vectors.js";

const FIELD = 28; // degrees: little perspective, so that lengths can be compared
const MARGIN = 1.12;

/** The browser cannot draw in three dimensions. */
export class NoWebGL extends Error {}

function rendererOrReason() {
  try {
    return new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
  } catch (error) {
    throw new NoWebGL(error.message);
  }
}

let warm = null;

/** Prepares what a stage needs that takes long, for one that is raised later: a renderer with its programs for all materials. */
export function warmUp() {
  try {
    warm = rendererOrReason();
  } catch (error) {
    if (error instanceof NoWebGL) return;
    throw error;
  }
  const scene = new Scene().add(...lights());
  for (const transparent of [false, true]) {
    scene.add(new Mesh(new BoxGeometry(), new MeshStandardMaterial({ transparent })));
    scene.add(new LineSegments(new BoxGeometry(), new LineBasicMaterial({ transparent })));
  }
  const floor = new GridHelper(1, 1); // lines that have colours
  floor.material.transparent = true;
  scene.add(new Mesh(new BoxGeometry(), new MeshBasicMaterial()), floor);
  warm.setSize(8, 8);
  warm.render(scene, new PerspectiveCamera());
}

const lights = () => [new HemisphereLight(0xffffff, 0x8a8f99, 1.9), new DirectionalLight(0xffffff, 2.1), new DirectionalLight(0xffffff, 0.5)];

/** Takes an object off the stage and gives its memory back. */
export function dispose(object) {
  object.removeFromParent();
  object.traverse((each) => {
    each.geometry?.dispose();
    each.material?.dispose();
  });
}

/** A camera that is turned by mouse, finger or keys, over a canvas that fills `host`. */
export class Stage {
  #asked = false;

  /** @throws {NoWebGL} where the browser gives none */
  constructor(host, data) {
    this.host = host;
    this.data = data;
    this.renderer = warm ?? rendererOrReason();
    warm = null;
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    host.prepend(this.renderer.domElement);
    this.scene = new Scene();
    this.up = vector(data.up).normalize();
    this.centre = vector(data.centre);
    this.size = data.size || 1; // one point has no size
    this.camera = new PerspectiveCamera(FIELD, 1, 2e-3 * this.size, 60 * this.size);
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.ask());
    this.#light();
    this.afterDraw = () => {};
    this.keepsSize = () => false;
    new ResizeObserver(() => this.#resize()).observe(host);
  }

  #light() {
    const [sky, sun, fill] = lights();
    Object.assign(this, { sun, fill });
    this.scene.add(sky, sun, fill, sun.target, fill.target);
  }

  /** Light comes over the viewer's left shoulder, so that no side that is seen is black. */
  #follow() {
    const right = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 0);
    const above = new Vector3().setFromMatrixColumn(this.camera.matrixWorld, 1);
    for (const [light, x, y] of [[this.sun, -0.5, 0.7], [this.fill, 0.8, -0.2]]) {
      light.position.copy(this.camera.position)
        .addScaledVector(right, x * this.distance).addScaledVector(above, y * this.distance);
      light.target.position.copy(this.controls.target);
    }
  }

  get distance() {
    return this.camera.position.distanceTo(this.controls.target);
  }

  /** Background, floor and lines for light or dark. */
  setTheme({ background, grid }) {
    this.background = background;
    this.scene.background = new Color(background);
    this.gridColour = grid;
    this.setFloor(this.floorHeight);
    this.ask();
  }

  /** A grid square to `up`; null takes it away. */
  setFloor(height) {
    this.floorHeight = height;
    if (this.floor) {
      this.scene.remove(this.floor);
      this.floor.dispose();
      this.floor = null;
    }
    if (height === null || height === undefined || this.data.planar) return;
    const step = 10 ** Math.floor(Math.log10(this.size / 4));
    const cells = 2 * Math.ceil(this.size / step);
    this.floor = new GridHelper(cells * step, cells, this.gridColour, this.gridColour);
    this.floor.material.transparent = true;
    this.floor.material.opacity = 0.45;
    this.floor.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), this.up));
    this.floor.position.copy(this.centre).addScaledVector(this.up, height - this.centre.dot(this.up));
    this.scene.add(this.floor);
  }

  /** Looks along `-direction` so that all `places` are on the stage. */
  look(direction, places) {
    const back = direction.clone().normalize();
    this.camera.up.copy(Math.abs(back.dot(this.up)) > 0.999 ? this.#sideways() : this.up);
    this.camera.position.copy(this.centre).add(back);
    this.camera.lookAt(this.centre);
    this.camera.updateMatrixWorld();
    const [right, above] = [0, 1].map((k) => new Vector3().setFromMatrixColumn(this.camera.matrixWorld, k));
    const tall = Math.tan((FIELD * Math.PI) / 360) / MARGIN;
    const wide = tall * this.camera.aspect;
    const { top, bottom } = this.#covered();
    const [over, under] = [tall * (1 - 2 * top), tall * (1 - 2 * bottom)];
    // the four sides of the frustum, each pushed out until it holds every place
    const side = (across, slope) =>
      Math.max(...places.map((place) => {
        const off = place.clone().sub(this.centre);
        return off.dot(across) + slope * off.dot(back);
      }));
    const sides = [[right, wide], [right.clone().negate(), wide], [above, over], [above.clone().negate(), under]]
      .map(([across, slope]) => side(across, slope));
    const distance = Math.max((sides[0] + sides[1]) / (2 * wide), (sides[2] + sides[3]) / (over + under), 1e-3 * this.size);
    const target = this.centre.clone()
      .addScaledVector(right, (sides[0] - sides[1]) / 2)
      .addScaledVector(above, (sides[2] - sides[3] - (over - under) * distance) / 2);
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(back, distance);
    this.controls.update();
    this.ask();
  }

  /** Looks from a position to a target, as arrays. */
  moveTo({ position, up, target }) {
    this.camera.position.fromArray(position);
    this.camera.up.fromArray(up);
    this.controls.target.fromArray(target);
    this.controls.update();
    this.ask();
  }

  /** The shares of the stage's height that its tools and its legend lie over. */
  #covered() {
    const share = (selector) => Math.min(0.25, (this.host.querySelector(selector)?.offsetHeight ?? 0) / (this.height || 1));
    return { top: share("#tools"), bottom: share("#legend") };
  }

  /** Whether all places are on the stage. */
  sees(places) {
    return places.every((place) => {
      const { x, y, z } = place.clone().project(this.camera);
      return Math.abs(x) <= 1 && Math.abs(y) <= 1 && z < 1;
    });
  }

  #sideways() {
    return Math.abs(this.up.y) < 0.9 ? new Vector3(0, 1, 0) : new Vector3(0, 0, -1);
  }

  #resize() {
    const { clientWidth: width, clientHeight: height } = this.host;
    if (this.keepsSize() || width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    const first = this.width === undefined;
    [this.width, this.height] = [width, height];
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (first) this.whenSized?.();
    else this.whenResized?.();
    this.draw();
  }

  /** Asks for one picture in the browser's next frame. */
  ask() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => {
      this.#asked = false;
      this.draw();
    });
  }

  draw() {
    this.#follow();
    this.renderer.render(this.scene, this.camera);
    this.afterDraw();
  }
}
