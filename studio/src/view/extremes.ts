// The two ends of a scale of colours, which stay while numbers waver a little.
const PAUSE = 250;
const SHRINKING = 1500;

/** The extremes of finite numbers; [NaN, NaN] where there are none. */
export function extremes(values: ArrayLike<number>): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < values.length; i++) {
    const value = values[i]!;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  return low <= high ? [low, high] : [NaN, NaN];
}

const ENOUGH = 50;
const SAMPLED = 5000;
const TAIL = 0.01;
const FAR = 2;

/** The ends of a scale: the extremes, or, where a few values lie far beyond the rest, the 1st and 99th percentile;
 * `beyond` is how many lie outside. */
export function spread(values: ArrayLike<number>): { low: number; high: number; beyond: number } {
  const [low, high] = extremes(values);
  const all = { low, high, beyond: 0 };
  if (!(high > low) || values.length < ENOUGH) return all;
  const stride = Math.ceil(values.length / SAMPLED);
  const sampled = Float64Array.from({ length: Math.floor(values.length / stride) }, (_, i) => values[i * stride]!)
    .filter(Number.isFinite)
    .sort();
  const [first, last] = [at(sampled, TAIL), at(sampled, 1 - TAIL)];
  if (!(last > first) || high - low <= FAR * (last - first)) return all;
  return { low: first, high: last, beyond: outside(values, first, last).length };
}

/** Places of the values beyond two ends. */
export function outside(values: ArrayLike<number>, low: number, high: number): number[] {
  const found: number[] = [];
  for (let i = 0; i < values.length; i++) if (values[i]! < low || values[i]! > high) found.push(i);
  return found;
}

const at = (sorted: Float64Array, part: number) => sorted[Math.round(part * (sorted.length - 1))] ?? NaN;

/** Extremes that grow when they must, shrink when they are far too wide, and are exact at rest. */
export class Extremes {
  low = NaN;
  high = NaN;
  private changed = -Infinity;

  /** Whether a change may be due at all [ms]. */
  due(now: number): boolean {
    return now - this.changed >= PAUSE;
  }

  /** Take the present range; returns whether the ends have moved. */
  take(low: number, high: number, resting: boolean, now: number): boolean {
    if (Object.is(low, this.low) && Object.is(high, this.high)) return false;
    const span = this.high - this.low;
    const first = !(span >= 0);
    const wide = high - low < 0.6 * span && now - this.changed > SHRINKING;
    if (first || resting || wide || !(low <= high)) return this.set(low, high, now);
    if (low >= this.low - 0.02 * span && high <= this.high + 0.02 * span) return false;
    return this.set(Math.min(low, this.low), Math.max(high, this.high), now);
  }

  /** As for something else. */
  forget(): void {
    this.set(NaN, NaN, -Infinity);
  }

  private set(low: number, high: number, now: number): true {
    [this.low, this.high, this.changed] = [low, high, now];
    return true;
  }
}
