// Whether a session that plays, and of which nothing comes, is still there: it may only be slow.
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Session } from "../session";

const AGAIN = 1000;
/** How long the service may take for an answer [ms]. */
const PATIENCE = 3000;

export class Pulse {
  /** Since the last frame [s]. */
  readonly age = signal(0);
  /** Whether the service answers that it goes on; null: not known yet. */
  readonly beats = signal<boolean | null>(null);
  private last = performance.now();
  private answered = 0;
  private asked = 0;
  private timer = 0;
  private readonly stops: (() => void)[];

  constructor(private readonly session: Session) {
    this.stops = [
      session.onFrame(() => (this.last = performance.now())),
      effect(() => {
        clearInterval(this.timer);
        this.asked = 0;
        this.beats.value = null;
        if (session.connection.value !== "silent") return;
        this.answered = performance.now();
        this.timer = window.setInterval(() => this.look(), AGAIN);
        this.look();
      }),
    ];
  }

  dispose(): void {
    clearInterval(this.timer);
    this.stops.forEach((stop) => stop());
  }

  private look(): void {
    const now = performance.now();
    this.age.value = Math.floor((now - this.last) / 1000);
    if (now - this.answered > PATIENCE) this.beats.value = false;
    if (!this.asked) void this.ask();
  }

  /** Ask by another connection than that of the frames. */
  private async ask(): Promise<void> {
    const asked = (this.asked = performance.now());
    const found = await api.summary(this.session.key).catch(() => null);
    if (asked !== this.asked) return; // frames have come meanwhile
    this.asked = 0;
    if (!found) return;
    this.answered = performance.now();
    this.beats.value = found.awake;
  }
}
