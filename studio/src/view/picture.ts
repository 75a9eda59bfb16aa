// All that is drawn of a session: made from its topology, filled from its frames, dressed as the options say.
import { Box3, Vector3 } from "three";
import type { Frame } from "../frame";
import type { Anchor } from "../model";
import type { Acting } from "./acting";
import { Arrows, MANY } from "./arrows";
import { channels, type Palette, palette } from "./colours";
import { Column } from "./columns";
import type { Form } from "./form";
import { Marks } from "./marks";
import { Plane } from "./plane";
import type { Coloured } from "./scaling";
import { Segments } from "./segments";
import { Skin } from "./skin";
import type { Stage } from "./stage";
import type { Colouring, Layer } from "./types";

const ARROW = 0.13;
const MOST_ARROWS = 1500;
const MANY_SPRINGS = 3000;
const FLOOR_REACH = 1.6;

export interface Dress {
  colouring: Colouring;
  layers: Record<Layer, boolean>;
  dark: boolean;
  ramp: Coloured;
  /** Length of a CSS pixel. */
  pixel: number;
}

interface Parts {
  springs: Segments;
  edges: Segments;
  strokes: Segments;
  skin: Skin;
}

export class Picture {
  form: Form | null = null;
  /** Diagonal of the form [length]. */
  size = 1;
  readonly anchors: Marks;
  readonly partial: Marks;
  readonly dots: Marks;
  readonly floor: Plane;
  reactions: Arrows | null = null;
  loads: Arrows | null = null;
  /** Particles that are held, in their order. */
  held: ReadonlySet<number> = new Set();
  private parts: Parts | null = null;
  /** Of so many loads one is drawn. */
  private thinned = 1;
  private sprung = true;
  private positions: Column | null = null;
  private forces: Column | null = null;
  private rest: Column | null = null;
  /** Numbers that stand in for the forces of springs. */
  given: Float32Array | null = null;
  private readonly box = new Box3();

  constructor(private readonly stage: Stage) {
    this.floor = new Plane(stage.common, 1);
    this.dots = new Marks(stage.common, "disc", 4);
    this.anchors = new Marks(stage.common, "square", 5);
    this.partial = new Marks(stage.common, "diamond", 5);
    stage.group.add(this.floor.mesh, this.dots.points, this.anchors.points, this.partial.points);
  }

  /** Another form. */
  build(form: Form): void {
    this.strip();
    const { common, group } = this.stage;
    this.form = form;
    this.positions = new Column(form.particles, 3);
    this.forces = new Column(form.springs.length / 2, 1);
    common.positions.value = this.positions.texture;
    const parts = (this.parts = {
      springs: new Segments(common, form.springs, 3),
      edges: new Segments(common, form.edges, 2),
      strokes: new Segments(common, form.strokes, 2),
      skin: new Skin(common, form.triangles),
    });
    parts.springs.style.forces.value = this.forces.texture;
    group.add(
      parts.springs.mesh,
      parts.springs.thin,
      parts.edges.mesh,
      parts.strokes.mesh,
      parts.skin.mesh,
    );
    this.dots.put(Int32Array.from({ length: form.particles }, (_, i) => i));
  }

  /** A frame of this form. */
  put(frame: Frame): void {
    const { renderer } = this.stage;
    this.positions!.put(renderer, frame.positions);
    if (frame.springForces.length) this.forces!.put(renderer, this.given ?? frame.springForces);
    if (!this.reactions || frame.reactions.length !== 3 * this.held.size) return;
    this.reactions.put(renderer, frame.reactions);
  }

  /** How large the form is now, and where. */
  survey(frame: Frame): void {
    this.box.setFromArray(frame.positions);
    const size = this.box.getSize(new Vector3()).length() || 1;
    if (Math.abs(size / this.size - 1) > 0.2) this.size = size;
    const middle = this.box.getCenter(new Vector3());
    const { centre } = this.stage.common;
    if (centre.value.distanceTo(middle) > 0.2 * this.size) centre.value.copy(middle);
    this.stage.group.position.copy(centre.value);
  }

  /** All that is to be seen: particles and the ends of arrows, where these are few; x y z of each [length]. */
  body(frame: Frame): ArrayLike<number> {
    const tips = [this.loads, this.reactions].flatMap((arrows) => arrows?.tips(frame.positions) ?? []);
    if (!tips.length) return frame.positions;
    const all = new Float32Array(frame.positions.length + tips.length);
    all.set(frame.positions);
    all.set(tips, frame.positions.length);
    return all;
  }

  /** The anchors now. */
  hold(anchors: Anchor[]): void {
    const axes = new Map<number, Set<string>>();
    for (const anchor of anchors) {
      for (const particle of anchor.particles) {
        const held = axes.get(particle) ?? new Set();
        for (const axis of anchor.axes) held.add(axis);
        axes.set(particle, held);
      }
    }
    const all = [...axes].filter(([, held]) => held.size);
    this.anchors.put(all.filter(([, held]) => held.size === 3).map(([particle]) => particle));
    this.partial.put(all.filter(([, held]) => held.size < 3).map(([particle]) => particle));
    this.held = new Set(all.map(([particle]) => particle).sort((a, b) => a - b));
    if (this.reactions) {
      this.stage.group.remove(this.reactions.mesh);
      this.reactions.dispose();
    }
    this.reactions = new Arrows(this.stage.common, Int32Array.from(this.held), true, 4);
    this.stage.group.add(this.reactions.mesh);
  }

  /** The loads now; of very many some are drawn. */
  bear({ particles, vectors, isSpread }: Acting): void {
    const { common, group, renderer } = this.stage;
    this.thinned = Math.max(1, Math.ceil(particles.length / MOST_ARROWS));
    const kept = particles.filter((_, i) => i % this.thinned === 0);
    if (!this.loads || kept.join() !== this.loads.particles.join()) {
      if (this.loads) group.remove(this.loads.mesh);
      this.loads?.dispose();
      this.loads = new Arrows(common, kept, false, 4);
      group.add(this.loads.mesh);
    }
    this.loads.style.faced.value = isSpread;
    this.loads.put(
      renderer,
      vectors.filter((_, i) => Math.floor(i / 3) % this.thinned === 0),
    );
  }

  /** Rest lengths [length], for strains. */
  know(lengths: Float32Array | null): void {
    this.rest?.dispose();
    this.rest = null;
    if (!lengths || !this.parts || lengths.length !== this.parts.springs.count) return;
    this.rest = new Column(lengths.length, 1);
    this.rest.put(this.stage.renderer, lengths);
    this.parts.springs.style.restLengths.value = this.rest.texture;
  }

  /** The longest arrows [force]. */
  get longest(): { load: number; reaction: number } {
    return { load: this.loads?.largest ?? 0, reaction: this.reactions?.largest ?? 0 };
  }

  /** Whether strains are known. */
  get strained(): boolean {
    return this.rest !== null;
  }

  /** Colours, sizes and what is shown. */
  dress(dress: Dress): void {
    const { form, parts } = this;
    if (!form || !parts) return;
    const colours = palette(dress.dark);
    const { layers } = dress;
    const gap = form.spacing / dress.pixel;
    this.stage.renderer.setClearColor(colours.ground);
    parts.skin.mesh.visible = layers.mesh && form.triangles.length > 0;
    parts.skin.style.shade.value = channels(colours.skin);
    this.lines(parts, dress, colours, gap);
    this.marks(dress, colours, gap);
    const apart = 1.3 * form.spacing * Math.sqrt(this.thinned);
    if (this.loads) this.arrows(this.loads, layers.loads, colours.load, apart);
    if (this.reactions) this.arrows(this.reactions, layers.reactions, colours.reaction, 4 * form.spacing);
    this.floor.style.shade.value = channels(colours.floor);
    this.floor.style.strength.value = dress.dark ? 0.75 : 0.9;
  }

  /** Whether it is drawn with as little work as can be. */
  rough(rough: boolean): void {
    this.parts?.springs.show(this.sprung, rough && this.parts.springs.count > MANY_SPRINGS);
  }

  /** Through a point across a normal [length]; null for none. */
  lay(floor: { point: Vector3; normal: Vector3 } | null, shown: boolean): void {
    this.floor.mesh.visible = floor !== null && shown;
    if (!floor) return;
    const middle = this.box.isEmpty() ? floor.point : this.box.getCenter(new Vector3());
    this.floor.lay(floor.point, floor.normal, middle, FLOOR_REACH * this.size);
  }

  dispose(): void {
    this.strip();
    this.reactions?.dispose();
    for (const part of [this.floor, this.dots, this.anchors, this.partial]) part.dispose();
  }

  private lines(parts: Parts, dress: Dress, colours: Palette, gap: number): void {
    const { springs, edges, strokes } = parts;
    const { style } = springs;
    const { colours: stops, first, last, log } = dress.ramp;
    this.sprung = dress.layers.springs && springs.count > 0;
    style.width.value = clamp(Math.max(0.1 * gap, 20 / Math.sqrt(springs.count)), 1.5, 3.4);
    const isGiven = dress.colouring === "given";
    const isStrain = dress.colouring === "strain" && this.rest;
    style.colouring.value = isGiven || dress.colouring === "force" ? 1 : isStrain ? 2 : 0;
    [style.low.value, style.high.value] = [first, last];
    style.slack.value = isGiven ? -1 : 1e-9 * (log ? 10 ** last : Math.max(Math.abs(first), Math.abs(last)));
    style.log.value = log ? 1 : 0;
    stops.forEach((stop, i) => style.stops.value[i]!.set(...channels(stop)));
    style.count.value = stops.length;
    style.plain.value = [...channels(colours.plain), 1];
    style.slackColour.value = channels(colours.slack);
    edges.mesh.visible = dress.layers.mesh && edges.count > 0 && gap > 3;
    edges.style.width.value = 1;
    edges.style.plain.value = [...channels(colours.edge), clamp((gap - 3) / 12, 0, 0.7)];
    strokes.mesh.visible = dress.layers.springs && strokes.count > 0;
    strokes.style.width.value = 1.8;
    strokes.style.plain.value = [...channels(colours.ink), 0.9];
  }

  private marks(dress: Dress, colours: Palette, gap: number): void {
    const { dots, anchors, partial, form } = this;
    const ink = channels(colours.ink);
    dots.points.visible = dress.layers.particles && form!.particles > 0 && this.dotted(dress.pixel);
    dots.style.diameter.value =
      form!.springs.length || form!.triangles.length
        ? clamp(0.2 * gap, 3.5, 8)
        : clamp(400 / Math.sqrt(form!.particles), 3, 10);
    dots.style.rim.value = clamp(0.2 * dots.style.diameter.value, 0.7, 1.2);
    dots.style.fill.value = [...channels(colours.dot), 1];
    dots.style.outline.value = [...ink, 1];
    for (const mark of [anchors, partial]) {
      mark.points.visible = dress.layers.anchors && mark.points.geometry.drawRange.count > 0;
      mark.style.diameter.value = clamp(0.7 * gap, 8, 14);
      mark.style.outline.value = [...channels(colours.ground), 1];
      mark.style.fill.value = [...ink, 1];
    }
    partial.style.fill.value = [...channels(colours.accent), 1];
    partial.style.outline.value = [...ink, 1];
  }

  /** Whether single particles can be told apart, so that each has its dot. */
  dotted(pixel: number): boolean {
    const { form } = this;
    if (!form) return false;
    return form.particles <= 60 || form.spacing / pixel > 14 || !(form.springs.length || form.triangles.length);
  }

  /** Where they are many, the longest has the length `many` at most. */
  private arrows(arrows: Arrows, shown: boolean, colour: string, many: number): void {
    const crowd = arrows.particles.length > MANY;
    const reach = crowd && many > 0 ? Math.min(ARROW * this.size, many) : ARROW * this.size;
    arrows.mesh.visible = shown && arrows.particles.length > 0 && arrows.largest > 0;
    arrows.stretch(reach);
    const part = clamp((30 / arrows.particles.length) ** 0.4, 0.5, 1);
    arrows.style.width.value = 2.2 * part;
    arrows.style.head.value = 11 * part;
    arrows.style.shade.value = [...channels(colour), crowd ? 0.7 : 1];
  }

  private strip(): void {
    const { parts } = this;
    this.positions?.dispose();
    this.forces?.dispose();
    this.know(null);
    if (this.loads) this.stage.group.remove(this.loads.mesh);
    this.loads?.dispose();
    this.loads = null;
    if (!parts) return;
    for (const part of Object.values(parts) as { mesh: Segments["mesh"] | Skin["mesh"]; dispose(): void }[]) {
      this.stage.group.remove(part.mesh);
      part.dispose();
    }
    this.stage.group.remove(parts.springs.thin);
    this.parts = null;
  }
}

const clamp = (value: number, low: number, high: number) => Math.min(high, Math.max(low, value));
