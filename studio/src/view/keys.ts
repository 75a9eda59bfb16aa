// The keyboard on the canvas: all that a pointer can do.
import { Vector3 } from "three";
import { READ_ONLY } from "../guest";
import { gesture, holder, Newest } from "../hand";
import type { Session } from "../session";
import type { Eye } from "./camera";
import { axisOf, normalOf } from "./locks";
import type { Options } from "./types";

const TURN = Math.PI / 36;
const PAN = 0.06;
const ZOOM = 0.87;
const STEP = 0.01;
/** Steps that follow each other within this time are taken back as one [ms]. */
const PAUSE = 1000;
const ARROWS: Record<string, [number, number, number]> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowDown: [0, -1, 0],
  ArrowUp: [0, 1, 0],
  PageUp: [0, 0, -1],
  PageDown: [0, 0, 1],
};

/** What the keys need of the view. */
export interface Keyed {
  session: Session;
  options: Options;
  canvas: HTMLCanvasElement;
  eye: Eye;
  fit(): void;
  at(particle: number): Vector3;
  size(): number;
  say(sentence: string): void;
}

export class Keys {
  private readonly listeners = new AbortController();
  private readonly edits: Newest;
  private steps: { particle: number; at: Vector3; gesture: string; last: number } | null = null;

  constructor(private readonly view: Keyed) {
    this.edits = new Newest(view.session);
    view.canvas.addEventListener("keydown", this.key, { signal: this.listeners.signal });
  }

  dispose(): void {
    this.listeners.abort();
  }

  private readonly key = (event: KeyboardEvent): void => {
    if (event.ctrlKey || event.metaKey) return;
    if (this.arrow(event) || this.letter(event)) event.preventDefault();
  };

  private arrow(event: KeyboardEvent): boolean {
    const arrow = ARROWS[event.key];
    if (!arrow || (arrow[2] && !event.altKey)) return false;
    const [right, up] = arrow;
    if (event.altKey) this.nudge(arrow);
    else if (event.shiftKey) this.view.eye.pan(right * PAN, up * PAN);
    else this.view.eye.turn(right * TURN, up * TURN);
    return true;
  }

  private letter(event: KeyboardEvent): boolean {
    const { eye, options } = this.view;
    if (event.altKey) return false;
    if (event.key === "+" || event.key === "=") eye.zoom(ZOOM);
    else if (event.key === "-" || event.key === "_") eye.zoom(1 / ZOOM);
    else if (event.key.toLowerCase() === "f") this.view.fit();
    else if (event.key.toLowerCase() === "a") this.next(event.shiftKey ? -1 : 1);
    else if (event.key === "Escape" && options.tool.value !== "none") options.tool.value = "none";
    else if (event.key === "Escape" && options.picked.value) options.picked.value = null;
    else if (event.key === "Escape" && options.marked.value.length) options.marked.value = [];
    else return false;
    return true;
  }

  /** Pick the next held particle, or the one before. */
  private next(by: number): void {
    const { session, options, say } = this.view;
    const held = [...new Set(session.anchors.value.flatMap((anchor) => anchor.particles))].sort((a, b) => a - b);
    if (!held.length) return say("There are no anchors.");
    const picked = options.picked.value;
    const now = picked?.kind === "particle" ? held.indexOf(picked.index) : -1;
    const index = held[now < 0 ? (by > 0 ? 0 : held.length - 1) : (now + by + held.length) % held.length]!;
    options.picked.value = { kind: "particle", index };
    const at = this.view.at(index); // of no number while nothing is drawn of now
    say(Number.isFinite(at.x) ? `Anchor at particle ${index}, ${this.written(at)}.` : `Anchor at particle ${index}.`);
  }

  /** Move a picked anchor along the axes that lie most to the right, upwards and towards the eye. */
  private nudge([right, up, near]: [number, number, number]): void {
    const { session, options, size, at, say } = this.view;
    if (session.readOnly) return say(READ_ONLY);
    const picked = options.picked.value;
    const anchor = picked?.kind === "particle" ? holder(session.anchors.value, picked.index) : undefined;
    if (!picked || !anchor) return say("Pick an anchor first (A), then move it with Alt and arrows.");
    const now = performance.now();
    const goesOn = this.steps?.particle === picked.index && now - this.steps.last < PAUSE;
    const steps = goesOn
      ? this.steps!
      : { particle: picked.index, at: at(picked.index), gesture: gesture("step"), last: now };
    const [x, y, z] = this.axes();
    const by = new Vector3().addScaledVector(x, right).addScaledVector(y, up).addScaledVector(z, near);
    if (!by.lengthSq()) return say("The axis lock blocks this move.");
    if (!Number.isFinite(steps.at.x)) return;
    steps.at.addScaledVector(by, STEP * size());
    steps.last = now;
    this.steps = steps;
    const pin = { particles: [picked.index], targets: [steps.at.toArray()], axes: anchor.axes };
    this.edits.put({ pin: [pin], gesture: steps.gesture });
    say(`Particle ${picked.index} to ${this.written(steps.at)}.`);
  }

  /** World axes that lie most to the right, upwards and towards the eye; without what the lock forbids. */
  private axes(): [Vector3, Vector3, Vector3] {
    const lock = this.view.options.lock.value;
    const taken = new Set<number>();
    const found = this.view.eye.axes().map((axis) => {
      const parts = axis.toArray().map((part, i) => (taken.has(i) ? -1 : Math.abs(part)));
      const most = parts.indexOf(Math.max(...parts));
      taken.add(most);
      return new Vector3().setComponent(most, Math.sign(axis.getComponent(most)) || 1);
    });
    const along = axisOf(lock);
    const across = lock === "view" ? null : normalOf(lock, new Vector3());
    const barred = (axis: Vector3) =>
      (along !== null && !axis.dot(along)) || (across !== null && axis.dot(across) !== 0);
    return found.map((axis) => (barred(axis) ? new Vector3() : axis)) as [Vector3, Vector3, Vector3];
  }

  private written(at: Vector3): string {
    const unit = this.view.session.topology.value?.units.length ?? "";
    return `x ${number(at.x)}, y ${number(at.y)}, z ${number(at.z)} ${unit}`;
  }
}

const number = (value: number) => String(Number(value.toPrecision(4))).replace("-", "\u2212");
