// A plane with a grid that fades away from its middle: a floor, or the plane that a drag goes along.
import { BufferGeometry, Mesh, type RawShaderMaterial, Vector3 } from "three";
import type { Scene } from "../model";
import { type Common, material } from "./material";

const VERTEX = `
uniform vec3 middle, right, up;
uniform float reach;
out vec2 at;
const vec2 CORNERS[6] = vec2[](vec2(-1, -1), vec2(1, -1), vec2(1, 1), vec2(-1, -1), vec2(1, 1), vec2(-1, 1));
void main() {
  at = CORNERS[gl_VertexID] * reach;
  gl_Position = projectionMatrix * vec4(seen(middle - centre + right * at.x + up * at.y), 1.0);
}`;

const FRAGMENT = `
in vec2 at;
uniform float reach, cell;
uniform vec3 shade;
uniform float strength;
float lines(vec2 p, float wide) {
  vec2 d = fwidth(p);
  d = max(d, vec2(1e-12));
  vec2 l = clamp(wide - abs(fract(p - 0.5) - 0.5) / d + 0.5, 0.0, 1.0) * clamp(0.3 / d, 0.0, 1.0);
  return max(l.x, l.y);
}
void main() {
  float fade = 1.0 - smoothstep(0.35, 1.0, length(at) / reach);
  float line = max(0.5 * lines(at / cell, 0.5), lines(at / (5.0 * cell), 0.5));
  float a = fade * strength * (0.14 + 0.86 * line);
  if (a < 0.004) discard;
  colour = vec4(shade, a);
}`;

/** A plane through a point across a normal. */
export class Plane {
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  readonly style = {
    middle: { value: new Vector3() },
    right: { value: new Vector3(1, 0, 0) },
    up: { value: new Vector3(0, 1, 0) },
    reach: { value: 1 },
    cell: { value: 0.1 },
    shade: { value: [0, 0, 0] as [number, number, number] },
    strength: { value: 1 },
  };

  constructor(shared: Common, order: number) {
    const geometry = new BufferGeometry();
    geometry.setDrawRange(0, 6);
    this.mesh = new Mesh(
      geometry,
      material(shared, { vertex: VERTEX, fragment: FRAGMENT, uniforms: this.style, soft: true }),
    );
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
    this.mesh.visible = false;
  }

  /** Through `point`, about `middle`, which need not lie on it, `reach` to each side [length]. */
  lay(point: Vector3, normal: Vector3, middle: Vector3, reach: number): void {
    const n = normal.clone().normalize();
    const { right, up } = this.style;
    const along = Math.abs(n.x) < 0.9 ? new Vector3(1, 0, 0) : new Vector3(0, 1, 0);
    right.value.copy(along).addScaledVector(n, -along.dot(n)).normalize();
    up.value.crossVectors(n, right.value);
    this.style.middle.value.copy(middle).addScaledVector(n, point.clone().sub(middle).dot(n));
    this.style.reach.value = reach;
    this.style.cell.value = round(reach / 25);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** The next number up of 1, 2 or 5 times a power of ten. */
export function round(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value * 0.999999) ?? value;
}

/** The floor of a scene's settings; null for none. */
export function floorOf(scene: Scene | null): { point: Vector3; normal: Vector3 } | null {
  const floor = scene?.settings["floor"];
  if (!floor) return null;
  const { point, normal } = floor as { point?: number[]; normal?: number[] };
  return { point: new Vector3(...(point ?? [0, 0, 0])), normal: new Vector3(...(normal ?? [0, 0, 1])) };
}
