// An empty page: how large a sheet to show, and the step of its grid.
import type { Units } from "../model";

const STEPS: Record<string, number> = { m: 1, dm: 10, cm: 100, mm: 1000, km: 0.001, ft: 3, in: 36, yd: 1 };
/** Half of the sheet that is seen [steps]. */
const HALF = 6;

/** A step of the grid that suits a unit of length: about a metre. */
export const stepOf = (unit: string) => STEPS[unit] ?? 1;

/** Corners of the sheet of an empty page. */
export function blank(units: Units | undefined): number[] {
  const half = HALF * stepOf(units?.length ?? "m");
  return [-half, -half, 0, half, half, 0];
}
