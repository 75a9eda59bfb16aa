// What frames do not tell, read from the whole state when it is asked for: rest lengths and loads.
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Point, Result, Topology } from "../model";
import type { Session } from "../session";
import { shares } from "../view/spread";
import type { Options } from "../view/types";

export interface Load {
  /** Of the force that acts. */
  name: string;
  vector: Point;
}

interface Reading {
  revision: number;
  result: Result;
  topology: Topology;
}

const PAUSE = 300;

export class Readings {
  /** The state as it was read last. */
  readonly read = signal<Reading | null>(null);
  private timer = 0;
  private reading = false;
  private readonly stop: () => void;

  constructor(
    private readonly session: Session,
    private readonly options: Options,
  ) {
    this.stop = effect(() => this.follow());
  }

  dispose(): void {
    this.stop();
    clearTimeout(this.timer);
  }

  /** The loads on a particle, and whether they are those of now; null: not read yet. */
  loads(particle: number): { loads: Load[]; now: boolean } | null {
    const read = this.read.value;
    if (!read) return null;
    return { loads: loadsOn(read.result, read.topology, particle), now: this.isNow(read) };
  }

  /** Whether what was read is of the present revision. */
  isCurrent(): boolean {
    return this.read.value !== null && this.isNow(this.read.value);
  }

  private isNow(read: Reading): boolean {
    return read.revision === this.session.summary.value?.revision && read.topology === this.session.topology.value;
  }

  private follow(): void {
    const { topology, connection, summary } = this.session;
    const wanted = this.options.colouring.value === "strain" || this.options.picked.value !== null;
    const read = this.read.value;
    if (read && read.topology !== topology.value) this.options.restLengths.value = null;
    void summary.value?.revision;
    if (!wanted || !topology.value || connection.value !== "live" || (read && this.isNow(read))) return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.ask(), read ? PAUSE : 0);
  }

  private async ask(): Promise<void> {
    const topology = this.session.topology.value;
    const revision = this.session.summary.value?.revision;
    if (this.reading || !topology || revision === undefined) return;
    if (this.session.isLed) {
      this.timer = window.setTimeout(() => void this.ask(), PAUSE); // all of it again and again
      return;
    }
    this.reading = true;
    try {
      const result = await api.result(this.session.key);
      if (result.particles.length !== topology.particles) return;
      this.options.restLengths.value = restLengths(result, topology);
      this.read.value = { revision, result, topology };
    } catch {
      // the connection shows what is wrong; the next revision asks again
    } finally {
      this.reading = false;
    }
  }
}

/** Rest length of each spring of the topology; NaN where its force tells none. */
function restLengths(result: Result, topology: Topology): Float32Array {
  const next = new Map<number, number>();
  return Float32Array.from(topology.spring_forces, (number) => {
    const place = next.get(number) ?? 0;
    next.set(number, place + 1);
    const { length, strain, force } = (result.forces[number] ?? {}) as Partial<Record<string, (number | null)[]>>;
    const [long, stretched] = [length?.[place], strain?.[place]];
    if (typeof long !== "number" || stretched === undefined) return NaN;
    // a rest length of 0 has no strain, which the result writes as 0
    const isNone = stretched === null || (stretched === 0 && force?.[place] !== 0);
    return isNone ? 0 : long / (1 + stretched);
  });
}

function loadsOn(result: Result, topology: Topology, particle: number): Load[] {
  const sums = new Map<string, Point>();
  for (const { particle: at, name, vector } of shares(result, topology)) {
    if (at !== particle) continue;
    const [x, y, z] = sums.get(name) ?? [0, 0, 0];
    sums.set(name, [x + vector[0], y + vector[1], z + vector[2]]);
  }
  return Array.from(sums, ([name, vector]) => ({ name, vector }));
}
