// Variants of a model: other sessions, with what is compared and drawn of them. They are read, never changed.
import * as api from "./api";
import type { Frame } from "./frame";
import type { Anchor, Result, Scene, Summary, Topology } from "./model";

export interface Variant {
  summary: Summary;
  topology: Topology;
  anchors: Anchor[];
  scene: Scene;
  result: Result;
}

/** Stands for the state of a session: others have other shapes. */
export const momentOf = ({ key, revision, iteration, status }: Summary) => [key, revision, iteration, status].join(" ");

/** All of a session that is compared. */
export async function variant(summary: Summary): Promise<Variant> {
  const { key } = summary;
  const [topology, anchors, scene, result] = await Promise.all([
    api.topology(key),
    api.anchors(key),
    api.scene(key),
    api.result(key),
  ]);
  const { energy = null } = await api.summary(key); // known now: it is awake
  return { summary: { ...summary, energy }, topology, anchors, scene, result };
}

const SEPARATOR = " · ";

/** What variants of a model have in common in their labels. */
export const baseOf = (label: string) => label.split(SEPARATOR)[0]!;

/** What a variant has of its own in its label; its label where it has nothing. */
export const ownOf = (label: string) => label.split(SEPARATOR).slice(1).join(SEPARATOR) || label;

/** The label of a variant of a model. */
export const labelOf = (label: string, name: string) => `${baseOf(label)}${SEPARATOR}${name}`;

/** The force of each spring of the topology, tension + [force]. */
export const springForces = ({ topology, result }: Variant) => springColumn(result.forces, topology, "force");

/** A column of the forces of a result, for each spring of the topology; NaN where there is none. */
export function springColumn(forces: Record<string, unknown>[], topology: Topology, column: string): Float32Array {
  const next = new Map<number, number>();
  return Float32Array.from(topology.spring_forces, (number) => {
    const place = next.get(number) ?? 0;
    next.set(number, place + 1);
    return (forces[number]?.[column] as (number | null)[] | undefined)?.[place] ?? NaN;
  });
}

/** A variant as a frame that can be drawn. */
export function still(one: Variant): Frame {
  const { result, summary } = one;
  const { particles, force, exact } = result.reactions;
  const held = particles.map((_, i) => i).filter((i) => exact[i]); // as frames have them
  const order = held.sort((a, b) => particles[a]! - particles[b]!);
  return {
    number: 0,
    revision: summary.revision,
    iteration: summary.iteration,
    time: summary.time,
    residual: result.residual,
    kinetic: 0,
    status: result.status,
    playing: false,
    positions: Float32Array.from(result.particles.flat()),
    springForces: springForces(one),
    reactions: Float32Array.from(order.flatMap((i) => force[i]!)),
  };
}
