// The numbers of a session over the last minute, taken at ticks that bring a new frame.
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Session } from "../session";

export interface Sample {
  /** Seconds on this page's clock. */
  at: number;
  time: number;
  iteration: number;
  residual: number;
  kinetic: number;
  /** Null where a force has no energy; undefined until it is read. */
  total: number | null | undefined;
}

const MINUTE = 60;

export class Recording {
  /** The newest one. */
  readonly last = signal<Sample | null>(null);
  private samples: (Sample | null)[] = [];
  private taken = "";
  private energy: { value: number | null | undefined; asked: number } = { value: undefined, asked: 0 };
  private readonly watchers = new Set<() => void>();

  constructor(private readonly session: Session) {}

  /** Take samples from now on; returns how to end this. */
  begin(): () => void {
    return effect(() => {
      void this.session.ticks.value;
      const heard = this.session.connection.value === "live";
      const told = this.session.summary.value?.energy;
      if (told !== undefined && !this.session.summary.value?.playing) this.energy.value = told;
      this.take(heard);
    });
  }

  /** Called when there is a new sample; returns how to end this. */
  onNew(watcher: () => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  /** Seconds of each sample. */
  times(): number[] {
    let at = 0;
    return this.samples.map((sample) => (at = sample?.at ?? at));
  }

  /** One of its numbers over the minute; null where nothing was received. */
  of(name: Exclude<keyof Sample, "at">): (number | null)[] {
    return this.samples.map((sample) => sample?.[name] ?? null);
  }

  /** The least and the most of a number. */
  span(name: Exclude<keyof Sample, "at">): [number, number] {
    let [low, high] = [Infinity, -Infinity];
    for (const sample of this.samples) {
      const value = sample?.[name] ?? null;
      if (value === null) continue;
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
    return [low, high];
  }

  private take(heard: boolean): void {
    const { frame } = this.session;
    if (!heard || !frame) {
      // a gap in the lines shows that nothing was received
      if (!heard && this.samples.at(-1)) this.samples.push(null);
      return;
    }
    const now = `${frame.number} ${frame.revision} ${frame.iteration} ${this.energy.value}`;
    if (now === this.taken) return;
    this.taken = now;
    this.ask();
    const at = performance.now() / 1000;
    const { time, iteration, residual, kinetic } = frame;
    const sample = { at, time, iteration, residual: Math.max(residual, 1e-18), kinetic, total: this.energy.value };
    this.samples.push(sample);
    while (this.samples.length && (this.samples[0]?.at ?? 0) < at - MINUTE) this.samples.shift();
    this.last.value = sample;
    this.watchers.forEach((watcher) => watcher());
  }

  /** Frames do not have the total energy: it is read once a second while something moves. */
  private ask(): void {
    const now = performance.now();
    if (now - this.energy.asked < 1000) return;
    this.energy.asked = now;
    api.summary(this.session.key).then(
      (summary) => (this.energy.value = summary.energy ?? null),
      () => undefined, // the connection shows what is wrong
    );
  }
}
