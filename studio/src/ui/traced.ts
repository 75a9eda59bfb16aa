// Numbers of what is picked over time: of the recording where there is one, else of the last minute.
import { effect, signal } from "@preact/signals";
import type { Frame } from "../frame";
import type { Session } from "../session";
import type { Options, Picked } from "../view/types";
import type { Film } from "./film";

export interface Line {
  name: string;
  /** "" for none. */
  unit: string;
  values: (number | null)[];
}

interface Sample {
  at: number;
  values: number[];
}

const MINUTE = 60;
/** Points of a line at most: more are not seen. */
const MOST = 2000;

export class Traced {
  /** Counts changes. */
  readonly version = signal(0);
  private samples: Sample[] = [];
  private of: Picked = null;
  private last: Frame | null = null;
  private readonly stops: (() => void)[];

  constructor(
    private readonly session: Session,
    private readonly options: Options,
    private readonly film: Film,
  ) {
    this.stops = [
      effect(() => {
        this.of = options.picked.value;
        void session.topology.value;
        this.samples = [];
        this.last = null;
        this.take();
      }),
      effect(() => {
        void session.ticks.value;
        this.take();
      }),
    ];
  }

  dispose(): void {
    this.stops.forEach((stop) => stop());
  }

  /** Seconds of the points, and the lines; null where nothing is picked. `recorded`: of the recording. */
  lines(): { recorded: boolean; times: number[]; lines: Line[] } | null {
    void this.version.value;
    void this.film.version.value;
    const picked = this.options.picked.value;
    if (!picked) return null;
    const recorded = this.film.shots.length > 1;
    const samples = recorded ? this.recorded(picked) : this.samples;
    return {
      recorded,
      times: samples.map(({ at }) => at),
      lines: this.names(picked).map(([name, unit], i) => ({
        name,
        unit,
        values: samples.map(({ values }) => (Number.isFinite(values[i]) ? values[i]! : null)),
      })),
    };
  }

  private recorded(picked: NonNullable<Picked>): Sample[] {
    const { shots } = this.film;
    const step = Math.ceil(shots.length / MOST);
    return shots
      .filter((_, i) => i % step === 0 || i === shots.length - 1)
      .map(({ at, frame }) => ({ at, values: this.numbers(picked, frame) }));
  }

  private names(picked: NonNullable<Picked>): [string, string][] {
    const { length = "", force = "" } = this.session.topology.value?.units ?? {};
    if (picked.kind === "spring")
      return [
        ["Force", force],
        ["Length", length],
      ];
    const own: [string, string][] = ["x", "y", "z"].map((axis) => [axis, length]);
    return this.held(picked.index) < 0 ? own : [...own, ["Reaction", force]];
  }

  private numbers({ kind, index }: NonNullable<Picked>, frame: Frame): number[] {
    const p = frame.positions;
    if (kind === "spring") {
      const [a, b] = (this.session.topology.peek()?.springs[index] ?? [0, 0]).map((end) => 3 * end) as [number, number];
      const length = Math.hypot(p[a]! - p[b]!, p[a + 1]! - p[b + 1]!, p[a + 2]! - p[b + 2]!);
      return [frame.springForces[index] ?? NaN, length];
    }
    const row = this.held(index);
    const r = frame.reactions;
    const own = [p[3 * index]!, p[3 * index + 1]!, p[3 * index + 2]!];
    return row < 0 ? own : [...own, Math.hypot(r[3 * row] ?? NaN, r[3 * row + 1] ?? NaN, r[3 * row + 2] ?? NaN)];
  }

  /** The row of a particle in the reactions of frames; -1 where it is not held. */
  private held(particle: number): number {
    const all = new Set(this.session.anchors.peek().flatMap(({ axes, particles }) => (axes ? particles : [])));
    return all.has(particle) ? [...all].sort((a, b) => a - b).indexOf(particle) : -1;
  }

  private take(): void {
    const { frame, connection } = this.session;
    if (!this.of || !frame || frame === this.last || connection.peek() !== "live") return;
    this.last = frame;
    const at = performance.now() / 1000;
    this.samples.push({ at, values: this.numbers(this.of, frame) });
    while (this.samples.length && this.samples[0]!.at < at - MINUTE) this.samples.shift();
    this.version.value = this.version.peek() + 1;
  }
}
