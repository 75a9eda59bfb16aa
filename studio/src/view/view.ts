// The view of a session: what is on the canvas. A picture is drawn only when something has changed.
import { effect, signal, untracked } from "@preact/signals";
import { type PerspectiveCamera, Vector3 } from "three";
import type { Frame } from "../frame";
import type { Session } from "../session";
import { note, stats } from "../stats";
import { borne } from "./acting";
import { Eye, type Place as From } from "./camera";
import { Hand, type Held } from "./dragging";
import { enclosed } from "./faces";
import { form } from "./form";
import { Ghost } from "./ghost";
import { Guide } from "./guide";
import { Guides } from "./guides";
import { Highlights } from "./highlights";
import { Keys } from "./keys";
import { numbers, remember, remembered } from "./memory";
import { Overlays } from "./overlays";
import { Picker, type Searched } from "./picking";
import { type Dress, Picture } from "./picture";
import { Scaling, strains } from "./scaling";
import { floorOf } from "./plane";
import { type Place, inside } from "./sets";
import { Stage } from "./stage";
import { Surface } from "./surface";
import { blank } from "../drawing/blank";
import { Triad } from "./triad";
import type { Dragged, Kept, Legend, Look, Options, View } from "./types";

const REST = 220;

/** Show `session` on `canvas`. An Error says in a sentence why it cannot be shown here. */
export function createView(canvas: HTMLCanvasElement, session: Session, options: Options): View {
  return new Drawing(canvas, session, options);
}

class Drawing implements View {
  readonly legend = signal<Legend | null>(null);
  readonly faces = signal<Legend | null>(null);
  readonly arrows = signal({ load: 0, reaction: 0 });
  readonly announcement = signal("");
  readonly away = signal(false);
  readonly dragged = signal<Dragged | null>(null);
  readonly rate = signal(0);
  private readonly stage: Stage;
  private readonly eye: Eye;
  private readonly picture: Picture;
  private readonly highlights: Highlights;
  private readonly guide: Guide;
  private readonly guides: Guides;
  private readonly ghost: Ghost;
  private readonly surface: Surface;
  private readonly overlays: Overlays;
  private readonly watchers = new Set<() => void>();
  private readonly triad: Triad;
  private readonly hand: Hand;
  private readonly keys: Keys;
  private readonly picker = new Picker();
  private readonly scale = new Scaling();
  private readonly undo: (() => void)[] = [];
  private frame: Frame | null = null;
  private drawn: Frame | null = null;
  /** Whether what is drawn of that frame is of before anchors or loads have changed. */
  private outdated = false;
  /** Whether the sizes and numbers of that frame are known exactly. */
  private surveyed = false;
  private fitted = false;
  /** Nobody has chosen yet from where to look; then the eye follows a form that leaves the picture. */
  private untouched = false;
  private following = false;
  /** Length of a pixel that colours and sizes were chosen for; 0 if they must be chosen again. */
  private dressed = 0;
  private asked = 0;
  private since = 0;
  private pacing = 0;
  private rest = 0;
  private counting = 0;
  private count = 0;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly session: Session,
    private readonly options: Options,
  ) {
    this.stage = new Stage(canvas);
    this.eye = new Eye(canvas, this.moved);
    this.picture = new Picture(this.stage);
    this.highlights = new Highlights(this.stage);
    this.guide = new Guide(this.stage);
    this.guides = new Guides(this.stage);
    this.ghost = new Ghost(this.stage);
    this.surface = new Surface(this.stage);
    this.triad = new Triad(this.stage);
    this.overlays = new Overlays(this.stage, options, session, this.picture, this.ask);
    this.hand = new Hand(this.handles());
    const say = (sentence: string) => (this.announcement.value = sentence);
    this.keys = new Keys({ ...this.handles(), eye: this.eye, fit: () => this.fit(), say });
    this.watchCanvas();
    this.watchSession();
  }

  get camera(): PerspectiveCamera {
    return this.eye.camera;
  }

  fit(): void {
    if (this.drawn) this.eye.fit(this.body(this.drawn));
  }

  look(from: Look): void {
    if (this.drawn) this.eye.fit(this.body(this.drawn), from);
  }

  place(): From {
    return this.eye.place;
  }

  put(place: From): void {
    this.eye.put(place);
  }

  onMoved(watcher: () => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  dressing(): Dress {
    const { options, scale, eye, stage } = this;
    const [colouring, layers, dark] = [options.colouring.value, options.layers.value, options.dark.value];
    return { colouring, layers, dark, ramp: scale.coloured(dark), pixel: eye.pixel(stage.height) };
  }

  show(particles: number[]): void {
    const { positions } = this.drawn ?? { positions: [] };
    if (particles.length)
      this.eye.fit(particles.flatMap((i) => [positions[3 * i]!, positions[3 * i + 1]!, positions[3 * i + 2]!]));
  }

  inside(line: Place[]): number[] {
    const { left, top } = this.canvas.getBoundingClientRect();
    const found: number[] = [];
    for (let i = 0; 3 * i < this.particles().length; i++) {
      const at = this.project(i);
      if (at && inside({ x: at.x - left, y: at.y - top }, line)) found.push(i);
    }
    return found;
  }

  facesInside(line: Place[]): number[][] {
    const { left, top } = this.canvas.getBoundingClientRect();
    const there = line.map(({ x, y }) => ({ x: x + left, y: y + top }));
    return enclosed(this.picture.form?.faces ?? [], there, (particle) => this.project(particle));
  }

  beyond(): number[] {
    const ends = this.picture.form?.springs;
    if (!this.drawn || !ends) return [];
    return this.scale.beyond(this.numbers(this.drawn)).flatMap((i) => [ends[2 * i]!, ends[2 * i + 1]!]);
  }

  facesBeyond(): number[] {
    return this.surface.beyond();
  }

  render(): void {
    this.draw(true);
  }

  kept(): Kept {
    const { colouring, scale, groups, groupColours, layers } = this.options;
    const [eye, colours] = [numbers(this.eye.place), groupColours.value];
    const seen = { eye, colouring: colouring.value, scale: scale.value, groups: groups.value, layers: layers.value };
    return Object.keys(colours).length ? { ...seen, groupColours: colours } : seen;
  }

  async png(): Promise<Blob> {
    this.dress();
    this.picture.rough(false);
    const made = this.stage.png(this.eye.camera);
    this.ask();
    return made;
  }

  project(particle: number): { x: number; y: number } | null {
    const positions = this.particles();
    if (!(particle >= 0 && 3 * particle + 2 < positions.length)) return null;
    return this.spot(positions.subarray(3 * particle, 3 * particle + 3));
  }

  spot(point: ArrayLike<number>): { x: number; y: number } | null {
    return this.eye.spot(point, this.canvas.getBoundingClientRect());
  }

  particles(): Float32Array {
    return this.drawn?.positions ?? new Float32Array();
  }

  dispose(): void {
    cancelAnimationFrame(this.asked);
    clearTimeout(this.rest);
    clearTimeout(this.counting);
    clearTimeout(this.pacing);
    this.undo.reverse().forEach((undo) => undo());
    const { hand, keys, guide, guides, ghost, surface, triad, highlights, overlays } = this;
    const parts = [hand, keys, guide, guides, ghost, surface, triad, highlights, overlays];
    for (const part of parts) part.dispose();
    this.eye.dispose();
    this.picture.dispose();
    this.stage.dispose();
  }

  /** Draw the topology as if it were new. */
  private rebuild(): void {
    const topology = this.session.topology.peek();
    if (!topology) return;
    const { picture, session, options } = this;
    picture.build(form(topology));
    picture.bear(untracked(() => borne(session, options))!);
    picture.hold(session.anchors.peek());
    picture.know(options.restLengths.peek());
    this.ghost.put(options.ghost.peek(), true);
    this.surface.build(picture.form);
    this.surface.put(options.painted.peek());
    this.drawn = null;
    this.scale.forget();
    this.dressed = 0;
    this.ask();
  }

  /** What hand and keys need of all this. */
  private handles(): Held {
    const { session, options, canvas, eye, picture } = this;
    const at = (particle: number) => new Vector3().fromArray(this.particles(), 3 * particle);
    return {
      session,
      options,
      canvas,
      at,
      camera: eye.camera,
      size: () => picture.size,
      find: (x, y, reach) => {
        const among = this.searched();
        return among && this.picker.find(x, y, among, reach);
      },
      face: (x, y) => this.face(x, y),
      takes: (particle) => this.takes(particle),
      orbits: (allowed) => {
        eye.controls.enabled = allowed;
        if (!allowed) eye.stay();
      },
      changed: () => {
        if (this.hand.led) this.untouched = false;
        this.ask();
      },
    };
  }

  private searched(): Searched | null {
    const { picture, stage, eye, options } = this;
    if (!this.drawn) this.draw(false); // a press may come between another topology and its picture
    if (!this.drawn || !picture.form) return null;
    const { mesh, springs } = options.layers.value;
    return {
      camera: eye.camera,
      width: stage.width,
      height: stage.height,
      positions: this.drawn.positions,
      springs: springs ? picture.form.springs : new Int32Array(),
      triangles: mesh ? picture.form.triangles : new Uint32Array(),
      held: picture.held,
      thickness: 0.01 * picture.size,
    };
  }

  private face(x: number, y: number): number[] | null {
    const among = this.searched();
    return (among && this.picture.form?.face(this.picker.triangle(x, y, among))) ?? null;
  }

  private takes(particle: number): boolean {
    if (this.session.readOnly) return false;
    if (this.options.still.peek()) return false; // what is not of now cannot be moved
    const picked = this.options.picked.value;
    const alone = this.picture.dotted(this.eye.pixel(this.stage.height));
    return alone || this.picture.held.has(particle) || (picked?.kind === "particle" && picked.index === particle);
  }

  private watchCanvas(): void {
    const observer = new ResizeObserver(() => this.resize());
    observer.observe(this.canvas);
    this.undo.push(() => observer.disconnect());
    const listeners = new AbortController();
    const { signal } = listeners;
    this.canvas.addEventListener("webglcontextlost", () => this.stage.forget(), { signal });
    this.canvas.addEventListener("webglcontextrestored", () => this.rebuild(), { signal });
    window.addEventListener("resize", this.ask, { signal }); // another screen may have finer pixels
    this.undo.push(() => listeners.abort());
    this.resize();
  }

  private watchSession(): void {
    const { session, options, picture } = this;
    this.undo.push(
      effect(() => {
        void session.topology.value;
        this.hand.forget();
        this.frame = null;
        this.rebuild();
      }),
      effect(() => {
        picture.hold(session.anchors.value);
        this.dressed = 0;
        this.outdated = true;
        this.ask();
      }),
      effect(() => {
        const loads = borne(session, options);
        if (!loads) return;
        picture.bear(loads);
        this.dressed = 0;
        this.outdated = true;
        this.ask();
      }),
      effect(() => {
        picture.know(options.restLengths.value);
        this.dressed = 0;
        this.outdated = true;
        this.scale.forget();
        this.ask();
      }),
      effect(() => {
        const isGiven = options.colouring.value === "given";
        picture.given = isGiven ? (options.given.value?.values ?? null) : null;
        this.outdated = true;
        this.scale.choose(options.scale.value);
        if (options.colouring.value === "plain") this.legend.value = null;
        this.ask();
      }),
      effect(() => {
        this.ghost.put(options.ghost.value);
        this.dressed = 0;
        this.ask();
      }),
      effect(() => {
        void options.still.value;
        this.outdated = true;
        this.ask();
      }),
      effect(() => {
        this.surface.put(options.painted.value);
        this.faces.value = this.surface.legend(options.dark.value);
        this.dressed = 0;
        this.ask();
      }),
      effect(() => {
        void session.topology.value;
        this.highlights.pick(options.picked.value, picture.form);
        this.highlights.mark(options.marked.value, picture.form);
        this.highlights.cover(options.markedFaces.value);
        this.ask();
      }),
      effect(() => {
        for (const option of [options.layers, options.dark, options.lock, session.scene]) void option.value;
        if (this.legend.peek()) this.relabel();
        this.dressed = 0;
        this.ask();
      }),
      session.onFrame((frame) => {
        this.frame = frame;
        this.ask();
      }),
    );
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.stage.resize(clientWidth, clientHeight);
    this.eye.shape(this.stage.width, this.stage.height);
    // a window that changes before anybody has chosen from where to look
    if (this.untouched) this.fitted = false;
    this.ask();
  }

  private readonly moved = (): void => {
    if (!this.following) this.untouched = false;
    this.watchers.forEach((watcher) => watcher());
    this.ask();
  };

  /** Something has changed: draw soon. */
  private readonly ask = (): void => {
    if (this.asked) return;
    this.asked = requestAnimationFrame(this.tick);
    this.since = performance.now();
  };

  private readonly tick = (now: number): void => {
    this.asked = 0;
    const glides = this.eye.step(now);
    this.following &&= glides;
    if (!this.draw(false)) return;
    this.timed(Math.max(0, now - this.since));
    clearTimeout(this.rest);
    if (glides) this.ask();
    else this.rest = window.setTimeout(this.settle, Math.max(REST, 2 * this.stage.pace.taken));
  };

  /** Nothing has moved for a moment. */
  private readonly settle = (): void => {
    this.draw(true);
    this.away.value = this.drawn !== null && !this.eye.sees(this.drawn.positions);
    remember(this.session.key, this.eye.place);
  };

  /** How long the page waited to draw, and how long it is held up by what was drawn. */
  private timed(waited: number): void {
    const began = performance.now();
    this.pacing = window.setTimeout(() => this.stage.pace.note(waited + performance.now() - began));
  }

  /** Draw what is newest; whether that was possible. */
  private draw(finely: boolean): boolean {
    const { picture, stage, eye } = this;
    const still = this.options.still.peek()?.frame;
    const frame = still ?? this.frame;
    if (!frame || frame.positions.length !== 3 * (picture.form?.particles ?? -1)) return false;
    // an edit is acknowledged and its first frame is on its way
    const isPast = !still && frame.revision < stats.revisionAcknowledged;
    if (isPast || stage.renderer.getContext().isContextLost()) return false;
    const isOther = this.drawn !== frame;
    if (isOther || this.outdated) this.upload(frame);
    const began = performance.now();
    if (!this.surveyed) this.survey(frame, finely);
    this.dress();
    if (isOther) note(stats.colourMilliseconds, performance.now() - began);
    if (!this.fitted) this.begin(frame);
    eye.reach(stage.common.centre.value, picture.size * 2);
    this.triad.place(eye);
    picture.rough(!finely && stage.pace.rough);
    stage.draw(eye.camera, finely);
    if (!still) this.counted(frame);
    return true;
  }

  /** The first sight of a form: as it was seen before, else all of it, its arrows too. */
  private begin(frame: Frame): void {
    this.fitted = true;
    const place = this.untouched ? null : remembered(this.session.key);
    if (place) this.eye.put(place);
    else this.eye.first(this.body(frame));
    this.untouched = place === null;
    this.dress();
  }

  private upload(frame: Frame): void {
    const began = performance.now();
    this.picture.put(frame);
    note(stats.uploadMilliseconds, performance.now() - began);
    if (!this.drawn || this.outdated) this.picture.survey(frame);
    this.drawn = frame;
    this.outdated = this.surveyed = false;
  }

  /** Now and then: how large all is, and which numbers occur. */
  private survey(frame: Frame, finely: boolean): void {
    const now = performance.now();
    const resting = finely || !frame.playing;
    if (!resting && !this.scale.due(now)) return;
    this.surveyed = resting;
    this.picture.survey(frame);
    if (this.scale.take(this.numbers(frame), resting, now)) this.relabel();
    const { load, reaction } = this.picture.longest;
    const told = this.arrows.value;
    if (load !== told.load || reaction !== told.reaction) this.arrows.value = { load, reaction };
    this.dressed = 0;
    this.follow(frame);
  }

  private follow(frame: Frame): void {
    if (!this.untouched || this.following || !this.eye.controls.enabled || this.eye.holds(frame.positions)) return;
    this.following = true;
    this.eye.fit(this.body(frame));
  }

  /** All that is to be seen, with a variant that is drawn over it; of a page with a corner or two its sheet. */
  private body(frame: Frame): ArrayLike<number> {
    const few = frame.positions.length < 9;
    const own = few ? [...blank(this.session.summary.peek()?.units), ...frame.positions] : this.picture.body(frame);
    const other = this.options.ghost.peek()?.positions;
    return other ? [...Array.from(own), ...other] : own;
  }

  private numbers(frame: Frame): ArrayLike<number> {
    const { restLengths, colouring, given } = this.options;
    if (colouring.value === "force") return frame.springForces;
    if (colouring.value === "given") return given.value?.values ?? [];
    const lengths = restLengths.value;
    const ends = this.picture.form!.springs;
    if (colouring.value === "plain" || !lengths || !this.picture.strained) return [];
    return strains(frame.positions, ends, lengths);
  }

  private relabel(): void {
    const { colouring, given, dark } = this.options;
    const force = colouring.value === "force";
    const own = colouring.value === "given" ? given.value : null;
    const unit = own ? own.unit : force ? (this.session.topology.value?.units.force ?? "") : "-";
    this.legend.value = this.scale.legend(own ? own.title : force ? "Force" : "Strain", unit, dark.value);
  }

  /** Colours and sizes, where they may have changed. */
  private dress(): void {
    const { options, picture, eye, stage } = this;
    const pixel = eye.pixel(stage.height);
    this.highlights.hover(this.hand.hovered, picture.form);
    const { held } = this.hand;
    if (held?.particle !== this.dragged.peek()?.particle) this.dragged.value = held;
    this.guide.show(this.hand.led, picture.size, options.dark.value);
    if (pixel === this.dressed) return;
    this.dressed = pixel;
    picture.dress(this.dressing());
    picture.lay(floorOf(this.session.scene.value), options.layers.value.floor);
    this.guides.put(this.session.scene.value, picture.size);
    this.guides.dress(options.dark.value, options.layers.value.guides, picture.size);
    this.ghost.dress(options.dark.value);
    this.surface.dress(options.dark.value);
    this.highlights.dress(options.dark.value);
    this.triad.dress(options.dark.value);
  }

  private counted(frame: Frame): void {
    stats.framesDrawn += 1;
    stats.revisionDrawn = frame.revision;
    if (frame.revision < stats.revisionAcknowledged) stats.staleFramesDrawn += 1;
    this.count += 1;
    this.counting ||= window.setTimeout(this.tally, 1000);
  }

  private readonly tally = (): void => {
    this.rate.value = this.count;
    this.counting = this.count ? window.setTimeout(this.tally, 1000) : 0;
    this.count = 0;
  };
}
