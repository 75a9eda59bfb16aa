// Sets of particles: those inside of a line on the picture, along a row of springs, at springs of a range of forces.
import type { Point, Topology } from "../model";
import { facesOf } from "./form";

export interface Place {
  x: number;
  y: number;
}

/** Whether a place lies inside of a closed line (even and odd crossings). */
export function inside({ x, y }: Place, line: Place[]): boolean {
  let found = false;
  for (let i = 0, j = line.length - 1; i < line.length; j = i++) {
    const [a, b] = [line[i]!, line[j]!];
    if (a.y > y !== b.y > y && x < ((b.x - a.x) * (y - a.y)) / (b.y - a.y) + a.x) found = !found;
  }
  return found;
}

/** The corners of the box between two places. */
export const box = (a: Place, b: Place): Place[] => [a, { x: b.x, y: a.y }, b, { x: a.x, y: b.y }];

/** A row goes on where the next spring turns by less than this [rad]. */
const STRAIGHT = Math.PI / 4;

/** The springs that go on straight from one, both ways, as the model was drawn; each once. */
export function row({ springs, start }: Topology, first: number): number[] {
  const at = new Map<number, number[]>();
  springs.forEach((ends, spring) => ends.forEach((end) => at.set(end, [...(at.get(end) ?? []), spring])));
  const found = new Set([first]);
  for (const side of [0, 1] as const) {
    let [from, to] = side ? springs[first]! : [...springs[first]!].reverse();
    for (;;) {
      const next = straightest(at.get(to!)!, springs, start, from!, to!);
      if (next === null || found.has(next)) break;
      found.add(next);
      const [a, b] = springs[next]!;
      [from, to] = a === to ? [a, b] : [b, a];
    }
  }
  return [...found];
}

function straightest(among: number[], springs: Topology["springs"], start: Point[], from: number, to: number) {
  const along = direction(start[from]!, start[to]!);
  let best: number | null = null;
  let most = Math.cos(STRAIGHT);
  for (const spring of among) {
    const [a, b] = springs[spring]!;
    const next = a === to ? b : a;
    if (next === from || next === to) continue;
    const turned = direction(start[to]!, start[next]!).reduce((sum, part, i) => sum + part * along[i]!, 0);
    if (turned > most) [best, most] = [spring, turned];
  }
  return best;
}

function direction(a: Point, b: Point): Point {
  const d = [b[0] - a[0], b[1] - a[1], b[2] - a[2]] as Point;
  const length = Math.hypot(...d) || 1;
  return d.map((part) => part / length) as Point;
}

/** Springs whose forces lie between two ends; null: no end. */
export function between(forces: Float32Array, low: number | null, high: number | null): number[] {
  const found: number[] = [];
  forces.forEach((force, spring) => {
    if (force >= (low ?? -Infinity) && force <= (high ?? Infinity)) found.push(spring);
  });
  return found;
}

/** The particles at the ends of springs, each once, in ascending order. */
export const endsOf = (springs: Topology["springs"], chosen: number[]) =>
  [...new Set(chosen.flatMap((spring) => springs[spring] ?? []))].sort((a, b) => a - b);

/** Edges at which there is one of these faces alone. */
export function naked(faces: number[][]): [number, number][] {
  const seen = new Map<string, { edge: [number, number]; count: number }>();
  for (const face of faces) {
    const corners = [...new Set(face)];
    corners.forEach((a, i) => {
      const edge: [number, number] = [a, corners[(i + 1) % corners.length]!];
      const name = [...edge].sort((one, other) => one - other).join(" ");
      const found = seen.get(name) ?? { edge, count: 0 };
      seen.set(name, { edge, count: found.count + 1 });
    });
  }
  return [...seen.values()].filter(({ count }) => count === 1).map(({ edge }) => edge);
}

/** The particles along the edges of meshes that hang together with some particles on an edge, in ascending order. */
export function rim(topology: Pick<Topology, "meshes" | "geometry">, from: number[]): number[] {
  const next = new Map<number, number[]>();
  for (const [a, b] of naked(facesOf(topology))) {
    next.set(a, [...(next.get(a) ?? []), b]);
    next.set(b, [...(next.get(b) ?? []), a]);
  }
  const found = new Set(from.filter((particle) => next.has(particle)));
  const waiting = [...found];
  for (let one = waiting.pop(); one !== undefined; one = waiting.pop()) {
    for (const other of next.get(one) ?? []) {
      if (found.has(other)) continue;
      found.add(other);
      waiting.push(other);
    }
  }
  return [...found].sort((a, b) => a - b);
}
