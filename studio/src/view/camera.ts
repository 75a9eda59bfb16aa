// From where it is looked at: one camera, z up, whose named views look from so far away that they are
// orthographic to half a pixel.
import { Box3, MathUtils, Matrix4, PerspectiveCamera, Vector3 } from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import type { Look } from "./types";

const FREE = 32;
const PARALLEL = 0.03; // degrees: over the depth of a form it shifts less than half a pixel
const GLIDE = 280;
const MARGIN = 1.22;
const EDGE = 0.92;
const ISOMETRIC = direction(-60, 28);
// a touch off the pole, so that it is known where up is
const LOOKS: Record<Look, [Vector3, number]> = {
  perspective: [ISOMETRIC, FREE],
  top: [new Vector3(0, -1e-4, 1).normalize(), PARALLEL],
  front: [new Vector3(0, -1, 0), PARALLEL],
  right: [new Vector3(1, 0, 0), PARALLEL],
};

/** From where it is looked at, and how much of it is seen. */
export interface Place {
  target: Vector3;
  /** From the target to the eye. */
  towards: Vector3;
  /** Height of what is seen at the target [length]. */
  height: number;
  /** [degrees] */
  angle: number;
}

/** The named view that this is; null where it was turned by hand. */
export function lookOf({ towards, angle }: Place): Look | null {
  const isThis = ([to, wide]: [Vector3, number]) => to.distanceTo(towards) < 1e-3 && Math.abs(angle / wide - 1) < 1e-3;
  return (Object.keys(LOOKS) as Look[]).find((look) => isThis(LOOKS[look])) ?? null;
}

export class Eye {
  readonly camera = new PerspectiveCamera(FREE, 1, 0.1, 1000);
  readonly controls: OrbitControls;
  private glide: { from: Place; to: Place; began: number } | null = null;

  constructor(canvas: HTMLCanvasElement, changed: () => void) {
    this.camera.up.set(0, 0, 1);
    this.camera.position.copy(ISOMETRIC).multiplyScalar(10);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.zoomToCursor = true;
    this.controls.zoomSpeed = 1.4;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => this.stay());
  }

  /** How it is looked at now. */
  get place(): Place {
    const away = this.camera.position.clone().sub(this.controls.target);
    const angle = this.camera.fov;
    return {
      target: this.controls.target.clone(),
      height: 2 * away.length() * half(angle),
      towards: away.normalize(),
      angle,
    };
  }

  /** Where a point is seen on a canvas there [CSS pixels of the page]; null behind the eye. */
  spot(point: ArrayLike<number>, { left, top, width, height }: DOMRect): { x: number; y: number } | null {
    this.camera.updateMatrixWorld();
    const at = new Vector3(point[0], point[1], point[2]).applyMatrix4(this.camera.matrixWorldInverse);
    if (at.z >= 0) return null;
    at.applyMatrix4(this.camera.projectionMatrix);
    return { x: left + ((at.x + 1) / 2) * width, y: top + ((1 - at.y) / 2) * height };
  }

  /** Length of a CSS pixel at the target. */
  pixel(height: number): number {
    return this.place.height / Math.max(1, height);
  }

  /** All of `positions` into view, from where it is looked at or as told. Without a glide when `at once`. */
  fit(positions: ArrayLike<number>, look?: Look, atOnce = false): void {
    const now = this.place;
    const [towards, angle] = look ? LOOKS[look] : [now.towards, now.angle];
    this.go({ ...around(positions, towards, angle, this.camera.aspect), towards, angle }, atOnce);
  }

  /** Whether all of `positions` is in view, apart from a little at the edges. */
  holds(positions: ArrayLike<number>): boolean {
    return !this.any(positions, false);
  }

  /** Whether any of `positions` is in view. */
  sees(positions: ArrayLike<number>): boolean {
    return positions.length === 0 || this.any(positions, true);
  }

  /** Whether one of `positions` is inside the view, or outside. */
  private any(positions: ArrayLike<number>, inside: boolean): boolean {
    this.camera.updateMatrixWorld();
    const { projectionMatrix, matrixWorldInverse } = this.camera;
    const m = new Matrix4().multiplyMatrices(projectionMatrix, matrixWorldInverse).elements;
    for (let i = 0; i + 2 < positions.length; i += 3) {
      const x = positions[i]!;
      const y = positions[i + 1]!;
      const z = positions[i + 2]!;
      const edge = EDGE * (m[3]! * x + m[7]! * y + m[11]! * z + m[15]!);
      const across = Math.abs(m[0]! * x + m[4]! * y + m[8]! * z + m[12]!) <= edge;
      const isInside = across && Math.abs(m[1]! * x + m[5]! * y + m[9]! * z + m[13]!) <= edge;
      if (isInside === inside) return true;
    }
    return false;
  }

  /** The view a form is first seen in: a flat upright one face on, all others at a slant. */
  first(positions: ArrayLike<number>): void {
    const size = new Box3().setFromArray(positions).getSize(new Vector3());
    const most = Math.max(size.x, size.y, size.z);
    const towards = size.y < 1e-4 * most ? direction(-90, 0) : size.x < 1e-4 * most ? direction(0, 0) : ISOMETRIC;
    this.go({ ...around(positions, towards, FREE, this.camera.aspect), towards, angle: FREE }, true);
  }

  /** Turn about the target [radians]. */
  turn(around: number, over: number): void {
    const { towards, ...rest } = this.place;
    const azimuth = Math.atan2(towards.y, towards.x) + around;
    const elevation = MathUtils.clamp(Math.asin(MathUtils.clamp(towards.z, -1, 1)) + over, -1.5705, 1.5705);
    const flat = Math.cos(elevation);
    this.put({
      ...rest,
      towards: new Vector3(flat * Math.cos(azimuth), flat * Math.sin(azimuth), Math.sin(elevation)),
    });
  }

  /** Nearer by a factor below 1, farther by one above. */
  zoom(factor: number): void {
    const { height, ...rest } = this.place;
    this.put({ ...rest, height: height * factor });
  }

  /** Move what is seen, by parts of its height. */
  pan(right: number, up: number): void {
    const { target, ...rest } = this.place;
    const [x, y] = this.axes();
    target.addScaledVector(x, -right * rest.height).addScaledVector(y, -up * rest.height);
    this.put({ ...rest, target });
  }

  /** To the right, up and towards the eye. */
  axes(): [Vector3, Vector3, Vector3] {
    this.camera.updateMatrixWorld();
    const made: [Vector3, Vector3, Vector3] = [new Vector3(), new Vector3(), new Vector3()];
    this.camera.matrixWorld.extractBasis(...made);
    return made;
  }

  /** End a glide where it is. */
  stay(): void {
    this.glide = null;
  }

  /** On with a glide; whether it goes on. */
  step(now: number): boolean {
    if (!this.glide) return false;
    const { from, to, began } = this.glide;
    const part = Math.min(1, Math.max(0, (now - began) / GLIDE));
    const t = part * part * (3 - 2 * part);
    if (part === 1) this.glide = null;
    this.put(
      part === 1
        ? to
        : {
            target: from.target.clone().lerp(to.target, t),
            towards: between(from.towards, to.towards, t),
            height: from.height * (to.height / from.height) ** t,
            angle: from.angle * (to.angle / from.angle) ** t,
          },
    );
    return part < 1;
  }

  /** Nothing of a ball is cut off. */
  reach(middle: Vector3, radius: number): void {
    const away = this.camera.position.distanceTo(middle);
    const far = away + 6 * radius;
    this.camera.near = Math.max(away - 6 * radius, 1e-3 * far);
    this.camera.far = far;
    this.camera.updateProjectionMatrix();
  }

  shape(width: number, height: number): void {
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }

  dispose(): void {
    this.controls.dispose();
  }

  /** Look from there. */
  put({ target, towards, height, angle }: Place): void {
    this.camera.fov = angle;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(towards, height / (2 * half(angle)));
    this.controls.update();
    this.controls.dispatchEvent({ type: "change" });
  }

  private go(to: Place, atOnce: boolean): void {
    const calm = matchMedia("(prefers-reduced-motion: reduce)").matches;
    this.glide = atOnce || calm ? null : { from: this.place, to, began: performance.now() };
    if (this.glide) this.controls.dispatchEvent({ type: "change" });
    else this.put(to);
  }
}

const half = (angle: number) => Math.tan(MathUtils.degToRad(angle / 2));

/** Azimuth and elevation of the eye [degrees] as a direction towards it. */
function direction(azimuth: number, elevation: number): Vector3 {
  const [a, e] = [MathUtils.degToRad(azimuth), MathUtils.degToRad(elevation)];
  return new Vector3(Math.cos(e) * Math.cos(a), Math.cos(e) * Math.sin(a), Math.sin(e));
}

function between(from: Vector3, to: Vector3, t: number): Vector3 {
  const [a, b] = [from, to].map((v) => [Math.atan2(v.y, v.x), Math.asin(MathUtils.clamp(v.z, -1, 1))]) as [
    number[],
    number[],
  ];
  const turn = MathUtils.euclideanModulo(b[0]! - a[0]! + Math.PI, 2 * Math.PI) - Math.PI;
  return direction(MathUtils.radToDeg(a[0]! + turn * t), MathUtils.radToDeg(a[1]! + (b[1]! - a[1]!) * t));
}

/** Where to look and how high, to see all of `positions`. */
function around(
  positions: ArrayLike<number>,
  towards: Vector3,
  angle: number,
  aspect: number,
): { target: Vector3; height: number } {
  const right = new Vector3().crossVectors(new Vector3(0, 0, 1), towards).normalize();
  const up = new Vector3().crossVectors(towards, right);
  const axes = [right, up, towards] as const;
  const [low, high] = [new Vector3(Infinity, Infinity, Infinity), new Vector3(-Infinity, -Infinity, -Infinity)];
  const point = new Vector3();
  const each = (use: (p: Vector3) => void) => {
    const at = new Vector3();
    for (let i = 0; i + 2 < positions.length; i += 3) {
      at.set(positions[i]!, positions[i + 1]!, positions[i + 2]!);
      use(point.set(at.dot(axes[0]), at.dot(axes[1]), at.dot(axes[2])));
    }
  };
  each((p) => (low.min(p), high.max(p)));
  if (!(low.x <= high.x) || !Number.isFinite(high.clone().sub(low).length()))
    return { target: new Vector3(), height: 1 };
  const middle = low.clone().add(high).multiplyScalar(0.5);
  const tangent = half(angle) / MARGIN;
  let away = 0;
  each((p) => {
    p.sub(middle);
    away = Math.max(away, p.z + Math.max(Math.abs(p.x) / aspect, Math.abs(p.y)) / tangent);
  });
  const target = new Vector3();
  axes.forEach((axis, i) => target.addScaledVector(axis, middle.getComponent(i)));
  return { target, height: 2 * half(angle) * away || 1 };
}
