// The pointer on the canvas: a press on a particle and a move drag it, a click picks, all else is the camera's.
import { type PerspectiveCamera, Ray, Vector2, Vector3 } from "three";
import { Grip } from "../hand";
import type { Session } from "../session";
import type { Led } from "./guide";
import { toggled } from "./faces";
import { led, lockOf, toggled as lockToggled } from "./locks";
import type { Dragged, Lock, Options, Picked } from "./types";

const MOUSE = { particle: 10, spring: 6, still: 4 };
const FINGER = { particle: 22, spring: 14, still: 9 };
/** Nobody drags a particle farther than so many sizes of the form. */
const FARTHEST = 20;

/** What the hand needs of the view. */
export interface Held {
  session: Session;
  options: Options;
  canvas: HTMLCanvasElement;
  camera: PerspectiveCamera;
  /** What a press there takes; x and y from the canvas' corner [CSS pixels]. */
  find(x: number, y: number, reach: { particle: number; spring: number }): Picked;
  /** The face there, by its particles. */
  face(x: number, y: number): number[] | null;
  /** Whether a press on this particle takes it: one of a crowd that cannot be told apart is picked first. */
  takes(particle: number): boolean;
  /** Where a particle is [length]. */
  at(particle: number): Vector3;
  size(): number;
  orbits(allowed: boolean): void;
  changed(): void;
}

interface Press {
  id: number;
  x: number;
  y: number;
  moved: boolean;
  reach: typeof MOUSE;
  hit: Picked;
  taken: { particle: number; from: Vector3; offset: Vector2; hand: Vector3; grip: Grip | null; before: Lock } | null;
}

export class Hand {
  hovered: Picked = null;
  private press: Press | null = null;
  private pointer: PointerEvent | null = null;
  private searching = 0;
  private readonly listeners = new AbortController();

  constructor(private readonly view: Held) {
    const on = { signal: this.listeners.signal };
    const { canvas } = view;
    // before the camera's, so that a drag never turns the view
    canvas.addEventListener("pointerdown", this.down, { ...on, capture: true });
    canvas.addEventListener("pointermove", this.move, on);
    canvas.addEventListener("pointerup", this.up, on);
    canvas.addEventListener("pointercancel", this.cancelled, on);
    canvas.addEventListener("pointerleave", () => this.hover(null), on);
    canvas.addEventListener("keydown", this.key, { ...on, capture: true });
  }

  /** The drag as it is shown; null for none. */
  get led(): Led | null {
    const taken = this.press?.taken;
    if (!taken?.grip) return null;
    const { particle, hand, from } = taken;
    return { particle: this.view.at(particle), hand, from, lock: this.view.options.lock.value };
  }

  /** The particle that is dragged; null for none. */
  get held(): Dragged | null {
    const taken = this.press?.taken;
    return taken?.grip ? { particle: taken.particle, from: taken.from.toArray() } : null;
  }

  /** Another form: what was held is let go. */
  forget(): void {
    this.release();
    this.hover(null);
  }

  dispose(): void {
    this.forget();
    cancelAnimationFrame(this.searching);
    this.listeners.abort();
  }

  private readonly down = (event: PointerEvent): void => {
    this.view.canvas.focus({ preventScroll: true });
    if (this.press) this.release();
    if (this.view.options.tool.value === "draw") return;
    if (event.button !== 0 || !event.isPrimary || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const reach = event.pointerType === "touch" ? FINGER : MOUSE;
    const { x, y } = this.within(event);
    const hit = this.view.find(x, y, reach);
    const taken = hit?.kind === "particle" && this.view.takes(hit.index) ? this.take(hit.index, x, y) : null;
    this.press = { id: event.pointerId, x, y, moved: false, reach, hit, taken };
    if (!taken) return;
    this.view.orbits(false);
    this.view.canvas.setPointerCapture(event.pointerId);
    this.cursor();
  };

  private readonly move = (event: PointerEvent): void => {
    const { press } = this;
    this.pointer = event;
    if (!press || event.pointerId !== press.id) {
      if (event.buttons === 0) this.searching ||= requestAnimationFrame(this.search);
      return;
    }
    const { x, y } = this.within(event);
    press.moved ||= Math.hypot(x - press.x, y - press.y) > press.reach.still;
    if (press.moved && press.taken) this.lead(press.taken, x, y);
  };

  private readonly up = (event: PointerEvent): void => {
    const { press } = this;
    if (event.pointerId !== press?.id) return;
    if (!press.moved) this.click(press);
    this.release();
  };

  private click({ x, y, hit }: Press): void {
    const { picked, element, markedFaces } = this.view.options;
    if (element.value === "particles") return void (picked.value = hit);
    const face = this.view.face(x, y);
    if (face) markedFaces.value = toggled(markedFaces.value, face);
  }

  private readonly cancelled = (event: PointerEvent): void => {
    if (event.pointerId === this.press?.id) this.release();
  };

  private readonly key = (event: KeyboardEvent): void => {
    const taken = this.press?.taken;
    const { lock } = this.view.options;
    const wanted = event.ctrlKey || event.altKey || event.metaKey ? null : lockOf(event.key, event.shiftKey);
    if (wanted) lock.value = lockToggled(lock.value, wanted);
    else if (event.key === "Escape" && taken) this.release(true);
    else return;
    event.preventDefault();
    event.stopPropagation();
    if (taken?.grip && this.pointer && wanted) {
      const { x, y } = this.within(this.pointer);
      this.lead(taken, x, y);
    }
    this.view.changed();
  };

  private take(particle: number, x: number, y: number): Press["taken"] {
    const from = this.view.at(particle);
    const { camera, canvas, options } = this.view;
    camera.updateMatrixWorld();
    const seen = from.clone().project(camera);
    const [atX, atY] = [((seen.x + 1) / 2) * canvas.clientWidth, ((1 - seen.y) / 2) * canvas.clientHeight];
    return {
      particle,
      from,
      offset: new Vector2(atX - x, atY - y),
      hand: from,
      grip: null,
      before: options.lock.value,
    };
  }

  private lead(taken: NonNullable<Press["taken"]>, x: number, y: number): void {
    const { camera, options, session } = this.view;
    const facing = camera.getWorldDirection(new Vector3());
    const hand = led(options.lock.value, taken.from, this.sight(x + taken.offset.x, y + taken.offset.y), facing);
    if (!hand || hand.distanceTo(taken.from) > FARTHEST * this.view.size()) return;
    taken.grip ??= new Grip(session, taken.particle);
    taken.hand = hand;
    taken.grip.lead(hand.toArray());
    this.view.changed();
  }

  /** End of a press; what was dragged stays, or is taken back. */
  private release(back = false): void {
    const taken = this.press?.taken;
    this.press = null;
    if (taken) {
      this.view.options.lock.value = taken.before;
      void (back ? taken.grip?.takeBack() : taken.grip?.drop());
      this.view.orbits(true);
      this.view.changed();
    }
    this.cursor();
  }

  private readonly search = (): void => {
    this.searching = 0;
    if (!this.pointer || this.press) return;
    const { x, y } = this.within(this.pointer);
    this.hover(this.view.find(x, y, MOUSE));
  };

  private hover(hit: Picked): void {
    if (hit?.kind === this.hovered?.kind && hit?.index === this.hovered?.index) return;
    this.hovered = hit;
    this.cursor();
    this.view.changed();
  }

  private cursor(): void {
    const { canvas, takes } = this.view;
    const hit = this.hovered;
    const over = !hit ? "" : hit.kind === "particle" && takes(hit.index) ? "grab" : "pointer";
    canvas.style.cursor = this.press?.taken ? "grabbing" : over;
  }

  private within(event: PointerEvent): { x: number; y: number } {
    const { left, top } = this.view.canvas.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  }

  /** The line of sight through a place on the canvas. */
  private sight(x: number, y: number): Ray {
    const { camera, canvas } = this.view;
    const at = new Vector3((2 * x) / canvas.clientWidth - 1, 1 - (2 * y) / canvas.clientHeight, 0.5).unproject(camera);
    return new Ray(camera.position.clone(), at.sub(camera.position).normalize());
  }
}
