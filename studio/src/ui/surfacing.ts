// Reads the surface of the shape while it is shown: once for each state at rest, twice a second while it moves.
import { computed, effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Point, SurfaceRead, Topology, Units } from "../model";
import type { Session } from "../session";
import type { Options, Painted, Sketch } from "../view/types";

type OfCloth = "stress" | "state" | "utilisation";
export type Scalar = "displacement" | "slope" | "mean_curvature" | "gaussian_curvature" | OfCloth;

/** What is chosen to be seen. */
export interface Chosen {
  scalar: Scalar | null;
  heights: boolean;
  /** From height line to height line [length]; null: a round one. */
  step: number | null;
  water: boolean;
}

export interface OfScalar {
  name: Scalar;
  seen: string;
  unit: (units: Units) => string;
  hint: string;
  /** Only cloth has it. */
  isOfCloth?: boolean;
}

export const SCALARS: OfScalar[] = [
  {
    name: "displacement",
    seen: "Displacement",
    unit: ({ length }) => length,
    hint: "How far each particle is from where it started",
  },
  {
    name: "slope",
    seen: "Slope",
    unit: () => "°",
    hint: "Angle to the horizontal. 0° is level; water stays on less than about 2°",
  },
  {
    name: "mean_curvature",
    seen: "Mean curvature",
    unit: ({ length }) => `1/${length}`,
    hint: "Mean of both curvatures, 0 on a soap film without pressure; of a sphere it is 1 / radius",
  },
  {
    name: "gaussian_curvature",
    seen: "Gaussian curvature",
    unit: ({ length }) => `1/${length}²`,
    hint: "Product of both curvatures. Below 0: a saddle, as of tensile roofs; 0: it can be unrolled; above 0: a dome",
  },
  {
    name: "stress",
    seen: "Stress of cloth",
    unit: ({ force, length }) => `${force}/${length}`,
    hint: "Largest principal stress per width of the membrane about a particle. Usual prestress: 1 to 5 kN/m",
    isOfCloth: true,
  },
  {
    name: "state",
    seen: "State of cloth",
    unit: () => "",
    hint: "2 taut, 1 wrinkled, 0 slack: the loosest triangle about a particle",
    isOfCloth: true,
  },
  {
    name: "utilisation",
    seen: "Utilisation of cloth",
    unit: () => "%",
    hint: "Part of its strength that the membrane uses, the largest about a particle. 100 %: the strength itself",
    isOfCloth: true,
  },
];

const DROPS = 200;
const PAUSE = 500;
/** Of larger models it is read at rest only. */
const MANY = 30_000;

/** Next to the largest number these are rounding. */
const NOTHING = 1e-9;

/** What was chosen, from an address or a file; null if that is invalid. */
export function chosenOf(told: unknown): Chosen | null {
  const { scalar = null, heights = false, step = null, water = false } = (told ?? {}) as Partial<Chosen>;
  if (scalar !== null && !SCALARS.some(({ name }) => name === scalar)) return null;
  const distance = typeof step === "number" && step > 0 ? step : null;
  return { scalar, heights: heights === true, step: distance, water: water === true };
}

export class Surfacing {
  readonly chosen = signal<Chosen>({ scalar: null, heights: false, step: null, water: false });
  /** As it was read last; null before. */
  readonly read = signal<SurfaceRead | null>(null);
  readonly fault = signal("");
  private of = "";
  private asked = "";
  private at = 0;
  private timer = 0;
  private readonly stops: (() => void)[];

  constructor(
    private readonly session: Session,
    private readonly options: Options,
    told: unknown = null,
  ) {
    const given = chosenOf(told);
    if (given) this.chosen.value = given;
    const isWanted = computed(() => {
      const { scalar, heights, water } = this.chosen.value;
      return scalar !== null || heights || water;
    });
    this.stops = [
      effect(() => {
        void [session.ticks.value, session.summary.value, session.topology.value, this.chosen.value];
        if (isWanted.value && session.connection.value === "live") this.follow();
      }),
      effect(() => this.show(isWanted.value)),
    ];
  }

  dispose(): void {
    clearTimeout(this.timer);
    this.stops.forEach((stop) => stop());
  }

  private follow(): void {
    const { summary, frame } = this.session;
    const now = summary.peek();
    if (!now || !frame || this.asked) return;
    const moment = this.moment();
    const wait = this.at + PAUSE - performance.now();
    if (moment === this.of || (now.playing && now.particles > MANY)) return;
    clearTimeout(this.timer);
    if (wait > 0 && this.read.peek()) this.timer = window.setTimeout(() => this.follow(), wait);
    else void this.ask(moment);
  }

  private async ask(moment: string): Promise<void> {
    const { step, water } = this.chosen.peek();
    this.asked = moment;
    try {
      this.read.value = rounded(await api.surface(this.session.key, step, water ? DROPS : 0));
      this.fault.value = "";
    } catch (error) {
      this.fault.value = error instanceof Error ? error.message : String(error);
    } finally {
      this.of = moment;
      this.asked = "";
      this.at = performance.now();
      if (this.moment() !== moment) this.timer = window.setTimeout(() => this.follow(), PAUSE);
    }
  }

  /** Stands for the shape and what is read of it. */
  private moment(): string {
    const { step, water } = this.chosen.peek();
    const { revision, iteration } = this.session.frame ?? {};
    return [this.session.topology.peek()?.particles, revision, iteration, step, water].join(" ");
  }

  private show(isWanted: boolean): void {
    const [read, topology, chosen] = [this.read.value, this.session.topology.value, this.chosen.value];
    const fits = isWanted && read && topology?.particles === read.displacement.length && !this.options.still.value;
    this.options.painted.value = fits ? painted(read, topology, chosen) : null;
  }
}

function rounded(read: SurfaceRead): SurfaceRead {
  const near = (values: (number | null)[]) => {
    const most = values.reduce((size: number, value) => Math.max(size, Math.abs(value ?? 0)), 0);
    return values.map((value) => (value !== null && Math.abs(value) < NOTHING * most ? 0 : value));
  };
  const utilisation = read.utilisation.map((value) => (value === null ? null : 100 * value));
  const shown = { ...read, utilisation };
  return { ...shown, ...Object.fromEntries(SCALARS.map(({ name }) => [name, near(shown[name])])) };
}

function painted(read: SurfaceRead, { units }: Topology, { scalar, heights, water }: Chosen): Painted {
  const one = SCALARS.find(({ name }) => name === scalar);
  const colours = one && {
    title: one.seen,
    unit: one.unit(units),
    values: Float32Array.from(read[one.name], (value) => value ?? NaN),
  };
  const lines: Sketch[] = [];
  if (heights) lines.push(sketched("height", read.heights.pieces));
  if (water)
    for (const [kind, stays] of [["runs", false], ["stays", true]] as const)
      lines.push(sketched(kind, read.water.lines.filter((_, i) => read.water.stays[i] === stays)));
  return { colours: colours ?? null, lines };
}

function sketched(kind: Sketch["kind"], ways: Point[][]): Sketch {
  const ends: number[] = [];
  let first = 0;
  for (const { length } of ways) {
    for (let i = first; i + 1 < first + length; i++) ends.push(i, i + 1);
    first += length;
  }
  return { kind, positions: Float32Array.from(ways.flat(2)), ends: Int32Array.from(ends) };
}
