// Forces on particles as arrows, the largest of them a set part of the form's size.
import { InstancedBufferAttribute, InstancedBufferGeometry, Mesh, type RawShaderMaterial, type WebGLRenderer } from "three";
import { Column } from "./columns";
import { type Common, material } from "./material";

const VERTEX = `
in int index;
uniform sampler2D vectors;
uniform float scale, width, head;
uniform bool inward;
const vec2 SHAPE[9] = vec2[](vec2(0, -1), vec2(1, -1), vec2(1, 1), vec2(0, -1), vec2(1, 1), vec2(0, 1),
                             vec2(2, -1), vec2(3, 0), vec2(2, 1));
void main() {
  gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  vec3 p = particle(index);
  vec3 v = texelFetch(vectors, place(vectors, gl_InstanceID), 0).xyz * scale;
  if (!(dot(v, v) > 0.0)) return;
  // what pushes against the form ends on its particle, what pulls begins there
  bool pushes = inward && dot(v, p) < -1e-3 * length(v) * length(p);
  vec3 a = seen(pushes ? p - v : p), b = seen(pushes ? p : p + v);
  if (a.z >= 0.0 || b.z >= 0.0) return;
  vec4 from = drawn(a, pixel(a) * 3.0), to = drawn(b, pixel(b) * 3.0);
  vec2 along = (to.xy / to.w - from.xy / from.w) * 0.5 * size;
  float reach = length(along);
  if (reach < 0.5) return;
  along /= reach;
  vec2 across = vec2(-along.y, along.x);
  float tip = min(head, 0.6 * reach);
  vec2 corner = SHAPE[gl_VertexID];
  vec4 end = corner.x < 0.5 ? from : to;
  vec2 offset = across * corner.y * 0.5 * width;
  if (corner.x == 1.0) offset -= along * tip * 0.8;
  if (corner.x == 2.0) offset = across * corner.y * 0.42 * tip - along * tip;
  gl_Position = end + vec4(offset * 2.0 / size * end.w, 0, 0);
}`;

const FRAGMENT = `
uniform vec3 shade;
void main() { colour = vec4(shade, 1.0); }`;

/** Arrows on particles. */
export class Arrows {
  readonly mesh: Mesh<InstancedBufferGeometry, RawShaderMaterial>;
  readonly style = {
    scale: { value: 1 },
    width: { value: 2 },
    head: { value: 10 },
    shade: { value: [0, 0, 0] as [number, number, number] },
  };
  /** The longest vector [force] */
  largest = 0;
  private readonly vectors: Column;

  /** `inward`: those that point into the form end on their particle instead of beginning there. */
  constructor(shared: Common, readonly particles: Int32Array, inward: boolean) {
    this.vectors = new Column(particles.length, 3);
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("index", new InstancedBufferAttribute(particles, 1));
    geometry.setDrawRange(0, 9);
    geometry.instanceCount = particles.length;
    const uniforms = { ...this.style, vectors: { value: this.vectors.texture }, inward: { value: inward } };
    this.mesh = new Mesh(geometry, material(shared, { vertex: VERTEX, fragment: FRAGMENT, uniforms }));
    this.mesh.frustumCulled = false;
  }

  /** The vectors now, one for each of the particles [force]. */
  put(renderer: WebGLRenderer, vectors: Float32Array): void {
    this.vectors.put(renderer, vectors);
    let largest = 0;
    for (let i = 0; i < vectors.length; i += 3) {
      largest = Math.max(largest, Math.hypot(vectors[i]!, vectors[i + 1]!, vectors[i + 2]!));
    }
    this.largest = largest;
  }

  dispose(): void {
    this.vectors.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
