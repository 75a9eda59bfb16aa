// What shows where a drag goes: a line from the particle to the hand, and the axis or plane it is locked to.
import { DataTexture, FloatType, RGBAFormat, type Vector3 } from "three";
import { channels, palette } from "./colours";
import { axisOf, normalOf } from "./locks";
import { Plane } from "./plane";
import { Segments } from "./segments";
import type { Stage } from "./stage";
import type { Lock } from "./types";

export interface Led {
  particle: Vector3;
  hand: Vector3;
  /** Where it was taken. */
  from: Vector3;
  lock: Lock;
}

export class Guide {
  private readonly points = new DataTexture(new Float32Array(16), 4, 1, RGBAFormat, FloatType);
  private readonly line: Segments;
  private readonly axis: Segments;
  private readonly plane: Plane;

  constructor(stage: Stage) {
    const shared = { ...stage.common, positions: { value: this.points } };
    this.line = new Segments(shared, Int32Array.of(0, 1), 8, true);
    this.axis = new Segments(shared, Int32Array.of(2, 3), 7);
    this.plane = new Plane(stage.common, 6);
    stage.group.add(this.line.mesh, this.axis.mesh, this.plane.mesh);
    this.show(null, 1, false);
  }

  /** Show a drag; `size` is that of the form [length]. Null for none. */
  show(led: Led | null, size: number, dark: boolean): void {
    const axis = led && axisOf(led.lock);
    const normal = led && led.lock !== "view" ? normalOf(led.lock, led.from) : null;
    this.line.mesh.visible = led !== null;
    this.axis.mesh.visible = axis !== null;
    this.plane.mesh.visible = normal !== null;
    if (!led) return;
    const accent = channels(palette(dark).accent);
    const values = this.points.image.data as Float32Array;
    led.particle.toArray(values, 0);
    led.hand.toArray(values, 4);
    if (axis)
      led.from
        .clone()
        .addScaledVector(axis, -2 * size)
        .toArray(values, 8);
    if (axis)
      led.from
        .clone()
        .addScaledVector(axis, 2 * size)
        .toArray(values, 12);
    this.points.needsUpdate = true;
    this.line.style.width.value = 1.6;
    this.line.style.plain.value = [...accent, 1];
    this.axis.style.width.value = 1.2;
    this.axis.style.plain.value = [...accent, 0.65];
    if (!normal) return;
    this.plane.lay(led.from, normal, led.from, 0.6 * size);
    this.plane.style.shade.value = accent;
    this.plane.style.strength.value = 0.45;
  }

  dispose(): void {
    this.points.dispose();
    for (const part of [this.line, this.axis, this.plane]) part.dispose();
  }
}
