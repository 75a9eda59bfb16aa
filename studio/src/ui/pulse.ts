// Whether a session that plays, and of which nothing comes, is still there: it may only be slow.
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Session } from "../session";

const AGAIN = 1000;
/** How long the service or the process of the session may send nothing [ms]. */
const PATIENCE = 3000;

/** slow: its process goes on; stuck: the service answers, but that process sends nothing; gone: no answer. */
export type Beat = "slow" | "stuck" | "gone";

export class Pulse {
  /** Since the last frame, or the order that waits where nothing plays [s]. */
  readonly age = signal(0);
  /** What the service answers; null: not known yet. */
  readonly beat = signal<Beat | null>(null);
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
        this.beat.value = null;
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
    const since = this.session.summary.peek()?.playing ? this.last : Math.min(now, this.session.asked);
    this.age.value = Math.floor((now - since) / 1000);
    if (now - this.answered > PATIENCE) this.beat.value = "gone";
    if (!this.asked) void this.ask();
  }

  /** Ask by another connection than that of the frames. */
  private async ask(): Promise<void> {
    const asked = (this.asked = performance.now());
    const found = await api.pulse(this.session.key).catch(() => null);
    if (asked !== this.asked) return; // frames have come meanwhile
    this.asked = 0;
    if (!found) return;
    this.answered = performance.now();
    const { awake, silence } = found;
    this.beat.value = !awake ? "gone" : 1000 * silence > PATIENCE ? "stuck" : "slow";
  }
}
