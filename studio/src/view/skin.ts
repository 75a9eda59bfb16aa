// Faces, lit flat: normals come from the picture itself, so that a frame is no work here. They are of places about
// the middle of the form, for those in the eye's space lose their digits where the eye is far away.
import { BufferAttribute, BufferGeometry, Mesh, type RawShaderMaterial } from "three";
import { type Common, material } from "./material";

const VERTEX = `
out vec3 at;
out vec3 own;
void main() {
  own = particle(gl_VertexID);
  at = seen(own);
  gl_Position = projectionMatrix * vec4(at, 1.0);
}`;

// lit from above the eye's left shoulder, both sides alike
const FRAGMENT = `
in vec3 at;
in vec3 own;
uniform mat4 modelViewMatrix;
uniform vec3 shade;
uniform float depth;
void main() {
  vec3 normal = mat3(modelViewMatrix) * cross(dFdx(own), dFdy(own));
  normal /= max(length(normal), 1e-30);
  if (dot(normal, at) > 0.0) normal = -normal;
  float shine = max(dot(normal, vec3(-0.45, 0.65, 0.62)), 0.0);
  colour = vec4(shade * (1.0 - depth + depth * shine), 1.0);
}`;

/** The faces of a form as triangles by particles. */
export class Skin {
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;
  readonly style = { shade: { value: [1, 1, 1] as [number, number, number] }, depth: { value: 0.42 } };

  constructor(
    shared: Common,
    triangles: Uint32Array,
  ) {
    const geometry = new BufferGeometry();
    geometry.setIndex(new BufferAttribute(triangles, 1));
    const made = material(shared, { vertex: VERTEX, fragment: FRAGMENT, uniforms: this.style });
    // lines on it lie in front
    made.polygonOffset = true;
    made.polygonOffsetFactor = made.polygonOffsetUnits = 1;
    this.mesh = new Mesh(geometry, made);
    this.mesh.frustumCulled = false;
  }

  /** Other faces, in front of the rest. */
  put(triangles: Uint32Array): void {
    this.mesh.geometry.dispose(); // its buffers; they are made again when it is drawn
    this.mesh.geometry.setIndex(new BufferAttribute(triangles, 1));
    this.mesh.material.polygonOffset = false;
    this.mesh.visible = triangles.length > 0;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
