// What is picked, marked or under the pointer, told apart from the rest by rings and a halo.
import { channels, palette } from "./colours";
import type { Form } from "./form";
import { Marks } from "./marks";
import { Segments } from "./segments";
import type { Stage } from "./stage";
import type { Picked } from "./types";

export class Highlights {
  private readonly marked: Marks;
  private readonly picked: Marks;
  private readonly hovered: Marks;
  private under: Picked = null;
  private readonly springs: { picked: Segments; hovered: Segments };

  constructor(stage: Stage) {
    const { common, group } = stage;
    this.marked = new Marks(common, "disc", 9, true);
    this.hovered = new Marks(common, "disc", 10, true);
    this.picked = new Marks(common, "disc", 11, true);
    const halo = () => new Segments(common, new Int32Array(2), 9, true);
    this.springs = { picked: halo(), hovered: halo() };
    group.add(this.marked.points, this.picked.points, this.hovered.points);
    group.add(this.springs.picked.mesh, this.springs.hovered.mesh);
  }

  mark(particles: number[], form: Form | null): void {
    this.marked.put(particles.filter((particle) => particle < (form?.particles ?? 0)));
  }

  pick(picked: Picked, form: Form | null): void {
    this.put(picked, form, this.picked, this.springs.picked);
  }

  hover(picked: Picked, form: Form | null): void {
    if (picked === this.under) return;
    this.under = picked;
    this.put(picked, form, this.hovered, this.springs.hovered);
  }

  dress(dark: boolean): void {
    const { accent, warning, ink } = palette(dark);
    const ring = (marks: Marks, colour: string, diameter: number, rim: number, inside = 0) => {
      marks.style.diameter.value = diameter;
      marks.style.rim.value = rim;
      marks.style.outline.value = [...channels(colour), 1];
      marks.style.fill.value = [...channels(colour), inside];
    };
    ring(this.marked, warning, 17, 2, 0.15);
    ring(this.hovered, ink, 19, 1.2);
    ring(this.picked, accent, 22, 2.6);
    this.springs.picked.style.width.value = 9;
    this.springs.picked.style.plain.value = [...channels(accent), 0.55];
    this.springs.hovered.style.width.value = 7;
    this.springs.hovered.style.plain.value = [...channels(ink), 0.22];
  }

  dispose(): void {
    for (const part of [this.marked, this.picked, this.hovered, ...Object.values(this.springs)]) part.dispose();
  }

  private put(picked: Picked, form: Form | null, marks: Marks, halo: Segments): void {
    const particle = picked?.kind === "particle" && picked.index < (form?.particles ?? 0);
    marks.put(particle ? [picked.index] : []);
    const ends = picked?.kind === "spring" && form ? form.springs.subarray(2 * picked.index, 2 * picked.index + 2) : [];
    halo.mesh.visible = ends.length === 2;
    if (halo.mesh.visible) halo.join(ends[0]!, ends[1]!);
  }
}
