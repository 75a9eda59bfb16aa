// Along what a drag goes: the plane that faces the eye, an axis, or a plane of two.
import { Plane, type Ray, Vector3 } from "three";
import type { Lock } from "./types";

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
/** The views from above, from the front and from the right are as near to an axis as this [-]. */
const STRAIGHT = 1 - 1e-8;
/** So nearly along the line of sight [radians], a place on it is anybody's guess. */
const GRAZING = 0.04;

/** The axis of a lock to one; null for others. */
export const axisOf = (lock: Lock): Vector3 | null =>
  lock === "x" || lock === "y" || lock === "z" ? AXES[lock] : null;

/** What a plane of two axes, or the one that faces the eye, lies across; null for an axis. */
export function normalOf(lock: Lock, facing: Vector3): Vector3 | null {
  if (lock === "view") return facing;
  const across = { xy: AXES.z, xz: AXES.y, yz: AXES.x };
  return lock in across ? across[lock as keyof typeof across] : null;
}

/** Where a thing at `from` is led by a line of sight; null where this cannot be told. */
export function led(lock: Lock, from: Vector3, sight: Ray, facing: Vector3): Vector3 | null {
  const axis = axisOf(lock);
  if (axis) return alongAxis(from, axis, sight);
  const seen = normalOf(lock, facing)!;
  const across = Object.values(AXES).findIndex((one) => Math.abs(one.dot(seen)) > STRAIGHT);
  const normal = Object.values(AXES)[across] ?? seen;
  if (Math.abs(normal.dot(sight.direction)) < Math.sin(GRAZING)) return null;
  const at = sight.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal, from), new Vector3());
  // without rounding: what is drawn flat stays flat
  return across < 0 || !at ? at : at.setComponent(across, from.getComponent(across));
}

/** The point of an axis through `from` that is nearest to a line of sight. */
function alongAxis(from: Vector3, axis: Vector3, sight: Ray): Vector3 | null {
  const across = axis.dot(sight.direction);
  const lean = 1 - across * across;
  if (lean < Math.sin(GRAZING) ** 2) return null;
  const gap = sight.origin.clone().sub(from);
  return from.clone().addScaledVector(axis, (gap.dot(axis) - across * gap.dot(sight.direction)) / lean);
}

/** A lock as keys set it: the one asked for, or none where it is set already. */
export const toggled = (now: Lock, wanted: Lock): Lock => (now === wanted ? "view" : wanted);

/** The lock of a key: an axis, or with shift the plane across it; null for other keys. */
export function lockOf(key: string, shift: boolean): Lock | null {
  const axis = key.toLowerCase();
  if (axis !== "x" && axis !== "y" && axis !== "z") return null;
  return shift ? ({ x: "yz", y: "xz", z: "xy" } as const)[axis] : axis;
}
