// A variant over the form: its lines alone, in one colour, through which the form is seen.
import { channels, palette } from "./colours";
import { Column } from "./columns";
import { Segments } from "./segments";
import type { Stage } from "./stage";
import type { Shadow } from "./types";

export class Ghost {
  private lines: Segments | null = null;
  private column: Column | null = null;
  private known: Shadow | null = null;

  constructor(private readonly stage: Stage) {}

  /** The lines of a variant; null for none. */
  put(shadow: Shadow | null, isNew = false): void {
    if (shadow === this.known && !isNew) return;
    this.strip();
    this.known = shadow;
    if (!shadow?.ends.length) return;
    const { common, group, renderer } = this.stage;
    this.column = new Column(shadow.positions.length / 3, 3);
    this.column.put(renderer, shadow.positions);
    this.lines = new Segments({ ...common, positions: { value: this.column.texture } }, shadow.ends, 6, true);
    group.add(this.lines.mesh);
  }

  dress(dark: boolean): void {
    if (!this.lines) return;
    this.lines.style.width.value = 1.5;
    this.lines.style.plain.value = [...channels(palette(dark).variant), 0.9];
  }

  dispose(): void {
    this.strip();
  }

  private strip(): void {
    if (this.lines) this.stage.group.remove(this.lines.mesh);
    this.lines?.dispose();
    this.column?.dispose();
    [this.lines, this.column] = [null, null];
  }
}
