// Forces on particles as arrows, the largest of them a set part of the form's size.
import { type BufferGeometry, Mesh, type RawShaderMaterial, type WebGLRenderer } from "three";
import { Column, Rows } from "./columns";
import { type Common, material } from "./material";
import { quads } from "./segments";

const VERTEX = `
uniform highp isampler2D rows;
uniform sampler2D vectors;
uniform float scale, width, head, gap;
uniform bool inward, faced;
out vec3 place_;
flat out float reach;
flat out float tip;
const vec2 CORNERS[4] = vec2[](vec2(0, -1), vec2(1, -1), vec2(0, 1), vec2(1, 1));
void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  int row = gl_VertexID >> 2;
  vec3 p = particle(texelFetch(rows, place(row), 0).x);
  vec3 v = texelFetch(vectors, place(row), 0).xyz * scale;
  if (!(dot(v, v) > 0.0)) return;
  // what pushes against the form ends on its particle, what pulls begins there
  bool into = inward && dot(v, p) < -1e-3 * length(v) * length(p);
  // faces would hide what points away from the eye and begins on them
  bool pushes = into || (faced && seen(p + v).z < seen(p).z - 0.02 * length(v));
  vec3 a = seen(pushes ? p - v : p), b = seen(pushes ? p : p + v);
  if (a.z >= 0.0 || b.z >= 0.0) return;
  vec4 from = drawn(a, pixel(a) * 3.0), to = drawn(b, pixel(b) * 3.0);
  vec2 along = (to.xy / to.w - from.xy / from.w) * 0.5 * size;
  reach = length(along);
  if (reach < 0.5) return;
  along /= reach;
  if (pushes && reach > 3.0 * gap) {
    to.xy -= along * gap * 2.0 / size * to.w;
    reach -= gap;
  }
  tip = min(head, 0.6 * reach);
  vec2 corner = CORNERS[gl_VertexID & 3];
  vec4 end = corner.x < 0.5 ? from : to;
  float wide = max(0.42 * tip, 0.5 * width) + 1.0, beyond = 2.0 * corner.x - 1.0;
  // along: from the tip backwards
  place_ = vec3((1.0 - corner.x) * reach - beyond, corner.y * wide, 1.0) * end.w;
  gl_Position = end + vec4((vec2(-along.y, along.x) * corner.y * wide + along * beyond) * 2.0 / size * end.w, 0, 0);
}`;

const FRAGMENT = `
in vec3 place_;
flat in float reach;
flat in float tip;
uniform float width, ratio;
uniform vec4 shade;
void main() {
  vec2 at = place_.xy / place_.z;
  float shaft = max(max(tip * 0.7 - at.x, at.x - reach), abs(at.y) - 0.5 * width);
  float arrow = max((abs(at.y) - 0.4 * at.x) * 0.93, at.x - tip);
  float inside = clamp(0.5 - min(shaft, arrow) * ratio, 0.0, 1.0);
  if (inside < 0.02) discard;
  colour = vec4(shade.rgb, shade.a * inside);
}`;

/** More arrows than these are a crowd, and short. */
export const MANY = 60;

/** Arrows on particles. */
export class Arrows {
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  readonly style = {
    scale: { value: 1 },
    width: { value: 2 },
    head: { value: 10 },
    /** So far before its particle the tip of one that pushes ends [CSS pixels]. */
    gap: { value: 7 },
    /** Whether they act on faces, which hide what is behind them. */
    faced: { value: false },
    shade: { value: [0, 0, 0, 1] as [number, number, number, number] },
  };
  /** The longest vector [force] */
  largest = 0;
  /** How long the longest is [length], and the force that stands for it. */
  private reach = 1;
  private full = 0;
  private now: ArrayLike<number> = [];
  private readonly vectors: Column;
  private readonly rows: Rows;

  /** `inward`: those that point into the form end on their particle instead of beginning there. */
  constructor(
    shared: Common,
    readonly particles: Int32Array,
    inward: boolean,
    order: number,
  ) {
    this.vectors = new Column(particles.length, 3);
    this.rows = new Rows(particles, 1);
    const columns = { rows: { value: this.rows.texture }, vectors: { value: this.vectors.texture } };
    const uniforms = { ...this.style, ...columns, inward: { value: inward } };
    const made = material(shared, { vertex: VERTEX, fragment: FRAGMENT, uniforms, soft: true, depthWrite: true });
    this.mesh = new Mesh(quads(particles.length), made);
    this.mesh.renderOrder = order;
    this.mesh.frustumCulled = false;
  }

  /** The vectors now, one for each of the particles [force]. */
  put(renderer: WebGLRenderer, vectors: Float32Array): void {
    this.vectors.put(renderer, vectors);
    this.now = vectors;
    let largest = 0;
    for (let i = 0; i < vectors.length; i += 3) {
      largest = Math.max(largest, Math.hypot(vectors[i]!, vectors[i + 1]!, vectors[i + 2]!));
    }
    this.largest = largest;
    this.stretch(this.reach);
  }

  /** Let the longest be about so long [length]; while forces waver a little, the scale stays. */
  stretch(reach: number): void {
    this.reach = reach;
    if (this.largest > this.full || this.largest < 0.6 * this.full) this.full = this.largest;
    this.style.scale.value = reach / (this.full || 1);
  }

  /** Where those end that are drawn, beginning at their particles, and on faces also ending there [length]. */
  tips(positions: Float32Array): number[] {
    if (!this.mesh.visible) return [];
    const found: number[] = [];
    const { scale, faced } = this.style;
    for (const way of faced.value ? [1, -1] : [1]) {
      this.particles.forEach((particle, i) => {
        for (let axis = 0; axis < 3; axis++) {
          found.push(positions[3 * particle + axis]! + way * scale.value * (this.now[3 * i + axis] ?? 0));
        }
      });
    }
    return found;
  }

  dispose(): void {
    this.vectors.dispose();
    this.rows.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
