// Straight lines between particles, some pixels wide: springs in the colours of their numbers, edges, polylines.
import {
  DataTexture, type IUniform, InstancedBufferAttribute, InstancedBufferGeometry, Mesh, type RawShaderMaterial, Vector3,
} from "three";
import { type Common, material } from "./material";

const VERTEX = `
in ivec2 ends;
uniform float width;
uniform int colouring;
uniform sampler2D forces, restLengths;
uniform float low, high, slack;
uniform vec3 stops[9];
uniform int count;
uniform vec4 plain;
uniform vec3 slackColour;
out vec3 place_;
flat out float reach;
flat out float radius;
flat out vec4 shade;
const vec2 CORNERS[6] = vec2[](vec2(0, -1), vec2(1, -1), vec2(1, 1), vec2(0, -1), vec2(1, 1), vec2(0, 1));
vec4 coloured(float value) {
  if (abs(value) <= slack) return vec4(slackColour, plain.a);
  float at = clamp((value - low) / (high - low), 0.0, 1.0) * float(count - 1);
  int i = min(int(at), count - 2);
  return vec4(mix(stops[i], stops[i + 1], at - float(i)), plain.a);
}
void main() {
  vec3 p = particle(ends.x), q = particle(ends.y);
  shade = plain;
  if (colouring == 1) shade = coloured(texelFetch(forces, place(forces, gl_InstanceID), 0).x);
  if (colouring == 2) {
    float rest = texelFetch(restLengths, place(restLengths, gl_InstanceID), 0).x;
    shade = rest > 0.0 ? coloured(length(q - p) / rest - 1.0) : vec4(slackColour, plain.a);
  }
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
  vec2 corner = CORNERS[gl_VertexID];
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

const nothing = new DataTexture(new Uint8Array(4), 1, 1);

/** Segments; `style` has what they look like. */
export class Segments {
  readonly mesh: Mesh<InstancedBufferGeometry, RawShaderMaterial>;
  readonly style = {
    width: { value: 1.5 },
    colouring: { value: 0 },
    forces: { value: nothing } as IUniform,
    restLengths: { value: nothing } as IUniform,
    low: { value: 0 },
    high: { value: 1 },
    slack: { value: -1 },
    stops: { value: Array.from({ length: 9 }, () => new Vector3()) },
    count: { value: 2 },
    plain: { value: [0, 0, 0, 1] as [number, number, number, number] },
    slackColour: { value: [0, 0, 0] as [number, number, number] },
  };

  constructor(shared: Common, ends: Int32Array, order: number, onTop = false) {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute("ends", new InstancedBufferAttribute(ends, 2));
    geometry.setDrawRange(0, 6);
    geometry.instanceCount = ends.length / 2;
    const made = material(shared, {
      vertex: VERTEX, fragment: FRAGMENT, uniforms: this.style, soft: true, depthTest: !onTop, depthWrite: !onTop,
    });
    this.mesh = new Mesh(geometry, made);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
  }

  get count(): number {
    return this.mesh.geometry.instanceCount;
  }

  /** Other ends, not more than there is room for. */
  join(...ends: number[]): void {
    const attribute = this.mesh.geometry.getAttribute("ends") as InstancedBufferAttribute;
    attribute.array.set(ends);
    attribute.needsUpdate = true;
    this.mesh.geometry.instanceCount = ends.length / 2;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
