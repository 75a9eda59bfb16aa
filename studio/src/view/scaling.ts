// From numbers to colours: the ends of the scale, chosen or found, and the colours between them.
import { type Ramp, palette, ramp } from "./colours";
import { Extremes, outside, spread } from "./extremes";
import type { Legend, Scale } from "./types";

const STOPS = 9;

/** Ramp with what shaders need: `log`: they take the logarithm of sizes. */
export interface Coloured extends Ramp {
  log: boolean;
}

export class Scaling {
  private readonly found = new Extremes();
  private scale: Scale = { kind: "auto", low: null, high: null };
  private outliers = 0;

  /** Take another choice; numbers are judged again. */
  choose(scale: Scale): void {
    this.scale = scale;
    this.forget();
  }

  forget(): void {
    this.found.forget();
    this.outliers = -1; // not counted: the legend changes with the next numbers, be they none
  }

  due(now: number): boolean {
    return this.found.due(now);
  }

  /** Take the present numbers; whether the legend has changed. */
  take(values: ArrayLike<number>, resting: boolean, now: number): boolean {
    const all = this.scale.kind === "log" ? sizes(values) : values;
    const { low, high, beyond } = spread(all);
    const typed = this.scale.low !== null || this.scale.high !== null;
    const moved = this.found.take(low, high, resting, now);
    const even = this.scale.kind === "even" && beyond > 0; // values beyond one end may have the sign of the other
    const count = typed || even ? outside(all, ...this.ends()).length : beyond;
    const isOther = count !== this.outliers;
    this.outliers = count;
    return moved || isOther;
  }

  /** Places of the numbers beyond the scale. */
  beyond(values: ArrayLike<number>): number[] {
    return this.outliers ? outside(this.scale.kind === "log" ? sizes(values) : values, ...this.ends()) : [];
  }

  coloured(dark: boolean): Coloured {
    const [low, high] = this.ends();
    const { cold, middle, warm } = palette(dark);
    const both = [...cold, middle, ...warm];
    if (this.scale.kind === "log" && low > 0 && high > 0) {
      const [first, last] = [Math.log10(low), Math.log10(high)];
      return { colours: warm, first, last: Math.max(last, first + 1e-3), log: true };
    }
    const largest = Math.max(Math.abs(low), Math.abs(high));
    if (this.scale.kind === "even" && largest > 0)
      return { colours: both, first: -largest, last: largest, log: false };
    const typed = this.scale.low !== null || this.scale.high !== null;
    if (!typed || !(low < 0 && high > 0)) return { ...ramp(low, high, dark), log: false };
    // typed ends on both sides of 0: grey stays at 0
    const at = (i: number) => (low + ((high - low) * i) / (STOPS - 1)) / largest;
    const colours = Array.from({ length: STOPS }, (_, i) => both[Math.round((at(i) + 1) * 0.5 * (both.length - 1))]!);
    return { colours, first: low, last: high, log: false };
  }

  legend(title: string, unit: string, dark: boolean): Legend | null {
    const { low, high } = this.found;
    if (!(low <= high)) return null;
    const { colours, first, last, log } = this.coloured(dark);
    const flat = high - low <= 1e-9 * Math.max(Math.abs(low), Math.abs(high));
    const ends = log ? [10 ** first, 10 ** last] : [first, last];
    return {
      title: log ? `Size of ${title.toLowerCase()}, log` : title,
      unit,
      low: ends[0]!,
      high: ends[1]!,
      beyond: this.outliers,
      equal: flat && !this.outliers ? high : null,
      colours,
    };
  }

  /** The ends as chosen, else as found; the larger one on both sides of 0 on an even scale. */
  private ends(): [number, number] {
    const { low, high } = this.found;
    if (this.scale.kind === "even") {
      const chosen = [this.scale.low, this.scale.high].filter((end) => end !== null);
      const largest = Math.max(...(chosen.length ? chosen : [low, high]).map(Math.abs));
      return [-largest, largest];
    }
    const [first, last] = [this.scale.low ?? low, this.scale.high ?? high];
    return first <= last ? [first, last] : [last, first];
  }
}

/** Sizes of the numbers that have one. */
export const sizes = (values: ArrayLike<number>) => Float64Array.from(values, (value) => Math.abs(value) || NaN);

/** Strains [-] of springs by their ends and rest lengths; not a number where the rest length is 0. */
export function strains(p: Float32Array, ends: Int32Array, lengths: Float32Array): Float32Array {
  return lengths.map((rest, i) => {
    const [a, b] = [3 * ends[2 * i]!, 3 * ends[2 * i + 1]!];
    return rest > 0 ? Math.hypot(p[a]! - p[b]!, p[a + 1]! - p[b + 1]!, p[a + 2]! - p[b + 2]!) / rest - 1 : NaN;
  });
}
