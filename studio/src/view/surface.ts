// What is read off the surface: faces in the colours of numbers at their particles, and lines on them.
import { BufferAttribute, BufferGeometry, DataTexture, type IUniform, Mesh, Vector3 } from "three";
import type { RawShaderMaterial } from "three";
import { channels, palette } from "./colours";
import { Column } from "./columns";
import type { Form } from "./form";
import { material } from "./material";
import { Scaling } from "./scaling";
import { Segments } from "./segments";
import type { Stage } from "./stage";
import type { Legend, Painted, Sketch } from "./types";

const VERTEX = `
uniform sampler2D values;
out vec3 at;
out vec3 own;
out float value;
out float known;
void main() {
  own = particle(gl_VertexID);
  at = seen(own);
  float given = texelFetch(values, place(gl_VertexID), 0).x;
  known = isnan(given) ? 0.0 : 1.0;
  value = isnan(given) ? 0.0 : given;
  gl_Position = projectionMatrix * vec4(at, 1.0);
}`;

// lit as plain faces are, but less, so that colours can be compared
const FRAGMENT = `
in vec3 at;
in vec3 own;
in float value;
in float known;
uniform mat4 modelViewMatrix;
uniform vec3 stops[9], none;
uniform float low, high;
uniform int count;
void main() {
  vec3 normal = mat3(modelViewMatrix) * cross(dFdx(own), dFdy(own));
  normal /= max(length(normal), 1e-30);
  if (dot(normal, at) > 0.0) normal = -normal;
  float shine = max(dot(normal, vec3(-0.45, 0.65, 0.62)), 0.0);
  float way = clamp((value - low) / (high - low), 0.0, 1.0) * float(count - 1);
  int i = min(int(way), count - 2);
  vec3 shade = known < 0.999 ? none : mix(stops[i], stops[i + 1], way - float(i));
  colour = vec4(shade * (0.85 + 0.15 * shine), 1.0);
}`;

const nothing = new DataTexture(new Uint8Array(4), 1, 1);

interface Drawn {
  sketch: Sketch;
  column: Column;
  lines: Segments;
}

export class Surface {
  private readonly style = {
    values: { value: nothing } as IUniform,
    stops: { value: Array.from({ length: 9 }, () => new Vector3()) },
    none: { value: [1, 1, 1] as [number, number, number] },
    low: { value: 0 },
    high: { value: 1 },
    count: { value: 2 },
  };
  private readonly scale = new Scaling();
  private mesh: Mesh<BufferGeometry, RawShaderMaterial> | null = null;
  private values: Column | null = null;
  private known: Painted | null = null;
  private drawn: Drawn[] = [];

  constructor(private readonly stage: Stage) {}

  /** Another form: its faces. */
  build(form: Form | null): void {
    this.strip();
    this.known = null;
    if (!form?.triangles.length) return;
    const geometry = new BufferGeometry();
    geometry.setIndex(new BufferAttribute(form.triangles, 1));
    const made = material(this.stage.common, { vertex: VERTEX, fragment: FRAGMENT, uniforms: this.style });
    made.polygonOffset = true; // over the plain faces, below lines on them
    made.polygonOffsetFactor = made.polygonOffsetUnits = 0.5;
    this.mesh = new Mesh(geometry, made);
    this.mesh.frustumCulled = this.mesh.visible = false;
    this.values = new Column(form.particles, 1);
    this.style.values.value = this.values.texture;
    this.stage.group.add(this.mesh);
  }

  /** What is to be seen on it; null for nothing. */
  put(painted: Painted | null): void {
    if (painted === this.known) return;
    if (painted?.colours?.title !== this.known?.colours?.title) this.scale.forget();
    if (painted?.lines !== this.known?.lines) this.sketch(painted?.lines ?? []);
    this.known = painted;
    const { mesh, values, stage } = this;
    const numbers = painted?.colours?.values;
    if (mesh) mesh.visible = numbers !== undefined && numbers.length === values?.rows;
    if (!numbers || !mesh?.visible) return;
    values?.put(stage.renderer, numbers);
    this.scale.take(numbers, true, performance.now());
  }

  dress(dark: boolean): void {
    const colours = palette(dark);
    const { colours: stops, first, last } = this.scale.coloured(dark);
    const { style } = this;
    [style.low.value, style.high.value, style.count.value] = [first, last, stops.length];
    stops.forEach((stop, i) => style.stops.value[i]!.set(...channels(stop)));
    style.none.value = channels(colours.skin);
    const shades = { height: colours.ink, runs: colours.water, stays: colours.warning };
    for (const { sketch, lines } of this.drawn) {
      lines.style.width.value = sketch.kind === "stays" ? 2.5 : 1.4;
      lines.style.plain.value = [...channels(shades[sketch.kind]), 0.95];
    }
  }

  /** The scale of the faces; null where they have no colours. */
  legend(dark: boolean): Legend | null {
    const colours = this.known?.colours;
    return colours && this.mesh?.visible ? this.scale.legend(colours.title, colours.unit, dark) : null;
  }

  /** Particles whose values lie beyond the scale. */
  beyond(): number[] {
    return this.scale.beyond(this.known?.colours?.values ?? []);
  }

  dispose(): void {
    this.strip();
  }

  private sketch(lines: Sketch[]): void {
    const { common, group, renderer } = this.stage;
    this.erase();
    this.drawn = lines
      .filter(({ ends }) => ends.length)
      .map((sketch) => {
        const column = new Column(sketch.positions.length / 3, 3);
        column.put(renderer, sketch.positions);
        const made = new Segments({ ...common, positions: { value: column.texture } }, sketch.ends, 2);
        group.add(made.mesh);
        return { sketch, column, lines: made };
      });
  }

  private erase(): void {
    for (const { column, lines } of this.drawn) {
      this.stage.group.remove(lines.mesh);
      lines.dispose();
      column.dispose();
    }
    this.drawn = [];
  }

  private strip(): void {
    this.erase();
    if (this.mesh) this.stage.group.remove(this.mesh);
    this.mesh?.geometry.dispose();
    this.mesh?.material.dispose();
    this.values?.dispose();
    [this.mesh, this.values] = [null, null];
  }
}
