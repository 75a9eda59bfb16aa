// The directions of x, y and z, small in a corner.
import { DataTexture, FloatType, RGBAFormat, Vector3 } from "three";
import type { Eye } from "./camera";
import { channels, palette } from "./colours";
import { Segments } from "./segments";
import type { Stage } from "./stage";

const REACH = 26;
const MARGIN = 46;
/** Strokes of the letters x, y and z within a box of one by one, y up. */
const LETTERS = [
  [0, 0, 1, 1, 0, 1, 1, 0],
  [0, 1, 0.5, 0.5, 1, 1, 0.5, 0.5, 0.5, 0.5, 0.5, 0],
  [0, 1, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0],
];
const SIZE = 7;
const COUNT = 3 + LETTERS.flat().length / 4;

export class Triad {
  private readonly points = new DataTexture(new Float32Array(8 * COUNT), 2 * COUNT, 1, RGBAFormat, FloatType);
  private readonly segments: Segments;
  private filled = 0;

  constructor(private readonly stage: Stage) {
    const ends = Int32Array.from({ length: 2 * COUNT }, (_, i) => i);
    this.segments = new Segments({ ...stage.common, positions: { value: this.points } }, ends, 20, true);
    this.segments.style.width.value = 1.6;
    stage.group.add(this.segments.mesh);
  }

  dress(dark: boolean): void {
    this.segments.style.plain.value = [...channels(palette(dark).plain), 1];
  }

  /** Put it where the eye sees it in the lower right corner. */
  place(eye: Eye): void {
    const [right, up, towards] = eye.axes();
    const { camera } = eye;
    const { width, height } = this.stage;
    const away = Math.sqrt(camera.near * camera.far);
    const pixel = (2 * away * Math.tan((camera.fov * Math.PI) / 360)) / height;
    const corner = camera.position
      .clone()
      .addScaledVector(towards, -away)
      .addScaledVector(right, (width / 2 - MARGIN) * pixel)
      .addScaledVector(up, (MARGIN - height / 2) * pixel);
    this.filled = 0;
    for (let axis = 0; axis < 3; axis++) {
      // as seen from straight ahead, also in a corner
      const [x, y] = [right.getComponent(axis), up.getComponent(axis)];
      const at = (reach: number) =>
        corner
          .clone()
          .addScaledVector(right, x * reach * pixel)
          .addScaledVector(up, y * reach * pixel);
      const long = Math.hypot(x, y);
      this.put(corner, at(REACH));
      this.letter(axis, at(REACH + 11 / Math.max(long, 0.3)), right, up, long > 0.2 ? pixel : 0);
    }
    this.points.needsUpdate = true;
  }

  dispose(): void {
    this.points.dispose();
    this.segments.dispose();
  }

  private letter(axis: number, middle: Vector3, right: Vector3, up: Vector3, pixel: number): void {
    const strokes = LETTERS[axis]!;
    const at = (x: number, y: number) =>
      middle
        .clone()
        .addScaledVector(right, (x - 0.5) * SIZE * pixel)
        .addScaledVector(up, (y - 0.5) * SIZE * pixel);
    for (let i = 0; i < strokes.length; i += 4) {
      this.put(at(strokes[i]!, strokes[i + 1]!), at(strokes[i + 2]!, strokes[i + 3]!));
    }
  }

  private put(from: Vector3, to: Vector3): void {
    const values = this.points.image.data as Float32Array;
    from.toArray(values, 4 * this.filled++);
    to.toArray(values, 4 * this.filled++);
  }
}
