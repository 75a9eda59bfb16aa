// How far the solver is on its way to rest: the residual between where it began and its target, and the time left.
import { useRef } from "preact/hooks";
import type { Session } from "../session";
import { said } from "./words";

const WINDOW = 4000;
const SOON = 300;

/** Decades of the residual over time [ms]. */
class Track {
  private readonly samples: [number, number][] = [];
  private first = NaN;

  note(residual: number, now: number): void {
    if (!(residual > 0)) return;
    const decade = Math.log10(residual);
    if (Number.isNaN(this.first)) this.first = decade;
    this.samples.push([now, decade]);
    while (this.samples.length > 2 && this.samples[0]![0] < now - WINDOW) this.samples.shift();
  }

  /** Of the way to the target, from 0 to 1. */
  part(target: number): number {
    const last = this.samples.at(-1)?.[1] ?? this.first;
    const whole = this.first - Math.log10(target);
    return whole > 0 ? Math.min(1, Math.max(0, (this.first - last) / whole)) : 0;
  }

  /** Seconds left at the pace of the last moments; null where the residual does not fall. */
  left(target: number): number | null {
    const [first, last] = [this.samples[0], this.samples.at(-1)];
    if (!first || !last || last[0] - first[0] < SOON) return null;
    const pace = (first[1] - last[1]) / (last[0] - first[0]);
    return pace > 0 ? Math.max(0, last[1] - Math.log10(target)) / pace / 1000 : null;
  }
}

export function Solving({ session }: { session: Session }) {
  const track = useRef<Track | null>(null);
  void session.ticks.value;
  const [summary, frame] = [session.summary.value, session.frame];
  const tolerance = Number(session.scene.value?.settings["tolerance"]);
  if (!summary?.playing || !summary.solving || !frame) {
    track.current = null;
    return null;
  }
  track.current ??= new Track();
  track.current.note(frame.residual, performance.now());
  const left = tolerance > 0 ? track.current.left(tolerance) : null;
  return (
    <div class="solving" role="group" aria-label="Solver">
      <progress aria-label="Progress of the solver" value={tolerance > 0 ? track.current.part(tolerance) : 0} />
      <p class="numbers">
        Solving: residual {said(frame.residual, 2)}, target {said(tolerance, 2)} · {lasts(left)} · Pause keeps the shape
      </p>
    </div>
  );
}

function lasts(seconds: number | null): string {
  if (seconds === null) return "time left unknown";
  if (seconds < 1.5) return "about a second left";
  if (seconds < 100) return `about ${Math.round(seconds)} s left`;
  return seconds < 6000 ? `about ${Math.round(seconds / 60)} min left` : "more than an hour left";
}
