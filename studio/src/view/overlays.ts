// Beside the form: the plane in which is drawn, the section, and rings in the colours of groups.
import { effect } from "@preact/signals";
import { Plane as Flat, Vector3 } from "three";
import type { Session } from "../session";
import { channels, palette } from "./colours";
import { Marks } from "./marks";
import { Plane } from "./plane";
import type { Stage } from "./stage";
import type { Options } from "./types";

const AXES = { x: new Vector3(1, 0, 0), y: new Vector3(0, 1, 0), z: new Vector3(0, 0, 1) };
/** The working plane reaches so many steps of its grid to each side, and so many sizes of the form. */
const STEPS = 12;
const SIZES = 1.2;

export class Overlays {
  private readonly plane: Plane;
  private readonly marks: Marks[] = [];
  private readonly stop: () => void;

  /** `size` and `middle`: of the form [length]. */
  constructor(
    private readonly stage: Stage,
    private readonly options: Options,
    session: Session,
    private readonly form: { size: number },
    ask: () => void,
  ) {
    this.plane = new Plane(stage.common, 2);
    stage.group.add(this.plane.mesh);
    const effects = [
      effect(() => {
        void session.topology.value;
        this.work();
        ask();
      }),
      effect(() => {
        this.cut();
        ask();
      }),
      effect(() => {
        this.ring(session.topology.value?.particles ?? 0);
        ask();
      }),
    ];
    this.stop = () => effects.forEach((end) => end());
  }

  dispose(): void {
    this.stop();
    this.plane.dispose();
    this.marks.forEach((marks) => marks.dispose());
  }

  private work(): void {
    const { working, dark } = this.options;
    const sheet = working.value;
    const { floor } = palette(dark.value);
    this.plane.mesh.visible = sheet !== null;
    if (!sheet) return;
    const at = AXES[sheet.axis].clone().multiplyScalar(sheet.at);
    const middle = this.stage.common.centre.value;
    this.plane.lay(at, AXES[sheet.axis], middle, Math.max(STEPS * sheet.step, SIZES * this.form.size));
    // corners of the grid lie on whole steps, wherever the middle of the form is
    const { style } = this.plane;
    for (const axis of [0, 1, 2]) {
      const value = style.middle.value.getComponent(axis);
      if ("xyz"[axis] === sheet.axis) continue;
      style.middle.value.setComponent(axis, Math.round(value / (5 * sheet.step)) * 5 * sheet.step);
    }
    style.cell.value = sheet.step;
    style.shade.value = channels(floor);
    style.strength.value = 1;
  }

  private cut(): void {
    const section = this.options.section.value;
    if (!section) return void (this.stage.section = null);
    const side = section.isTurned ? -1 : 1;
    this.stage.section = new Flat(AXES[section.axis].clone().multiplyScalar(side), -side * section.at);
  }

  private ring(particles: number): void {
    const { groups, groupColours } = this.options;
    const coloured = Object.entries(groups.value).filter(([name]) => groupColours.value[name]);
    while (this.marks.length < coloured.length) {
      const marks = new Marks(this.stage.common, "disc", 8);
      this.stage.group.add(marks.points);
      this.marks.push(marks);
    }
    this.marks.forEach((marks, i) => {
      const [name, members] = coloured[i] ?? ["", []];
      marks.put(members.filter((particle) => particle < particles));
      if (!name) return;
      const colour = channels(groupColours.value[name]!);
      // rings of several groups lie within each other
      marks.style.diameter.value = 13 + 5 * (i % 3);
      marks.style.rim.value = 2.6;
      marks.style.outline.value = [...colour, 1];
      marks.style.fill.value = [...colour, 0];
    });
  }
}
