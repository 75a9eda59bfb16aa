// Sets of faces, by their particles: the one under the pointer, those inside of a line, strips, those of a mesh.
import type { Topology } from "../model";
import { facesOf } from "./form";
import { type Place, inside, naked } from "./sets";

/** Stands for a face whatever corner it begins with. */
export const nameOf = (face: number[]) => [...new Set(face)].sort((a, b) => a - b).join();

/** Its corners, each once, in their order. */
export const cornersOf = (face: number[]) => [...new Set(face)];

/** Faces whose middles are drawn inside of a closed line. */
export function enclosed(faces: number[][], line: Place[], project: (particle: number) => Place | null): number[][] {
  return faces.filter((face) => {
    const corners = cornersOf(face).map(project);
    const middle = { x: 0, y: 0 };
    for (const at of corners) {
      if (!at) return false;
      middle.x += at.x / corners.length;
      middle.y += at.y / corners.length;
    }
    return inside(middle, line);
  });
}

/** The selection with some faces more, or without them. */
export function joined(faces: number[][], others: number[][], isAdded: boolean): number[][] {
  const known = new Set(others.map(nameOf));
  const rest = faces.filter((face) => !known.has(nameOf(face)));
  return isAdded ? [...rest, ...others] : rest;
}

/** A face added to the selection, or taken out of it where it was in. */
export function toggled(faces: number[][], face: number[]): number[][] {
  const without = joined(faces, [face], false);
  return without.length < faces.length ? without : [...faces, face];
}

/** Those that are still faces of the model. */
export function present(topology: Pick<Topology, "meshes" | "geometry">, faces: number[][]): number[][] {
  if (!faces.length) return faces;
  const known = new Set(facesOf(topology).map(nameOf));
  return faces.filter((face) => known.has(nameOf(face)));
}

/** By mesh, the numbers of the faces of meshes that are among some faces. */
export function numbersOf({ meshes }: Pick<Topology, "meshes">, faces: number[][]): Record<string, number[]> {
  const known = new Set(faces.map(nameOf));
  const found: Record<string, number[]> = {};
  for (const [name, mesh] of Object.entries(meshes)) {
    const numbers = mesh.faces.flatMap((face, i) => (known.has(nameOf(face)) ? [i] : []));
    if (numbers.length) found[name] = numbers;
  }
  return found;
}

/** The mesh that has exactly these faces; null for none. */
export function meshOf({ meshes }: Pick<Topology, "meshes">, faces: number[][]): string | null {
  const wanted = faces.map(nameOf).sort().join(";");
  const [found] = Object.entries(meshes).find(([, mesh]) => mesh.faces.map(nameOf).sort().join(";") === wanted) ?? [];
  return found ?? null;
}

const edgeName = (a: number, b: number) => (a < b ? `${a} ${b}` : `${b} ${a}`);

/** The strip of four-sided faces through one, from edge to opposite edge: on towards a neighbour, or across that way;
 * without a neighbour by the first or second edge. */
export function strip(faces: number[][], from: number[], neighbour: number[] | null, isAcross: boolean): number[][] {
  const at = new Map<string, number[][]>();
  for (const face of faces) {
    const corners = cornersOf(face);
    corners.forEach((a, i) => {
      const name = edgeName(a, corners[(i + 1) % corners.length]!);
      at.set(name, [...(at.get(name) ?? []), face]);
    });
  }
  const first = cornersOf(from);
  const edges = (corners: number[]) => corners.map((a, i) => edgeName(a, corners[(i + 1) % corners.length]!));
  const shared = neighbour ? edges(cornersOf(neighbour)) : [];
  const towards = Math.max(0, edges(first).findIndex((edge) => shared.includes(edge)));
  const side = (towards + (isAcross ? 1 : 0)) % 4;
  const found = new Map([[nameOf(from), from]]);
  if (first.length !== 4) return [...found.values()];
  for (const way of [side, (side + 2) % 4]) {
    let [face, edge] = [first, edges(first)[way]!];
    for (;;) {
      const [next, ...more] = at.get(edge)!.filter((other) => nameOf(other) !== nameOf(face));
      if (!next || more.length || found.has(nameOf(next))) break;
      found.set(nameOf(next), next);
      face = cornersOf(next);
      if (face.length !== 4) break;
      edge = edges(face)[(edges(face).indexOf(edge) + 2) % 4]!;
    }
  }
  return [...found.values()];
}

/** Edges at which there is one of these faces alone, as pairs of particles. */
export const rimOf = (faces: number[][]) => naked(faces.map(cornersOf));
