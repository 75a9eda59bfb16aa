// What loads put on particles, read from a state: one on a face or a line bears on all of its corners evenly.
import type { Point, Result, Topology } from "../model";
import type { Acting } from "./acting";

/** A part of a load on a particle. */
export interface Share {
  particle: number;
  /** Of the force that acts. */
  name: string;
  /** [force] */
  vector: Point;
  /** Particles that the element has. */
  corners: number;
}

type Columns = { name: string; particles?: number[][]; force?: Point[] };

/** All parts of the loads that elements of a result have. */
export function* shares(result: Result, topology: Topology): Generator<Share> {
  for (const [number, { role, kind }] of topology.forces.entries()) {
    const force = result.forces[number] as Columns | undefined;
    if (role !== "load" || !force?.force) continue;
    for (const [row, [x, y, z]] of force.force.entries()) {
      const particles = force.particles?.[row] ?? [];
      const corners = particles.length;
      const vector: Point = [x / corners, y / corners, z / corners];
      for (const particle of particles) yield { particle, name: force.name || kind, vector, corners };
    }
  }
}

/** The sums of what faces and lines bear; the topology itself has the loads on single particles. */
export const spread = (result: Result, topology: Topology) => summed(result, topology, 2);

/** The sums of all loads of a result. */
export const loaded = (result: Result, topology: Topology) => summed(result, topology, 1);

/** The sums of loads on elements of so many particles at least. */
function summed(result: Result, topology: Topology, least: number): Acting {
  const sums = new Map<number, Point>();
  let isSpread = false;
  for (const { particle, vector, corners } of shares(result, topology)) {
    if (corners < least) continue;
    isSpread ||= corners > 1;
    const sum = sums.get(particle) ?? [0, 0, 0];
    sums.set(particle, [sum[0] + vector[0], sum[1] + vector[1], sum[2] + vector[2]]);
  }
  const vectors = Float32Array.from([...sums.values()].flat());
  return { particles: Int32Array.from(sums.keys()), vectors, isSpread };
}
