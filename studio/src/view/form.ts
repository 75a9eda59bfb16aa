// What a topology has to show, by particles: springs, faces, edges and lines that no spring shows.
import type { Topology } from "../model";

export interface Form {
  particles: number;
  /** Pairs of particles. */
  springs: Int32Array;
  /** Pairs of particles: edges of faces and pieces of polylines where there is no spring. */
  edges: Int32Array;
  strokes: Int32Array;
  /** By particles; a triangle may repeat its last one. */
  faces: number[][];
  triangles: Uint32Array;
  /** The face that a triangle belongs to, by its number. */
  face(triangle: number): number[] | null;
  /** Between particles that are joined, in the middle [length]; 0 where none are. */
  spacing: number;
}

/** What there is to draw of a topology. */
export function form(topology: Topology): Form {
  const known = new Set<number>();
  const key = (a: number, b: number) => Math.min(a, b) * topology.particles + Math.max(a, b);
  const fresh = (a: number, b: number) => a !== b && a >= 0 && b >= 0 && !known.has(key(a, b)) && known.add(key(a, b));
  const springs = Int32Array.from(topology.springs.flat());
  topology.springs.forEach(([a, b]) => known.add(key(a, b)));
  const strokes: number[] = [];
  for (const [a, b] of pieces(topology)) if (fresh(a, b)) strokes.push(a, b);
  const all = facesOf(topology);
  const edges: number[] = [];
  for (const face of all)
    face.forEach((a, i) => fresh(a, face[(i + 1) % face.length]!) && edges.push(a, face[(i + 1) % face.length]!));
  const ends = springs.length ? springs : edges;
  return {
    particles: topology.particles,
    springs,
    edges: Int32Array.from(edges),
    strokes: Int32Array.from(strokes),
    faces: all,
    triangles: triangles(all),
    face: (triangle) => faceOf(all, triangle),
    spacing: median(topology, ends),
  };
}

type Meshes = Pick<Topology, "meshes" | "geometry">;

/** Faces of each topology, found once: a topology is replaced, not changed. */
const found = new WeakMap<Meshes, number[][]>();

/** Faces of all meshes, each once, by particles. A mesh that is carried is mostly one that forces act on, too. */
export function facesOf(topology: Meshes): number[][] {
  const known = found.get(topology) ?? distinct(topology);
  found.set(topology, known);
  return known;
}

function distinct(topology: Meshes): number[][] {
  const carried = topology.geometry
    .filter((item) => item.kind === "mesh" && item.faces)
    .map((item) => {
      const riders = item.particles.flat();
      return item.faces!.map((face) => face.map((corner) => riders[corner] ?? -1));
    });
  const seen = new Set<string>();
  const all: number[][] = [];
  for (const face of [...Object.values(topology.meshes).map((mesh) => mesh.faces), ...carried].flat()) {
    const name = face.join();
    if (face.some((corner) => corner < 0) || seen.has(name)) continue;
    seen.add(name);
    all.push(face);
  }
  return all;
}

/** Pairs of neighbours on polylines, curves and lines. */
function pieces(topology: Topology): [number, number][] {
  const found: [number, number][] = [];
  for (const { kind, particles } of topology.geometry) {
    const riders = particles.flat();
    const [step, last] = kind === "lines" ? [2, riders.length - 1] : [1, riders.length - 1];
    if (kind === "mesh" || kind === "points") continue;
    for (let i = 0; i < last; i += step) found.push([riders[i]!, riders[i + 1]!]);
  }
  return found;
}

/** The face that a triangle is of. */
function faceOf(all: number[][], triangle: number): number[] | null {
  let count = 0;
  return triangle < 0 ? null : (all.find((face) => (count += isFour(face) ? 2 : 1) > triangle) ?? null);
}

const isFour = ([, , c, d]: number[]) => d !== undefined && d !== c;

/** Three corners of each triangle; four-sided faces have two. */
export function triangles(all: number[][]): Uint32Array {
  const corners = new Uint32Array(6 * all.length);
  let count = 0;
  for (const face of all) {
    const [a, b, c, d] = face as [number, number, number, number];
    corners.set([a, b, c], count);
    count += 3;
    if (!isFour(face)) continue;
    corners.set([a, c, d], count);
    count += 3;
  }
  return corners.slice(0, count);
}

function median(topology: Topology, ends: ArrayLike<number>): number {
  const lengths: number[] = [];
  const step = 2 * Math.max(1, Math.floor(ends.length / 2000));
  for (let i = 0; i + 1 < ends.length; i += step) {
    const [p, q] = [topology.start[ends[i]!]!, topology.start[ends[i + 1]!]!];
    lengths.push(Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  return lengths.sort((a, b) => a - b)[lengths.length >> 1] ?? 0;
}
