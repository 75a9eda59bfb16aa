// Marks on particles, of some pixels whatever the distance: dots, anchors, rings.
import { BufferAttribute, BufferGeometry, Points, type RawShaderMaterial } from "three";
import { type Common, material } from "./material";

const VERTEX = `
in int index;
uniform float diameter;
void main() {
  vec3 p = seen(particle(index));
  gl_Position = p.z < 0.0 ? drawn(p, pixel(p) * diameter) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = (diameter + 2.0) * ratio;
}`;

// distance to the outline: a disc, a square, a diamond, a ring
const FRAGMENT = `
uniform float diameter, ratio, rim;
uniform int form;
uniform vec4 fill;
uniform vec4 outline;
float away(vec2 p) {
  float r = 0.5 * diameter;
  if (form == 1) { vec2 d = abs(p) - 0.86 * r; return max(d.x, d.y); }
  if (form == 2) return (abs(p.x) + abs(p.y) - 1.15 * r) * 0.7071;
  return length(p) - r;
}
void main() {
  vec2 p = (gl_PointCoord - 0.5) * (diameter + 2.0);
  float d = away(p);
  float inside = clamp(0.5 - d * ratio, 0.0, 1.0);
  float core = clamp(0.5 - (d + rim) * ratio, 0.0, 1.0);
  vec4 mixed = mix(outline, fill, core);
  if (inside * mixed.a < 0.02) discard;
  colour = vec4(mixed.rgb, mixed.a * inside);
}`;

export const FORMS = { disc: 0, square: 1, diamond: 2 } as const;

/** One kind of mark on some particles; `style` has what it looks like, sizes in CSS pixels. */
export class Marks {
  readonly points: Points<BufferGeometry, RawShaderMaterial>;
  readonly style = {
    diameter: { value: 6 },
    rim: { value: 1.2 },
    form: { value: 0 as number },
    fill: { value: [1, 1, 1, 1] as [number, number, number, number] },
    outline: { value: [0, 0, 0, 1] as [number, number, number, number] },
  };

  constructor(shared: Common, form: keyof typeof FORMS, order: number, onTop = false) {
    this.style.form.value = FORMS[form];
    const made = material(shared, {
      vertex: VERTEX,
      fragment: FRAGMENT,
      uniforms: this.style,
      soft: true,
      depthTest: !onTop,
    });
    this.points = new Points(new BufferGeometry(), made);
    this.points.frustumCulled = false;
    this.points.renderOrder = order;
    this.put([]);
  }

  /** On these particles. */
  put(particles: ArrayLike<number>): void {
    this.points.geometry.dispose();
    this.points.geometry = new BufferGeometry();
    this.points.geometry.setAttribute("index", new BufferAttribute(Int32Array.from(particles), 1));
    this.points.geometry.setDrawRange(0, particles.length);
    this.points.visible = particles.length > 0;
  }

  dispose(): void {
    this.points.geometry.dispose();
    this.points.material.dispose();
  }
}
