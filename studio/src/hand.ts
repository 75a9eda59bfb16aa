// Drags of particles. The caller gives the target; this makes the edits.
import type { Anchor, Patch, Point } from "./model";
import type { Session } from "./session";
import { stats } from "./stats";

let gestures = 0;

/** A name for one gesture: its edits are undone as one. */
export const gesture = (what: string) => `${what}-${performance.timeOrigin.toString(36)}-${++gestures}`;

/** The anchor that holds a particle. */
export const holder = (anchors: Anchor[], particle: number) => anchors.find((a) => a.particles.includes(particle));

let moves: Promise<unknown> = Promise.resolve();

/** Do this after all that was asked for before, so that it begins where they have left the anchors. */
export function inTurn(move: () => Promise<unknown>): void {
  moves = moves.then(move, move);
}

/** An edit waits no longer than this for what the one before did to be seen [ms]. */
const LONGEST_WAIT = 300;

/** Edits of which only the newest counts: one is on its way at a time, later ones replace each other meanwhile. */
export class Newest {
  /** Whether one of them was made. */
  made = false;
  /** The revision that the session had after the last one. */
  revision = 0;
  private next: Patch | null = null;
  private running: Promise<void> | null = null;

  constructor(private readonly session: Session) {}

  /** Make this edit as soon as the one before it is acknowledged and seen. */
  put(patch: Patch): void {
    this.next = patch;
    this.running ??= this.run().finally(() => (this.running = null));
  }

  /** Whether one is on its way. */
  get busy(): boolean {
    return this.running !== null;
  }

  /** When all that was put is acknowledged or refused. */
  async settled(): Promise<void> {
    while (this.running) await this.running;
  }

  private async run(): Promise<void> {
    while (this.next) {
      const patch = this.next;
      this.next = null;
      if (!(await this.session.tell(patch))) continue;
      this.made = true;
      this.revision = this.session.answered;
      await seen();
    }
  }
}

/** Until a frame with the last edit is drawn. Edits that overtake every frame would leave nothing to draw. */
async function seen(): Promise<void> {
  const until = performance.now() + LONGEST_WAIT;
  while (stats.revisionDrawn < stats.revisionAcknowledged && performance.now() < until) {
    await new Promise((resolve) => setTimeout(resolve, 4));
  }
}

/** A particle in the hand: an anchored one takes its anchor along, a free one is pulled and let go at the end. */
export class Grip {
  private readonly edits: Newest;
  private readonly gesture = gesture("drag");
  private readonly end: () => void;
  /** What holds it when it is taken: an order that is on its way may hold or release it. */
  private readonly anchor: Promise<Anchor | undefined>;
  private target: Point | null = null;

  constructor(
    private readonly session: Session,
    readonly particle: number,
  ) {
    this.anchor = session.anchorsOfNow().then((anchors) => holder(anchors, particle));
    this.edits = new Newest(session);
    this.end = session.lead();
  }

  /** Take it to `target` [length]. */
  lead(target: Point): void {
    this.target = target;
    void this.anchor.then((anchor) => this.put(anchor?.axes ?? "xyz"));
  }

  /** Let go: an anchor stays where it was led, a free particle is free again. */
  async drop(): Promise<void> {
    const anchor = await this.anchor;
    await this.edits.settled();
    if (!anchor && this.edits.made) await this.session.tell({ release: [this.particle], gesture: this.gesture });
    this.end();
  }

  /** Let go and take back what it did. */
  async takeBack(): Promise<void> {
    await this.drop();
    if (this.edits.made) await this.session.tell("undo");
  }

  /** The newest target, once: those before it are passed over. */
  private put(axes: string): void {
    if (!this.target) return;
    const held = { particles: [this.particle], targets: [this.target], axes };
    this.target = null;
    this.edits.put({ pin: [held], gesture: this.gesture });
  }
}

/** Hold a particle where it is. */
export const pin = (session: Session, particle: number) => session.tell({ pin: [{ particles: [particle] }] });

/** Let a particle go. */
export const release = (session: Session, particle: number) => session.tell({ release: [particle] });
