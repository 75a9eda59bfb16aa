// What is picked, marked or under the pointer, told apart from the rest by rings and a halo.
import { channels, palette } from "./colours";
import { type Form, triangles } from "./form";
import { Marks } from "./marks";
import { Segments } from "./segments";
import { Skin } from "./skin";
import type { Stage } from "./stage";
import type { Picked } from "./types";

export class Highlights {
  private readonly marked: Marks;
  private readonly picked: Marks;
  /** Light and dark below the colour of what is picked: it differs from any colour of a spring. */
  private readonly rim: Marks;
  private readonly casing: Segments[];
  private readonly hovered: Marks;
  private readonly covered: Skin;
  private under: Picked = null;
  private readonly springs: { picked: Segments; hovered: Segments };

  constructor(stage: Stage) {
    const { common, group } = stage;
    this.marked = new Marks(common, "disc", 9, true);
    this.hovered = new Marks(common, "disc", 10, true);
    this.rim = new Marks(common, "disc", 10, true);
    this.picked = new Marks(common, "disc", 11, true);
    const halo = (order = 9) => new Segments(common, new Int32Array(2), order, true);
    this.casing = [halo(7), halo(8)];
    this.springs = { picked: halo(), hovered: halo() };
    this.covered = new Skin(common, new Uint32Array());
    this.cover([]);
    group.add(this.covered.mesh, this.marked.points, this.rim.points, this.picked.points, this.hovered.points);
    group.add(...this.casing.map(({ mesh }) => mesh));
    group.add(this.springs.picked.mesh, this.springs.hovered.mesh);
  }

  mark(particles: number[], form: Form | null): void {
    this.marked.put(particles.filter((particle) => particle < (form?.particles ?? 0)));
  }

  /** Faces that are selected, by their particles. */
  cover(faces: number[][]): void {
    this.covered.put(triangles(faces));
  }

  pick(picked: Picked, form: Form | null): void {
    this.put(picked, form, [this.rim, this.picked], [...this.casing, this.springs.picked]);
  }

  hover(picked: Picked, form: Form | null): void {
    if (picked === this.under) return;
    this.under = picked;
    this.put(picked, form, [this.hovered], [this.springs.hovered]);
  }

  dress(dark: boolean): void {
    const { accent, warning, ink, ground } = palette(dark);
    const ring = (marks: Marks, colour: string, diameter: number, rim: number, inside = 0) => {
      marks.style.diameter.value = diameter;
      marks.style.rim.value = rim;
      marks.style.outline.value = [...channels(colour), 1];
      marks.style.fill.value = [...channels(colour), inside];
    };
    this.covered.style.shade.value = channels(warning);
    this.covered.style.depth.value = 0.25;
    ring(this.marked, warning, 17, 2, 0.15);
    ring(this.hovered, ink, 19, 1.2);
    ring(this.rim, ink, 25, 5.6);
    ring(this.picked, accent, 23, 2.8);
    const line = ({ style }: Segments, colour: string, width: number) => {
      style.width.value = width;
      style.plain.value = [...channels(colour), 1];
    };
    line(this.casing[0]!, ground, 12);
    line(this.casing[1]!, ink, 9);
    line(this.springs.picked, accent, 5);
    this.springs.hovered.style.width.value = 7;
    this.springs.hovered.style.plain.value = [...channels(ink), 0.22];
  }

  dispose(): void {
    const lines = [...this.casing, ...Object.values(this.springs)];
    for (const part of [this.covered, this.marked, this.rim, this.picked, this.hovered, ...lines]) part.dispose();
  }

  private put(picked: Picked, form: Form | null, marks: Marks[], lines: Segments[]): void {
    const particle = picked?.kind === "particle" && picked.index < (form?.particles ?? 0);
    for (const one of marks) one.put(particle ? [picked.index] : []);
    const ends = picked?.kind === "spring" && form ? form.springs.subarray(2 * picked.index, 2 * picked.index + 2) : [];
    for (const line of lines) {
      line.mesh.visible = ends.length === 2;
      if (line.mesh.visible) line.join(ends[0]!, ends[1]!);
    }
  }
}
