// The loads that act now: those of the topology, as edits of their forces have changed them since it was read.
import type { Point, Scene, Topology } from "../model";
import type { Session } from "../session";
import type { Options } from "./types";

export interface Acting {
  /** Those that are loaded. */
  particles: Int32Array;
  /** x y z of the sum of the loads on each [force] */
  vectors: Float32Array;
  /** Whether faces or lines bear some of them. */
  isSpread: boolean;
}

/** The loads that are drawn: those of what is shown in the place of the present shape, where it has its own. */
export function borne(session: Session, { still, spread }: Options): Acting | null {
  const [topology, scene, own, others] = [session.topology.peek(), session.scene.value, still.value, spread.value];
  return topology && (own?.loads ?? acting(topology, scene, others));
}

type Load = Topology["loads"][number];

/** The scene that each topology was read with. */
const readWith = new WeakMap<Topology, Scene>();

/** `spread`: what faces and lines bear besides. */
export function acting(topology: Topology, scene: Scene | null, spread: Acting | null = null): Acting {
  if (scene && !readWith.has(topology)) readWith.set(topology, scene);
  const before = readWith.get(topology);
  const sums = new Map<number, Point>();
  for (const load of topology.loads) {
    const vectors = scene && before ? now(load, before, scene) : load.vectors;
    load.particles.forEach((particle, i) => {
      const [x, y, z] = sums.get(particle) ?? [0, 0, 0];
      const [u, v, w] = vectors[i]!;
      sums.set(particle, [x + u, y + v, z + w]);
    });
  }
  spread?.particles.forEach((particle, i) => {
    const [x, y, z] = sums.get(particle) ?? [0, 0, 0];
    const { vectors } = spread;
    sums.set(particle, [x + vectors[3 * i]!, y + vectors[3 * i + 1]!, z + vectors[3 * i + 2]!]);
  });
  const all = [...sums].filter(([, sum]) => sum.some((value) => value !== 0));
  return {
    particles: Int32Array.from(all, ([particle]) => particle),
    vectors: Float32Array.from(all.flatMap(([, sum]) => sum)),
    isSpread: spread !== null && spread.particles.length > 0,
  };
}

/** The vectors of a load after edits: given ones as they stand, weights in proportion along their direction. */
function now(load: Load, before: Scene, scene: Scene): Point[] {
  const force = scene.forces[load.force];
  const old = before.forces[load.force];
  if (!force || !old || force === old) return load.vectors;
  const vector = force["vector"] as number[] | number[][] | undefined;
  if (vector) {
    const rows = Array.isArray(vector[0]) ? (vector as Point[]) : load.particles.map(() => vector as Point);
    return rows.length === load.particles.length ? rows : load.vectors;
  }
  const column = force["total"] === null ? "per_length" : "total";
  const factor = largest(force[column]) / (largest(old[column]) || 1);
  const [x, y, z] = (force["direction"] ?? [0, 0, -1]) as Point;
  const size = Math.hypot(x, y, z) || 1;
  return load.vectors.map((was) => {
    const length = (factor * Math.hypot(...was)) / size;
    return [length * x, length * y, length * z];
  });
}

const largest = (value: unknown) =>
  [value].flat().reduce((most: number, one) => Math.max(most, Math.abs(Number(one))), 0);
