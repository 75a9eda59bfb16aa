// Values of columns as one amount that a slider leads: of an array the largest, and the rest keep in proportion.
import type { Bounds, Point } from "../model";

/** A number, one for each element, a vector, or one for each element. */
export type Value = number | number[] | number[][];

/** Whether a value of a scene is one of those. */
export function isValue(value: unknown): value is Value {
  if (typeof value === "number") return true;
  if (!Array.isArray(value) || value.length === 0) return false;
  return value.every(
    (row) => typeof row === "number" || (Array.isArray(row) && row.every((n) => typeof n === "number")),
  );
}

/** How a value is seen: `vectors` have a length, plain numbers a sign. */
export function amount(value: Value, vectors: boolean): number {
  const sizes = amounts(value, vectors);
  return sizes.reduce((most, size) => (Math.abs(size) > Math.abs(most) ? size : most), 0);
}

/** The amount of each element. */
export function amounts(value: Value, vectors: boolean): number[] {
  if (typeof value === "number") return [value];
  if (!vectors) return value as number[];
  const rows = (isRows(value) ? value : [value]) as number[][];
  return rows.map((row) => Math.hypot(...row));
}

/** The value with another amount; what is nothing at all becomes the same everywhere, a vector downwards. */
export function led(value: Value, vectors: boolean, to: number): Value {
  const from = amount(value, vectors);
  if (from === 0) return vectors ? [0, 0, -to] : to;
  const factor = to / from;
  if (typeof value === "number") return to;
  return isRows(value) ? value.map((row) => row.map((n) => tidy(n * factor))) : value.map((n) => tidy(n * factor));
}

/** Whether a value is one vector, whose components can be given. */
export const isVector = (value: Value): value is Point => Array.isArray(value) && value.length === 3 && !isRows(value);

const isRows = (value: Value): value is number[][] => Array.isArray(value) && Array.isArray(value[0]);

// a slider has no more digits than this, and 0.30000000000000004 is not what anybody set
const tidy = (value: number) => Number(value.toPrecision(12));

const [FINE, WIDE] = [3, 100];

/** What a slider goes through. */
export interface Range {
  low: number;
  high: number;
  /** In powers of ten. */
  log: boolean;
}

/** A range around an amount, within its bounds: fine, by which the form changes but stays in sight, or wide. */
export function around(value: number, bounds: Bounds | undefined, log: boolean, isWide: boolean): Range {
  const least = bounds?.minimum ?? bounds?.more_than ?? -Infinity;
  const most = bounds?.maximum ?? bounds?.less_than ?? Infinity;
  if (log && value > 0)
    return {
      low: Math.max(value / (isWide ? WIDE : FINE), least > 0 ? least : 0),
      high: Math.min(value * (isWide ? WIDE : FINE), most),
      log,
    };
  if (!isWide && value !== 0) {
    const half = nice(0.5 * Math.abs(value), ENDS);
    return { low: Math.max(value - half, least), high: Math.min(value + half, most), log: false };
  }
  const reach = nice(2 * Math.abs(value) || 1, ENDS);
  const high = most - Math.max(least, 0) <= 10 ? most : Math.min(reach, most);
  return { low: least >= -reach ? least : -reach, high, log: false };
}

/** Whether a slider has come to the end of its range, or its value lies outside. */
export function outgrown(range: Range, value: number, bounds: Bounds | undefined): boolean {
  if (range.log && value <= 0) return true;
  const span = range.high - range.low;
  const most = bounds?.maximum ?? Infinity;
  if (value > range.high || value < range.low) return true;
  if (range.log) return value > range.high * 0.8 || value < range.low * 1.25;
  const small = Math.abs(value) > 0 && Math.abs(value) < 0.04 * range.high && range.high !== most;
  return small || (value > range.high - 0.02 * span && range.high < most);
}

/** The step of a slider over a range: so fine that a hand does not feel it, so round that numbers stay short. */
export function stepOf({ low, high, log }: Range): number {
  return log ? 0.01 : nice((high - low) / 400, STEPS);
}

const STEPS = [1, 2, 5, 10];
const ENDS = [1, 1.5, 2, 3, 4, 5, 6, 8, 10];

/** The next number as round as one of these that is not less. */
function nice(value: number, round: number[]): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return Number(((round.find((one) => one * power >= value * 0.999) ?? 10) * power).toPrecision(3));
}

/** A value of a logarithmic slider with the digits that count. */
export const rounded = (value: number) => Number(value.toPrecision(3));
