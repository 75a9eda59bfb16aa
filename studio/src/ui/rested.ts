// The whole state of a form that does not move, read once for each such state: stability, strains, utilisation.
import { effect, signal } from "@preact/signals";
import * as api from "../api";
import type { Result, Scene, Topology } from "../model";
import type { Session } from "../session";
import { spread } from "../view/spread";
import type { Options } from "../view/types";

/** Of larger forms it is read when it is asked for. */
const MANY = 20_000;

export class Rested {
  /** The state as it was read last, and of which moment of the session it is. */
  private readonly read = signal<{ moment: string; result: Result } | null>(null);
  private readonly asking = signal("");
  /** What the loads on faces and lines were read with. */
  private borne: { topology: Topology | null; scene: Scene | null } = { topology: null, scene: null };
  private readonly stops: (() => void)[];

  constructor(
    private readonly session: Session,
    private readonly options: Options,
  ) {
    this.stops = [
      effect(() => {
        const summary = session.summary.value;
        if (session.topology.value && summary && summary.particles <= MANY) this.ask();
      }),
      effect(() => this.bear()),
    ];
  }

  dispose(): void {
    this.stops.forEach((stop) => stop());
  }

  /** What faces and lines bear at rest; while it moves, the arrows of before move with it. */
  private bear(): void {
    const { result, session, options } = this;
    const [topology, scene] = [session.topology.value, session.scene.value];
    if (result && topology && result.particles.length === topology.particles) {
      options.spread.value = spread(result, topology);
    } else if (topology !== this.borne.topology || scene !== this.borne.scene) {
      options.spread.value = null; // other loads act by now
    }
    this.borne = { topology, scene };
  }

  /** The present state; null while it moves or is being read. */
  get result(): Result | null {
    const read = this.read.value;
    return read && read.moment === this.moment() ? read.result : null;
  }

  get isReading(): boolean {
    return this.asking.value !== "";
  }

  /** Read the present state, if it does not move. */
  ask(): void {
    const moment = this.moment();
    if (!moment || this.asking.peek() || this.read.peek()?.moment === moment) return;
    this.asking.value = moment;
    api
      .result(this.session.key)
      .then((result) => (this.read.value = { moment, result }))
      .catch(() => undefined) // the connection shows what is wrong
      .finally(() => {
        this.asking.value = "";
        if (this.moment() !== moment && this.moment()) this.ask();
      });
  }

  /** Stands for the present state; "" while it moves. */
  private moment(): string {
    const now = this.session.summary.value;
    if (!now || now.playing || this.session.isLed || this.session.connection.value !== "live") return "";
    return [now.revision, now.iteration, now.status].join(" ");
  }
}
