// The load cases and combinations of a scene, solved by the service on its frozen form, and how one of them is shown.
import { computed, effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Frame } from "../frame";
import type { Point, Result, Topology } from "../model";
import type { Session } from "../session";
import { springColumn } from "../variants";
import type { Given, Options } from "../view/types";
import { loaded } from "../view/spread";
import { said } from "./words";

/** Those of all cases together. */
const NO_LOADS = { particles: new Int32Array(), vectors: new Float32Array(), isSpread: false };

interface Extremes {
  smallest: number[];
  smallest_case: string[];
  largest: number[];
  largest_case: string[];
}

export interface Case {
  name: string;
  /** On load cases, prestress and permanent loads [-] */
  factors: Record<string, number>;
  result: Result;
  /** From the form [length] */
  displacements: Point[];
  slack: { force: number; elements: number[] }[];
}

export interface Solved {
  form: Result;
  notes: string[];
  cases: Case[];
  envelope: {
    displacement: Extremes;
    forces: { name: string; kind: string; columns: Record<string, Extremes> }[];
    reactions: { particles: number[]; force: Extremes };
  };
}

/** Shown instead of a case: the form, or the largest of all cases. */
export const [FORM, ENVELOPE] = ["form", "envelope"];

export type Column = "force" | "utilisation" | "displacement";

/** A row of the table of maxima. */
export interface Most {
  name: string;
  /** In words, as the catalogue has it. */
  unit: string;
  value: number;
  case: string;
  /** Where it is. */
  picked: { kind: "particle" | "spring"; index: number } | null;
  where: string;
}

export const namesOf = (scene: Record<string, unknown> | null) =>
  ["load_cases", "combinations"].flatMap((part) => Object.keys((scene?.[part] as object | undefined) ?? {}));

export class Casing {
  readonly solved = signal<Solved | null>(null);
  /** The revision of the scene that was solved, and whether it is that of now. */
  private readonly of = signal<unknown>(null);
  readonly current = computed(() => this.of.value === this.session.scene.value);
  readonly busy = signal(false);
  readonly fault = signal("");
  readonly shown = signal("");
  readonly column = signal<Column>("force");
  /** Displacements are drawn so many times as large. */
  readonly factor = signal(1);
  private asked: AbortController | null = null;
  private coloured = false;
  /** What this has put in the place of the present shape. */
  private own: Frame | undefined;
  private readonly stops: (() => void)[];

  constructor(
    private readonly session: Session,
    private readonly options: Options,
  ) {
    this.stops = [
      effect(() => {
        void session.topology.value;
        this.solved.value = null;
        this.shown.value = "";
      }),
      effect(() => this.show()),
      effect(() => {
        // something else is shown now: a recording, or the present shape
        if (options.still.value?.frame !== this.own && this.shown.peek()) this.shown.value = "";
      }),
    ];
  }

  dispose(): void {
    this.asked?.abort();
    this.stops.forEach((stop) => stop());
  }

  async solve(): Promise<void> {
    const scene = this.session.scene.peek();
    if (!scene || this.busy.peek()) return;
    const asked = (this.asked = new AbortController());
    this.busy.value = true;
    this.fault.value = "";
    try {
      const body = JSON.stringify({ scene });
      const headers = { "content-type": "application/json" };
      const told = { method: "POST", headers, body, signal: asked.signal };
      const answer = await api.ask("/v1/analysis/load-cases", told);
      this.solved.value = (await answer.json()) as Solved;
      this.of.value = scene;
      this.shown.value = ENVELOPE;
    } catch (error) {
      if (!asked.signal.aborted) this.fault.value = error instanceof Error ? error.message : String(error);
    } finally {
      this.busy.value = false;
    }
  }

  cancel(): void {
    this.asked?.abort();
  }

  /** Show the present shape again. */
  leave(): void {
    this.shown.value = "";
    this.options.still.value = null;
  }

  /** Columns that are known of springs; the form, which bears no case, has no utilisation. */
  get columns(): Column[] {
    const forces = this.solved.value?.form ? (this.solved.value.cases[0]?.result.forces ?? []) : [];
    const used = forces.some((one) => "utilisation" in one) && this.shown.value !== FORM;
    return used ? ["force", "utilisation", "displacement"] : ["force", "displacement"];
  }

  /** The chosen column, or forces where what is shown has none of it. */
  get seen(): Column {
    return this.columns.includes(this.column.value) ? this.column.value : "force";
  }

  private show(): void {
    const { topology } = this.session;
    const [solved, name, column, factor] = [this.solved.value, this.shown.value, this.seen, this.factor.value];
    const fits = solved && topology.value?.particles === solved.form.particles.length;
    if (!fits || !name) {
      if (this.coloured) this.uncolour();
      return;
    }
    const one = solved.cases.find((found) => found.name === name);
    const frame = (this.own = frameOf(solved, one ?? null, topology.value!, factor));
    if (name === ENVELOPE) {
      frame.reactions.fill(0); // the largest of all cases have no directions
      frame.springForces = colours(solved, name, "force", topology.value!)!.values;
    }
    const scaled = one && factor !== 1 ? `, displacements x ${said(factor)}` : "";
    const called = name === FORM ? "Form" : name === ENVELOPE ? "Form with the largest values of all cases" : name;
    const loads = name === ENVELOPE ? NO_LOADS : loaded(one?.result ?? solved.form, topology.value!);
    this.options.still.value = { frame, said: `${called}${scaled}`, loads };
    const given = colours(solved, name, column, topology.value!);
    if (given) {
      this.coloured = true;
      this.options.given.value = given;
      this.options.colouring.value = "given";
    } else this.uncolour();
  }

  private uncolour(): void {
    if (this.coloured && this.options.colouring.peek() === "given") this.options.colouring.value = "force";
    if (this.coloured) this.options.given.value = null;
    this.coloured = false;
  }
}

/** A case, or the form, as a frame that can be drawn. */
function frameOf({ form }: Solved, one: Case | null, topology: Topology, factor: number): Frame {
  const result = one?.result ?? form;
  const { particles, force, exact } = result.reactions;
  const held = particles.map((_, i) => i).filter((i) => exact[i]); // as frames have them
  const order = held.sort((a, b) => particles[a]! - particles[b]!);
  const moved = (point: Point, i: number) =>
    one ? form.particles[i]!.map((x, axis) => x + factor * one.displacements[i]![axis]!) : point;
  return {
    number: 0,
    revision: 0,
    iteration: 0,
    time: 0,
    residual: result.residual,
    kinetic: 0,
    status: result.status,
    playing: false,
    positions: Float32Array.from(result.particles.flatMap(moved)),
    springForces: springColumn(result.forces, topology, "force"),
    reactions: Float32Array.from(order.flatMap((i) => force[i]!)),
  };
}

const TITLES: Record<Column, string> = { force: "Force", utilisation: "Utilisation", displacement: "Displacement" };

/** Colours of springs by a column; null for the forces of one case, which the frame has. */
function colours(solved: Solved, name: string, column: Column, topology: Topology): Given | null {
  const one = solved.cases.find((found) => found.name === name);
  const { length, force } = topology.units;
  if (column === "displacement") {
    const far = one
      ? one.displacements.map((by) => Math.hypot(...by))
      : name === ENVELOPE
        ? solved.envelope.displacement.largest
        : solved.form.particles.map(() => 0);
    const values = Float32Array.from(topology.springs, ([a, b]) => (far[a]! + far[b]!) / 2);
    return { title: TITLES.displacement, unit: length, values };
  }
  if (name !== ENVELOPE) {
    if (column === "force") return null;
    const values = springColumn((one?.result ?? solved.form).forces, topology, column);
    return { title: TITLES[column], unit: "%", values: values.map((value) => 100 * value) };
  }
  const of = (part: "largest" | "smallest") => {
    const rows = solved.envelope.forces.map(({ columns }) => ({ [column]: columns[column]?.[part] }));
    return springColumn(rows, topology, column);
  };
  const [high, low] = [of("largest"), of("smallest")];
  if (column === "utilisation") return { title: "Largest utilisation", unit: "%", values: high.map((v) => 100 * v) };
  const values = high.map((value, i) => (Math.abs(low[i]!) > Math.abs(value) ? low[i]! : value));
  return { title: "Largest force", unit: force, values };
}

/** The largest of every quantity over all cases, where it is and in which case. */
export function maxima({ envelope }: Solved, topology: Topology): Most[] {
  const rows: Most[] = [];
  const particle = (index: number) => ({ kind: "particle" as const, index });
  const { displacement, reactions } = envelope;
  const far = largest(displacement.largest);
  if (far >= 0) {
    const [value, of] = [displacement.largest[far]!, displacement.largest_case[far]!];
    const there = { picked: particle(far), where: `particle ${far}` };
    rows.push({ name: "Displacement", unit: "length", value, case: of, ...there });
  }
  envelope.forces.forEach(({ name, kind, columns }, number) => {
    if (topology.forces[number]?.role === "load") return;
    for (const [column, unit] of [["force", "force"], ["moment", "moment"], ["utilisation", "%"]] as const) {
      const found = columns[column];
      const place = largest(found?.largest ?? []);
      if (!found || place < 0) continue;
      const spring = springOf(topology, number, place);
      const picked = spring < 0 ? null : { kind: "spring" as const, index: spring };
      const where = spring < 0 ? `element ${place}` : `spring ${spring}`;
      const base = { unit, picked, where };
      const called = `${name || kind}: ${column}`;
      const times = column === "utilisation" ? 100 : 1;
      const [high, of] = [times * found.largest[place]!, found.largest_case[place]!];
      rows.push({ ...base, name: called, value: high, case: of });
      const least = largest(found.smallest.map((value) => -value));
      if (column === "force" && found.smallest[least]! < 0) {
        const at = springOf(topology, number, least);
        rows.push({
          name: `${name || kind}: compression`,
          unit,
          value: found.smallest[least]!,
          case: found.smallest_case[least]!,
          picked: at < 0 ? null : { kind: "spring", index: at },
          where: at < 0 ? `element ${least}` : `spring ${at}`,
        });
      }
    }
  });
  const at = largest(reactions.force.largest);
  if (at >= 0) {
    const index = reactions.particles[at]!;
    const [value, of] = [reactions.force.largest[at]!, reactions.force.largest_case[at]!];
    const there = { picked: particle(index), where: `particle ${index}` };
    rows.push({ name: "Reaction", unit: "force", value, case: of, ...there });
  }
  return rows;
}

/** The spring of the topology that is an element of a force; -1 for none. */
function springOf(topology: Topology, number: number, place: number): number {
  const first = topology.spring_forces.indexOf(number);
  return first >= 0 && topology.spring_forces[first + place] === number ? first + place : -1;
}

/** The place of the largest; -1 without numbers. */
function largest(values: number[]): number {
  let found = -1;
  values.forEach((value, i) => {
    if (Number.isFinite(value) && (found < 0 || value > values[found]!)) found = i;
  });
  return found;
}
