// Where the pen is: on a particle, the middle of a spring, a corner of the grid, or anywhere on the working plane.
import { Matrix4, type PerspectiveCamera, Plane, Ray, Vector3 } from "three";
import type { Point } from "../model";

/** Across which axis the working plane lies, and where on it [length]. */
export interface Working {
  axis: "x" | "y" | "z";
  at: number;
}

export const NAMES: Record<Working["axis"], string> = { z: "xy plane", y: "xz plane", x: "yz plane" };

/** What the pen may snap to, and the step of the grid [length]. */
export interface Snapping {
  particles: boolean;
  midpoints: boolean;
  grid: boolean;
  step: number;
}

/** A place for a corner. */
export interface Spot {
  at: Point;
  what: "particle" | "midpoint" | "grid" | "plane" | "typed";
  /** The number of that particle, or of the spring whose middle it is. */
  index: number;
}

export interface Sight {
  camera: PerspectiveCamera;
  /** Of the canvas [CSS pixels]. */
  width: number;
  height: number;
}

interface Among extends Sight {
  positions: Float32Array;
  springs: [number, number][];
}

const NORMALS = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
/** A plane seen so nearly from its side [-] that a place on it is anybody's guess. */
const GRAZING = 0.03;

/** The place for a corner at x, y on the canvas; null where the working plane cannot be hit there. */
export function spotAt(
  [x, y]: [number, number],
  reach: number,
  working: Working,
  snapping: Snapping,
  among: Among,
): Spot | null {
  const { positions, springs } = among;
  const seen = projector(among);
  if (snapping.particles) {
    const particle = nearest(positions.length / 3, (i) => point(positions, i), [x, y], reach, seen);
    if (particle >= 0) return { at: point(positions, particle), what: "particle", index: particle };
  }
  if (snapping.midpoints) {
    const middle = (i: number) => between(point(positions, springs[i]![0]), point(positions, springs[i]![1]));
    const spring = nearest(springs.length, middle, [x, y], reach, seen);
    if (spring >= 0) return { at: middle(spring), what: "midpoint", index: spring };
  }
  const hit = onPlane([x, y], working, among);
  if (!hit) return null;
  if (!snapping.grid || !(snapping.step > 0)) return { at: hit, what: "plane", index: -1 };
  const { step } = snapping;
  const at = hit.map((value, i) => ("xyz"[i] === working.axis ? value : rounded(value, step))) as Point;
  return { at, what: "grid", index: -1 };
}

/** In words, to be shown beside the pen. */
export const saidOf = ({ what, index }: Spot) =>
  ({
    particle: `particle ${index}`,
    midpoint: `middle of spring ${index}`,
    grid: "grid",
    plane: "working plane",
    typed: "typed",
  })[what];

/** Three numbers that were typed, from the last corner where they begin with @; or a sentence on what is wrong. */
export function typedPoint(text: string, last: Point | null): Point | string {
  const isBy = text.trim().startsWith("@");
  const numbers = text.replace("@", "").split(/[\s,;]+/).filter(Boolean).map(Number);
  if (numbers.length !== 3 || !numbers.every(Number.isFinite))
    return `${text || "Nothing"} given; give x, y and z, such as 4 0 2.5.`;
  if (!isBy) return numbers as Point;
  if (!last) return "There is no last corner yet; give x, y and z without @.";
  return numbers.map((value, i) => value + last[i]!) as Point;
}

const rounded = (value: number, step: number) => Number((Math.round(value / step) * step).toPrecision(12));

const point = (positions: Float32Array, i: number) => [...positions.subarray(3 * i, 3 * i + 3)] as Point;

const between = (a: Point, b: Point) => a.map((value, i) => (value + b[i]!) / 2) as Point;

/** Where points are on the canvas; null behind the eye. */
export function projector({ camera, width, height }: Sight): (at: Point) => { x: number; y: number } | null {
  camera.updateMatrixWorld();
  const m = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
  return ([x, y, z]) => {
    const w = m[3]! * x + m[7]! * y + m[11]! * z + m[15]!;
    if (w <= 0) return null;
    return {
      x: ((m[0]! * x + m[4]! * y + m[8]! * z + m[12]!) / w + 1) * 0.5 * width,
      y: (1 - (m[1]! * x + m[5]! * y + m[9]! * z + m[13]!) / w) * 0.5 * height,
    };
  };
}

function nearest(
  count: number,
  at: (i: number) => Point,
  [x, y]: [number, number],
  reach: number,
  seen: ReturnType<typeof projector>,
): number {
  let [best, least] = [-1, reach];
  for (let i = 0; i < count; i++) {
    const place = seen(at(i));
    const away = place ? Math.hypot(place.x - x, place.y - y) : Infinity;
    if (away <= least) [best, least] = [i, away];
  }
  return best;
}

function onPlane([x, y]: [number, number], working: Working, { camera, width, height }: Sight): Point | null {
  camera.updateMatrixWorld();
  const far = new Vector3((2 * x) / width - 1, 1 - (2 * y) / height, 0.5).unproject(camera);
  const sight = new Ray(camera.position.clone(), far.sub(camera.position).normalize());
  const normal = NORMALS[working.axis];
  if (Math.abs(normal.dot(sight.direction)) < GRAZING) return null;
  const hit = sight.intersectPlane(new Plane(normal, -working.at), new Vector3());
  if (!hit) return null;
  return hit.setComponent("xyz".indexOf(working.axis), working.at).toArray() as Point;
}
