// A recording of the session: frames as they came, thinned where they are many; bookmarks; and replay. This browser
// keeps it until it or its session is deleted.
import { computed, effect, signal } from "@preact/signals";
import type { Frame } from "../frame";
import type { Session } from "../session";
import type { Place } from "../view/camera";
import type { Options } from "../view/types";
import { numbers, placed } from "../view/memory";
import { type Reel, formOf, keepReel, keptReel } from "./reel";
import { measured } from "./words";

export interface Shot {
  /** Seconds since the recording began, without pauses of it. */
  at: number;
  frame: Frame;
}

/** A shape to come back to, and from where it was looked at. */
export interface Bookmark {
  name: string;
  frame: Frame;
  place: Place | null;
}

export const SPEEDS = [0.25, 0.5, 1, 2, 4];
const MOST_BYTES = 96e6;

const bytesOf = ({ positions, springForces, reactions }: Frame) =>
  4 * (positions.length + springForces.length + reactions.length);

export class Film {
  /** Counts changes of the shots. */
  readonly version = signal(0);
  readonly recording = signal(false);
  /** The shot that is shown; null: the present shape. */
  readonly shown = signal<number | null>(null);
  readonly replaying = signal(false);
  readonly speed = signal(1);
  readonly bookmarks = signal<Bookmark[]>([]);
  /** Whether this browser keeps what was recorded. */
  readonly kept = signal(true);
  /** Of so many frames one is kept. */
  stride = 1;
  shots: Shot[] = [];
  private bytes = 0;
  private seen = 0;
  private last = 0;
  private ended = 0;
  private form = "";
  private asked = 0;
  private began = { at: 0, now: 0 };
  private readonly stops: (() => void)[];

  constructor(
    private readonly session: Session,
    private readonly options: Options,
  ) {
    const revision = computed(() => session.summary.value?.revision);
    this.stops = [
      session.onFrame((frame) => this.recording.peek() && this.take(frame)),
      effect(() => {
        const topology = session.topology.value; // frames of another form cannot be shown
        this.empty();
        this.bookmarks.value = [];
        options.still.value = null;
        this.form = topology ? formOf(topology) : "";
        if (this.form) void this.restore(this.form);
      }),
      effect(() => {
        void revision.value; // an edit is of the present shape
        this.leave();
      }),
    ];
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    this.stops.forEach((stop) => stop());
  }

  /** Seconds of the recording. */
  get length(): number {
    return this.shots.at(-1)?.at ?? 0;
  }

  record(): void {
    this.leave();
    this.last = performance.now();
    this.seen = 0;
    this.recording.value = true;
    if (this.session.frame) this.take(this.session.frame);
  }

  stop(): void {
    this.recording.value = false;
    this.ended = this.length;
    this.changed();
    this.save();
  }

  /** Delete the recording. */
  clear(): void {
    this.empty();
    this.save();
  }

  private empty(): void {
    this.recording.value = false;
    this.leave();
    [this.shots, this.bytes, this.stride, this.ended] = [[], 0, 1, 0];
    this.changed();
  }

  /** Show a shot of the recording. */
  show(number: number): void {
    const shot = this.shots[number];
    if (!shot) return;
    this.shown.value = number;
    this.options.still.value = { frame: shot.frame, said: `Recording at ${shot.at.toFixed(2)} s` };
  }

  /** Show the present shape again. */
  leave(): void {
    this.replaying.value = false;
    cancelAnimationFrame(this.asked);
    if (this.shown.peek() !== null) this.shown.value = null;
    if (this.options.still.peek()) this.options.still.value = null;
  }

  /** Play from the shot that is shown to the end; from the beginning where it is the last. */
  replay(): void {
    if (!this.shots.length) return;
    this.stop();
    const from = this.shown.peek() ?? 0;
    const first = from >= this.shots.length - 1 ? 0 : from;
    this.show(first);
    this.began = { at: this.shots[first]!.at, now: performance.now() };
    this.replaying.value = true;
    this.asked = requestAnimationFrame(this.tick);
  }

  pause(): void {
    this.replaying.value = false;
    cancelAnimationFrame(this.asked);
  }

  /** Another speed, from here on. */
  pace(speed: number): void {
    this.began = { at: this.shots[this.shown.peek() ?? 0]?.at ?? 0, now: performance.now() };
    this.speed.value = speed;
  }

  /** Keep what is shown, and from where it is looked at. */
  mark(name: string, place: Place | null): void {
    const frame = this.options.still.peek()?.frame ?? this.session.frame;
    if (!frame) return;
    this.bookmarks.value = [...this.bookmarks.value, { name, frame, place }];
    this.save();
  }

  recall({ name, frame }: Bookmark): void {
    this.pause();
    const number = this.shots.findIndex((shot) => shot.frame === frame);
    this.shown.value = number < 0 ? null : number;
    this.options.still.value = { frame, said: `Bookmark ${name}` };
  }

  forget(bookmark: Bookmark): void {
    this.bookmarks.value = this.bookmarks.value.filter((one) => one !== bookmark);
    this.save();
  }

  /** Have this browser keep it. */
  private save(): void {
    if (!this.form || this.session.readOnly) return;
    void keepReel(this.session.key, this.whole()).then((isKept) => (this.kept.value = isKept));
  }

  private whole(): Reel {
    const { form, stride, shots } = this;
    const bookmarks = this.bookmarks.peek().map(({ name, frame, place }) => {
      return { name, frame, place: place && numbers(place) };
    });
    return { form, stride, shots, bookmarks };
  }

  /** What was recorded, for a file; null for nothing. */
  reel(): Reel | null {
    const found = this.whole();
    return found.shots.length || found.bookmarks.length ? found : null;
  }

  /** What this browser has kept of this form, unless something was recorded meanwhile. */
  private async restore(form: string): Promise<void> {
    const reel = this.session.readOnly ? null : await keptReel(this.session.key, form);
    if (!reel || form !== this.form || this.shots.length || this.bookmarks.peek().length) return;
    [this.shots, this.stride] = [reel.shots, reel.stride];
    this.bytes = reel.shots.reduce((sum, { frame }) => sum + bytesOf(frame), 0);
    this.ended = this.length;
    this.bookmarks.value = reel.bookmarks.map(({ name, frame, place }) => {
      return { name, frame, place: place && placed(place) };
    });
    this.changed();
  }

  private changed(): void {
    this.version.value = this.version.peek() + 1;
  }

  private take(frame: Frame): void {
    const now = performance.now();
    if (this.seen++ % this.stride) return;
    const before = this.shots.at(-1);
    const at = before ? this.ended + (now - this.last) / 1000 : 0;
    if (before?.frame === frame || (before && before.frame.positions.length !== frame.positions.length)) return;
    this.shots.push({ at: before ? Math.max(at, before.at) : 0, frame });
    this.bytes += bytesOf(frame);
    if (this.bytes > MOST_BYTES) this.thin();
    this.changed();
  }

  /** Of long recordings every second shot goes, and of what comes only so many are kept. */
  private thin(): void {
    this.shots = this.shots.filter((_, i) => i % 2 === 0);
    this.bytes = this.shots.reduce((sum, { frame }) => sum + bytesOf(frame), 0);
    this.stride *= 2;
  }

  private readonly tick = (now: number): void => {
    if (!this.replaying.peek()) return;
    const at = this.began.at + (Math.max(0, now - this.began.now) / 1000) * this.speed.peek();
    let number = this.shown.peek() ?? 0;
    while (number + 1 < this.shots.length && this.shots[number + 1]!.at <= at) number += 1;
    if (number !== this.shown.peek()) this.show(number);
    if (number >= this.shots.length - 1) this.replaying.value = false;
    else this.asked = requestAnimationFrame(this.tick);
  };
}

/** The time of a frame in words: that of the model, and its iteration. */
export const momentOf = ({ time, iteration }: Frame, unit: string) =>
  `${time > 0 ? `${measured(Number(time.toPrecision(4)), unit)}, ` : ""}iteration ${iteration}`;
