// Straight lines between particles, some pixels wide: springs in the colours of their numbers, edges, polylines.
import {
  BufferAttribute,
  BufferGeometry,
  DataTexture,
  type IUniform,
  LineSegments,
  Mesh,
  type RawShaderMaterial,
  Vector3,
} from "three";
import { Rows } from "./columns";
import { type Common, material } from "./material";

const COLOURED = `
uniform highp isampler2D rows;
uniform int colouring, logarithmic;
uniform sampler2D forces, restLengths;
uniform float low, high, slack;
uniform vec3 stops[9];
uniform int count;
uniform vec4 plain;
uniform vec3 slackColour;
vec4 coloured(float value) {
  if (abs(value) <= slack) return vec4(slackColour, plain.a);
  if (logarithmic == 1) value = log2(abs(value)) * 0.30103;
  float at = clamp((value - low) / (high - low), 0.0, 1.0) * float(count - 1);
  int i = min(int(at), count - 2);
  return vec4(mix(stops[i], stops[i + 1], at - float(i)), plain.a);
}
vec4 shaded(int row, vec3 p, vec3 q) {
  if (colouring == 1) return coloured(texelFetch(forces, place(row), 0).x);
  if (colouring == 0) return plain;
  float rest = texelFetch(restLengths, place(row), 0).x;
  return rest > 0.0 ? coloured(length(q - p) / rest - 1.0) : vec4(slackColour, plain.a);
}
`;

const VERTEX = `
uniform float width;
out vec3 place_;
flat out float reach;
flat out float radius;
flat out vec4 shade;
const vec2 CORNERS[4] = vec2[](vec2(0, -1), vec2(1, -1), vec2(0, 1), vec2(1, 1));
void main() {
  int row = gl_VertexID >> 2;
  ivec2 ends = texelFetch(rows, place(row), 0).xy;
  vec3 p = particle(ends.x), q = particle(ends.y);
  shade = shaded(row, p, q);
  vec3 a = seen(p), b = seen(q);
  float near = 1e-3 * length(a - b) + 1e-20;
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  if (a.z > -near && b.z > -near) return;
  if (a.z > -near) a = mix(b, a, (-near - b.z) / (a.z - b.z));
  if (b.z > -near) b = mix(a, b, (-near - a.z) / (b.z - a.z));
  radius = 0.5 * width;
  vec4 from = drawn(a, pixel(a) * radius * 1.5), to = drawn(b, pixel(b) * radius * 1.5);
  vec2 along = (to.xy / to.w - from.xy / from.w) * 0.5 * size;
  reach = length(along);
  along = reach > 1e-3 ? along / reach : vec2(1, 0);
  vec2 corner = CORNERS[gl_VertexID & 3];
  float half_ = radius + 0.5 / ratio;
  vec4 end = corner.x < 0.5 ? from : to;
  vec2 offset = (vec2(-along.y, along.x) * corner.y + along * (2.0 * corner.x - 1.0)) * half_;
  place_ = vec3(corner.x * reach + (2.0 * corner.x - 1.0) * half_, corner.y * half_, 1.0) * end.w;
  gl_Position = end + vec4(offset * 2.0 / size * end.w, 0, 0);
}`;

const FRAGMENT = `
in vec3 place_;
flat in float reach;
flat in float radius;
flat in vec4 shade;
uniform float ratio;
void main() {
  vec2 at = place_.xy / place_.z;
  float away = length(vec2(at.x - clamp(at.x, 0.0, reach), at.y));
  float inside = clamp((radius - away) * ratio + 0.5, 0.0, 1.0);
  if (inside < 0.02) discard;
  colour = vec4(shade.rgb, shade.a * inside);
}`;

const THIN_VERTEX = `
flat out vec4 shade;
void main() {
  int row = gl_VertexID >> 1;
  ivec2 ends = texelFetch(rows, place(row), 0).xy;
  bool second = (gl_VertexID & 1) == 1;
  vec3 p = particle(second ? ends.y : ends.x), q = colouring == 2 ? particle(second ? ends.x : ends.y) : p;
  shade = shaded(row, p, q);
  vec3 at = seen(p);
  gl_Position = drawn(at, pixel(at));
}`;

const THIN_FRAGMENT = `
flat in vec4 shade;
void main() { colour = shade; }`;

const nothing = new DataTexture(new Uint8Array(4), 1, 1);

/** Segments; `style` has what they look like. */
export class Segments {
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  readonly thin: LineSegments<BufferGeometry, RawShaderMaterial>;
  readonly style = {
    width: { value: 1.5 },
    colouring: { value: 0 },
    forces: { value: nothing } as IUniform,
    restLengths: { value: nothing } as IUniform,
    low: { value: 0 },
    high: { value: 1 },
    slack: { value: -1 },
    log: { value: 0 },
    stops: { value: Array.from({ length: 9 }, () => new Vector3()) },
    count: { value: 2 },
    plain: { value: [0, 0, 0, 1] as [number, number, number, number] },
    slackColour: { value: [0, 0, 0] as [number, number, number] },
  };
  private readonly rows: Rows;

  constructor(shared: Common, ends: Int32Array, order: number, onTop = false) {
    this.rows = new Rows(ends, 2);
    const uniforms = { ...this.style, logarithmic: this.style.log, rows: { value: this.rows.texture } };
    const made = material(shared, {
      vertex: COLOURED + VERTEX,
      fragment: FRAGMENT,
      uniforms,
      soft: true,
      depthTest: !onTop,
      depthWrite: !onTop,
    });
    this.mesh = new Mesh(quads(this.rows.count), made);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
    this.thin = new LineSegments(
      new BufferGeometry(),
      material(shared, {
        vertex: COLOURED + THIN_VERTEX,
        fragment: THIN_FRAGMENT,
        uniforms,
      }),
    );
    this.thin.geometry.setDrawRange(0, 2 * this.rows.count);
    this.thin.frustumCulled = this.thin.visible = false;
  }

  /** Whether it is seen, and only as the thinnest lines there are, which cost least. */
  show(seen: boolean, thinly = false): void {
    this.mesh.visible = seen && !thinly;
    this.thin.visible = seen && thinly;
  }

  get count(): number {
    return this.rows.count;
  }

  /** Other ends of the first segment. */
  join(from: number, to: number): void {
    this.rows.put([from, to]);
  }

  dispose(): void {
    this.rows.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.thin.geometry.dispose();
    this.thin.material.dispose();
  }
}

/** So many quads of four corners each, counted through. Not instances: software draws those one by one. */
export function quads(count: number): BufferGeometry {
  const corners = new Uint32Array(6 * count);
  for (let i = 0; i < count; i++) {
    for (let k = 0; k < 6; k++) corners[6 * i + k] = 4 * i + [0, 1, 3, 0, 3, 2][k]!;
  }
  const geometry = new BufferGeometry();
  geometry.setIndex(new BufferAttribute(corners, 1));
  return geometry;
}
