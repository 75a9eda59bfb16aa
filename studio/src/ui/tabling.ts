// Springs, particles and reactions as tables: numbers of the newest frame, and at rest those of the whole state.
import type { Frame } from "../frame";
import type { Anchor, Result, Topology } from "../model";

export const TABLES = ["springs", "particles", "reactions"] as const;
export type Named = (typeof TABLES)[number];

export interface Column {
  name: string;
  /** "" for none. */
  unit: string;
  /** One number for each row; NaN for a row without a value. */
  values: ArrayLike<number>;
  /** Whether a sum means something. */
  adds?: boolean;
}

export interface Table {
  /** What a row is. */
  kind: "particle" | "spring";
  /** The particle or spring of each row. */
  rows: ArrayLike<number>;
  columns: Column[];
}

export interface Known {
  frame: Frame;
  topology: Topology;
  anchors: Anchor[];
  /** The state at rest; null while it moves. */
  result: Result | null;
}

export function tabled(what: Named, known: Known): Table {
  if (what === "springs") return springs(known);
  return what === "particles" ? particles(known) : reactions(known);
}

function springs({ frame, topology, result }: Known): Table {
  const { length, force } = topology.units;
  const p = frame.positions;
  const lengths = topology.springs.map(([a, b]) => apart(p, 3 * a, p, 3 * b));
  const columns: Column[] = [
    { name: "force", unit: force, values: frame.springForces },
    { name: "length", unit: length, values: lengths, adds: true },
  ];
  for (const name of ["strain", "utilisation"]) {
    // a spring whose rest length is 0 has no strain, which the result writes as 0
    const isNone = (value: number, i: number) => name === "strain" && value === 0 && frame.springForces[i] !== 0;
    const read = result && ofSprings(result, topology, name);
    const values = read?.map((value, i) => (isNone(value, i) ? NaN : 100 * value));
    if (values?.some(Number.isFinite)) columns.push({ name, unit: "%", values });
  }
  return { kind: "spring", rows: topology.springs.map((_, i) => i), columns };
}

/** A column of the forces of the scene, for each spring of the topology. */
function ofSprings(result: Result, topology: Topology, name: string): number[] {
  const next = new Map<number, number>();
  return topology.spring_forces.map((number) => {
    const place = next.get(number) ?? 0;
    next.set(number, place + 1);
    return (result.forces[number]?.[name] as (number | null)[] | undefined)?.[place] ?? NaN;
  });
}

function particles({ frame, topology }: Known): Table {
  const { length } = topology.units;
  const p = frame.positions;
  const axes = [0, 1, 2].map((axis) => topology.start.map((_, i) => p[3 * i + axis]!));
  const moved = topology.start.map((start, i) => apart(p, 3 * i, start, 0));
  const columns = axes.map((values, axis) => ({ name: "xyz"[axis]!, unit: length, values }));
  columns.push({ name: "displacement", unit: length, values: moved });
  return { kind: "particle", rows: moved.map((_, i) => i), columns };
}

function reactions({ frame, topology, anchors }: Known): Table {
  const unit = topology.units.force;
  const held = [...new Set(anchors.flatMap((anchor) => anchor.particles))].sort((a, b) => a - b);
  const rows = frame.reactions.length === 3 * held.length ? held : []; // or of other anchors
  const axes = [0, 1, 2].map((axis) => rows.map((_, i) => frame.reactions[3 * i + axis]!));
  const columns: Column[] = axes.map((values, axis) => ({ name: "xyz"[axis]!, unit, values, adds: true }));
  columns.push({ name: "size", unit, values: rows.map((_, i) => apart(frame.reactions, 3 * i, [0, 0, 0], 0)) });
  return { kind: "particle", rows, columns };
}

const apart = (a: ArrayLike<number>, i: number, b: ArrayLike<number>, j: number) =>
  Math.hypot(a[i]! - b[j]!, a[i + 1]! - b[j + 1]!, a[i + 2]! - b[j + 2]!);

/** The order of rows by a column (-1: by number); rows without a number come last. */
export function sorted(table: Table, column: number, isDown: boolean): number[] {
  const values = column < 0 ? table.rows : table.columns[column]!.values;
  const [known, none]: [number[], number[]] = [[], []];
  for (let i = 0; i < values.length; i++) (Number.isFinite(values[i]) ? known : none).push(i);
  return [...known.sort((a, b) => (isDown ? values[b]! - values[a]! : values[a]! - values[b]!)), ...none];
}

/** What is left of a sum whose numbers cancel, as numbers of frames have seven digits. */
const ROUNDING = 1e-6;

/** The sum of numbers; 0 where they cancel but for their rounding. */
export function sum(values: number[]): number {
  const add = (total: number, value: number) => total + value;
  const total = values.reduce(add, 0);
  return Math.abs(total) > ROUNDING * values.map(Math.abs).reduce(add, 0) ? total : 0;
}

/** The column whose histogram is shown: by which rows are sorted, else what matters first. */
export const counting = (table: Table, column: number) =>
  column >= 0 ? column : table.kind === "spring" ? 0 : table.columns.length - 1;

export interface Bin {
  low: number;
  high: number;
  holds: (value: number) => boolean;
  /** Places of its rows in the table. */
  places: number[];
}

/** The rows of a column in `count` ranges of equal width; one range if all values are equal, no range without rows. */
export function bins(values: ArrayLike<number>, count: number): Bin[] {
  const known = Array.from(values).filter(Number.isFinite);
  if (!known.length) return [];
  const [low, high] = known.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [Infinity, -Infinity]);
  const number = high > low ? count : 1;
  const step = (high - low) / number;
  const bin = (value: number) => (step > 0 ? Math.min(number - 1, Math.floor((value - low) / step)) : 0);
  const found: Bin[] = Array.from({ length: number }, (_, i) => ({
    low: low + i * step,
    high: i === number - 1 ? high : low + (i + 1) * step,
    holds: (value) => value >= low && value <= high && bin(value) === i,
    places: [],
  }));
  for (let i = 0; i < values.length; i++) if (Number.isFinite(values[i])) found[bin(values[i]!)]!.places.push(i);
  return found;
}

/** A number with no more digits than it has: frames have them in single precision. */
function digits(value: number): string {
  const isSingle = (text: string) => Math.fround(Number(text)) === value;
  const shown = [6, 7, 8, 9].map((count) => value.toPrecision(count)).find(isSingle);
  return String(shown ? Number(shown) : value);
}

/** A table in an order as CSV; units are in its first line. */
export function csv(table: Table, order: number[]): string {
  const head = [table.kind, ...table.columns.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name))];
  const cell = (value: number) => (Number.isFinite(value) ? digits(value) : "");
  const rows = order.map((i) => [table.rows[i]!, ...table.columns.map(({ values }) => values[i]!)].map(cell).join());
  return [head.join(), ...rows, ""].join("\r\n");
}
