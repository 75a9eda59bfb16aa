// What forces pull to or keep particles off, which does not move: curves, meshes, lines, planes.
import { Vector3 } from "three";
import type { Point, Scene, SceneForce } from "../model";
import { channels, palette } from "./colours";
import { Column } from "./columns";
import { Plane } from "./plane";
import { Segments } from "./segments";
import type { Stage } from "./stage";

const MOST = 8;
const REACH = 0.6;

interface Wire {
  points: Point[];
  pairs: number[];
}

export interface Flat {
  point: Point;
  normal: Point;
}

/** What of a scene guides its particles, as lines, and planes. */
export function guidesOf(scene: Scene, size: number): { wire: Wire; planes: Flat[] } {
  const wire: Wire = { points: [], pairs: [] };
  const planes: Flat[] = [];
  for (const force of scene.forces) {
    const closed = force["closed"] === true || force.kind === "collide_curve";
    if (isRows(force["curve"])) strand(wire, force["curve"], closed);
    for (const faces of meshesOf(scene, force)) strands(wire, faces);
    for (const row of (force["control_points"] ?? []) as unknown[]) if (isRows(row)) strand(wire, row, false);
    if (force.kind === "pull_to_line") lines(wire, force, size);
    const origin = force.kind === "floor" ? force["point"] : force["origin"];
    if (force["normal"] && origin && force.kind !== "collide_curve")
      pairs(origin, force["normal"]).forEach(([point, normal]) => planes.push({ point, normal }));
  }
  return { wire, planes: planes.slice(0, MOST) };
}

const isRows = (value: unknown): value is Point[] => Array.isArray(value) && Array.isArray(value[0]);

/** Points with their directions: one, or one for each; equal ones once. */
function pairs(points: unknown, directions: unknown): [Point, Point][] {
  const [p, d] = [points, directions].map((one) => (isRows(one) ? one : [one as Point]));
  const all = Array.from({ length: Math.max(p!.length, d!.length) }, (_, i): [Point, Point] => [
    p![i % p!.length]!,
    d![i % d!.length]!,
  ]);
  return [...new Map(all.map((pair) => [pair.join(), pair])).values()];
}

function strand({ points, pairs }: Wire, corners: Point[], closed: boolean): void {
  const first = points.length;
  points.push(...corners);
  for (let i = 0; i + 1 < corners.length; i++) pairs.push(first + i, first + i + 1);
  if (closed) pairs.push(points.length - 1, first);
}

function lines(wire: Wire, force: SceneForce, size: number): void {
  for (const [origin, direction] of pairs(force["origin"], force["direction"]).slice(0, 100)) {
    const along = new Vector3(...direction).setLength(size);
    const at = new Vector3(...origin);
    strand(wire, [at.clone().sub(along).toArray(), at.add(along).toArray()], false);
  }
}

/** The edges of a mesh, each once. */
function strands({ points, pairs }: Wire, { vertices, faces }: { vertices: Point[]; faces: number[][] }): void {
  const first = points.length;
  const seen = new Set<number>();
  for (const vertex of vertices) points.push(vertex);
  for (const face of faces)
    face.forEach((a, i) => {
      const b = face[(i + 1) % face.length]!;
      const key = Math.min(a, b) * vertices.length + Math.max(a, b);
      if (a === b || seen.has(key)) return;
      seen.add(key);
      pairs.push(first + a, first + b);
    });
}

type MeshOf = { vertices: Point[]; faces: number[][] };

function meshesOf(scene: Scene, force: SceneForce): MeshOf[] {
  if (!("target" in force)) return [];
  const { target, vertices, faces } = force as { target?: string | null; vertices?: Point[]; faces?: number[][] };
  const named = target ? (scene["meshes"] as Record<string, MeshOf> | undefined)?.[target] : undefined;
  return named ? [named] : vertices && faces ? [{ vertices, faces }] : [];
}

export class Guides {
  private lines: Segments | null = null;
  private column: Column | null = null;
  private planes: Plane[] = [];
  private flats: Flat[] = [];
  private known = "";

  constructor(private readonly stage: Stage) {}

  /** The guides of a scene, where they are others than before. */
  put(scene: Scene | null, size: number): void {
    const { wire, planes } = scene ? guidesOf(scene, size) : { wire: { points: [], pairs: [] }, planes: [] };
    const told = JSON.stringify([wire, planes]);
    if (told === this.known) return;
    this.strip();
    this.known = told;
    this.flats = planes;
    const { common, group, renderer } = this.stage;
    this.planes = planes.map(() => new Plane(common, 1));
    this.planes.forEach(({ mesh }) => group.add(mesh));
    if (!wire.pairs.length) return;
    this.column = new Column(wire.points.length, 3);
    this.column.put(renderer, Float32Array.from(wire.points.flat()));
    const shared = { ...common, positions: { value: this.column.texture } };
    this.lines = new Segments(shared, Int32Array.from(wire.pairs), 2);
    group.add(this.lines.mesh);
  }

  /** How many lines and planes there are. */
  get count(): number {
    return (this.lines?.count ?? 0) + this.planes.length;
  }

  dress(dark: boolean, shown: boolean, size: number): void {
    const { guide } = palette(dark);
    if (this.lines) {
      this.lines.mesh.visible = shown;
      this.lines.style.width.value = 1.4;
      this.lines.style.plain.value = [...channels(guide), 0.8];
    }
    this.planes.forEach((plane, i) => {
      const { point, normal } = this.flats[i]!;
      const at = new Vector3(...point);
      plane.mesh.visible = shown;
      plane.lay(at, new Vector3(...normal), this.stage.common.centre.value, REACH * size * 2);
      plane.style.shade.value = channels(guide);
      plane.style.strength.value = 0.6;
    });
  }

  dispose(): void {
    this.strip();
  }

  private strip(): void {
    if (this.lines) this.stage.group.remove(this.lines.mesh);
    this.planes.forEach(({ mesh }) => this.stage.group.remove(mesh));
    this.lines?.dispose();
    this.column?.dispose();
    this.planes.forEach((plane) => plane.dispose());
    [this.lines, this.column, this.planes, this.flats, this.known] = [null, null, [], [], ""];
  }
}
