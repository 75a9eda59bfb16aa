// Two results side by side, as rows of a table: numbers of the core, with units and differences.
import type { Result, Summary, Topology } from "../model";
import { stateOf } from "./running";
import { sum } from "./tabling";

export interface Side {
  topology: Topology;
  result: Result;
  summary: Summary;
}

export interface Row {
  name: string;
  unit: string;
  /** Of the model that is shown, and of the variant; words where it is no number. */
  values: [number | string, number | string];
  /** Of the variant to the model; null if they are words. */
  difference: number | null;
}

type Measure = (side: Side) => number | string;

/** What is compared: a name, a unit in words, and how it is read. */
const MEASURES: [string, "" | "-" | "length" | "force" | "energy", Measure][] = [
  ["Particles", "", ({ result }) => result.particles.length],
  ["Springs", "", ({ topology }) => topology.springs.length],
  ["Highest particle, z", "length", ({ result }) => extreme(result.particles.map((p) => p[2]), Math.max)],
  ["Lowest particle, z", "length", ({ result }) => extreme(result.particles.map((p) => p[2]), Math.min)],
  ["Largest tension", "force", (side) => Math.max(0, extreme(axial(side), Math.max))],
  ["Largest compression", "force", (side) => Math.max(0, -extreme(axial(side), Math.min))],
  ["Largest reaction", "force", ({ result }) => extreme(result.reactions.force.map((f) => Math.hypot(...f)), Math.max)],
  ["Sum of reactions, x", "force", ({ result }) => total(result, 0)],
  ["Sum of reactions, y", "force", ({ result }) => total(result, 1)],
  ["Sum of reactions, z", "force", ({ result }) => total(result, 2)],
  // null: undefined, as one of the forces has no energy
  ["Energy", "energy", ({ result, summary }) => (summary.energy === null ? NaN : (result.energy["total"] ?? NaN))],
  ["Residual", "-", ({ result }) => result.residual],
  ["Out of balance", "force", ({ result }) => result.out_of_balance],
  ["Status", "", ({ result }) => stateOf(result)],
  ["Stability", "", ({ result }) => result.stability.replaceAll("_", " ")],
];

/** Whether the numbers of two sides have the same units. */
export const sameUnits = (one: Side, other: Side) =>
  JSON.stringify(one.topology.units) === JSON.stringify(other.topology.units);

/** All differences of two sides of the same units. */
export function differences(one: Side, other: Side): Row[] {
  const { length, force } = one.topology.units;
  const units = { "": "", "-": "-", length, force, energy: `${force}·${length}` };
  return MEASURES.map(([name, unit, read]) => {
    const values: Row["values"] = [read(one), read(other)];
    const [a, b] = values;
    const difference = typeof a === "number" && typeof b === "number" ? b - a : null;
    return { name, unit: units[unit], values, difference };
  });
}

/** The largest distance of particles of the same number [length]; null where the models have not the same number. */
export function apart({ result: a }: Side, { result: b }: Side): number | null {
  if (a.particles.length !== b.particles.length) return null;
  return extreme(
    a.particles.map((p, i) => Math.hypot(...p.map((x, axis) => x - b.particles[i]![axis]!))),
    Math.max,
  );
}

/** Forces of springs and other elements with one force each, tension + [force]. */
function axial({ topology, result }: Side): number[] {
  const found = result.forces.flatMap((force, number) => {
    const values = force["force"] as unknown[] | undefined;
    return topology.forces[number]?.role === "internal" && typeof values?.[0] === "number" ? (values as number[]) : [];
  });
  return found.length ? found : [NaN];
}

const total = ({ reactions }: Result, axis: number) => sum(reactions.force.map((force) => force[axis]!));

/** The largest or smallest of numbers; NaN of none. */
const extreme = (values: number[], of: (a: number, b: number) => number) =>
  values.length ? values.reduce((a, b) => of(a, b)) : NaN;
