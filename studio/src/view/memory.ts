// From where a session was looked at in this tab, so that reloading the page shows the same picture.
import { Vector3 } from "three";
import type { Place } from "./camera";

const name = (key: string) => `hookean-eye-${key}`;

/** A place as plain numbers. */
export const numbers = ({ target, towards, height, angle }: Place) => [
  ...target.toArray(),
  ...towards.toArray(),
  height,
  angle,
];

/** The place of these numbers; null where they are of none. */
export function placed(kept: number[]): Place | null {
  if (kept.length !== 8 || !kept.every(Number.isFinite) || !(kept[6]! > 0 && kept[7]! > 0)) return null;
  return {
    target: new Vector3().fromArray(kept),
    towards: new Vector3().fromArray(kept, 3),
    height: kept[6]!,
    angle: kept[7]!,
  };
}

/** Keep the place of the eye. */
export function remember(key: string, place: Place | number[]): void {
  try {
    sessionStorage.setItem(name(key), JSON.stringify(Array.isArray(place) ? place : numbers(place)));
  } catch {
    // a browser that keeps nothing, or is full: the next sight is all of the form
  }
}

/** The place that was kept; null for none. */
export function remembered(key: string): Place | null {
  try {
    return placed(JSON.parse(sessionStorage.getItem(name(key)) ?? "[]") as number[]);
  } catch {
    return null;
  }
}
