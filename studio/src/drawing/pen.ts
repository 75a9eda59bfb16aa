// The pen: corners that were put, what they become, and the edits that make it. Each is undone by itself.
import { computed, effect, signal } from "@preact/signals";
import { gesture } from "../hand";
import type { Draw, Patch, Point, SceneForce, Summary } from "../model";
import type { Session } from "../session";
import type { Snapping, Spot, Working } from "./snap";

export type Mode = "point" | "line" | "face";

/** What lines or faces become: a force by its schema, without its place; null: nothing. */
export type Made = SceneForce | null;

/** A corner that was put: by the number that it has, or will have. */
export interface Corner {
  particle: number;
  at: Point;
}

export class Pen {
  readonly mode = signal<Mode>("line");
  readonly working = signal<Working>({ axis: "z", at: 0 });
  readonly snapping = signal<Snapping>({ particles: true, midpoints: true, grid: true, step: 1 });
  /** Corners of the line or face that is being drawn. */
  readonly corners = signal<Corner[]>([]);
  /** Where the next corner would be. */
  readonly spot = signal<Spot | null>(null);
  /** What is wrong, in a sentence; "" for nothing. */
  readonly fault = signal("");
  readonly last = computed(() => this.corners.value.at(-1) ?? null);
  /** What lines and faces become. */
  lines: () => Made | string = () => null;
  faces: () => Made | string = () => null;
  private queue: Promise<void> = Promise.resolve();

  constructor(private readonly session: Session) {
    // Undo takes corners back with their particles; the line goes on from the one before. A topology that comes after
    // the answer to a later edit has fewer particles than corners, too, but no fewer than the one before
    let earlier = 0;
    effect(() => {
      const count = session.topology.value?.particles ?? 0;
      const fewer = count < earlier;
      earlier = count;
      if (!fewer) return;
      const left = this.corners.peek().filter(({ particle }) => particle < count);
      if (left.length < this.corners.peek().length) this.corners.value = left;
    });
  }

  choose(mode: Mode): void {
    this.mode.value = mode;
    this.end();
  }

  /** The line or face ends here; a face of three corners is made. */
  async finish(): Promise<void> {
    await this.queue;
    if (this.mode.value === "face" && this.corners.value.length === 3) await this.face(this.corners.value);
    this.end();
  }

  end(): void {
    this.corners.value = [];
    this.fault.value = "";
  }

  /** Put a corner there. One after the other: the number of a particle follows from the edit before. */
  put(spot: Spot): Promise<void> {
    return (this.queue = this.queue.then(() => this.set(spot)));
  }

  private async set(spot: Spot): Promise<void> {
    const before = this.corners.value;
    const made = this.mode.value === "line" ? this.lines() : this.mode.value === "face" ? this.faces() : null;
    if (typeof made === "string") return void (this.fault.value = made);
    const corner = await this.corner(spot, made);
    if (!corner) return;
    if (this.mode.value === "point") return;
    if (before.at(-1)?.particle === corner.particle) return;
    this.corners.value = [...before, corner];
    if (this.mode.value === "face") {
      const closes = corner.particle === before[0]?.particle && before.length > 2;
      const corners = closes ? before : this.corners.value;
      if (closes || corners.length === 4) {
        await this.face(corners);
        this.end();
      }
    }
  }

  /** The particle of a corner, made where there is none; in line mode with the line that leads to it. */
  private async corner(given: Spot, made: Made): Promise<Corner | null> {
    const spot = this.welded(given);
    const one = gesture("draw");
    let particle = spot.what === "particle" ? spot.index : -1;
    if (spot.what === "midpoint") {
      const split = await this.edit({ divide: { springs: [spot.index] } }, one);
      if (!split) return null;
      particle = split.particles - 1;
    }
    const last = this.mode.value === "line" ? this.last.value : null;
    const isNew = particle < 0;
    const number = isNew ? this.count : particle;
    const add: NonNullable<Draw["add"]> = isNew ? { points: [spot.at] } : {};
    if (last && last.particle !== number && made) {
      const length = this.length(made, last, { particle: number, at: spot.at });
      add.forces = [{ ...made, ...length, particles: [[last.particle, number]] }];
    }
    if (Object.keys(add).length && !(await this.edit({ add }, one))) return null;
    return { particle: number, at: spot.at };
  }

  /** A place within the scene's weld tolerance of a particle is that particle, as in a scene. */
  private welded(spot: Spot): Spot {
    const { frame, scene } = this.session;
    if (!frame || spot.what === "particle" || spot.what === "midpoint") return spot;
    const index = met(frame.positions, spot.at, Number(scene.value?.["weld_tolerance"]) || 0);
    if (index < 0) return spot;
    const [x, y, z] = frame.positions.subarray(3 * index, 3 * index + 3);
    return { at: [x!, y!, z!], what: "particle", index };
  }

  private async face(corners: Corner[]): Promise<void> {
    const made = this.faces();
    if (typeof made === "string") return void (this.fault.value = made);
    const mesh = (made?.["mesh"] as string | undefined) ?? "faces";
    const add = { faces: { [mesh]: [corners.map(({ particle }) => particle)] }, forces: made ? [made] : [] };
    await this.edit({ add }, gesture("draw"));
  }

  /** A spring between particles that have moved since the start is as long as it is drawn. */
  private length(made: SceneForce, a: Corner, b: Corner): Record<string, unknown> {
    const start = this.session.topology.value?.start ?? [];
    const [p, q] = [start[a.particle] ?? a.at, start[b.particle] ?? b.at];
    const [was, is] = [apart(p, q), apart(a.at, b.at)];
    if (made.kind !== "springs" || "rest_length" in made || Math.abs(was - is) <= 1e-6 * is) return {};
    return { rest_length: [is] };
  }

  private get count(): number {
    return this.session.summary.value?.particles ?? 0;
  }

  private async edit(draw: Draw, one: string): Promise<Summary | null> {
    try {
      const patch: Patch = { draw, gesture: one };
      const made = await this.session.edit(patch);
      this.fault.value = "";
      return made;
    } catch (error) {
      this.fault.value = error instanceof Error ? error.message : String(error);
      return null;
    }
  }
}

/** Rounding of the positions in a frame, next to a coordinate. */
const ROUNDING = 2 ** -23;

/** The particle nearest to a place that is within a tolerance of it, rounding aside [length]; -1 for none. */
export function met(positions: ArrayLike<number>, [x, y, z]: Point, tolerance: number): number {
  let nearest = tolerance + ROUNDING * Math.max(Math.abs(x), Math.abs(y), Math.abs(z));
  let found = -1;
  for (let i = 0; 3 * i < positions.length; i++) {
    const away = Math.hypot(positions[3 * i]! - x, positions[3 * i + 1]! - y, positions[3 * i + 2]! - z);
    if (away <= nearest) [nearest, found] = [away, i];
  }
  return found;
}

const apart = (a: Point, b: Point) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);

const pens = new WeakMap<Session, Pen>();

/** The pen of a session's page. */
export function penOf({ session }: { session: Session }): Pen {
  const found = pens.get(session) ?? new Pen(session);
  pens.set(session, found);
  return found;
}
