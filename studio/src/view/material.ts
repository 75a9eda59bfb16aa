// What all that is drawn shares: where particles are, how large the picture is, and how a shader reads both.
import { DoubleSide, GLSL3, type IUniform, RawShaderMaterial, Vector2, Vector3 } from "three";
import { WIDTH } from "./columns";

/** Uniforms of all shaders; one object, so that setting a value sets it everywhere. */
export interface Common {
  [name: string]: IUniform;
  positions: IUniform;
  /** Middle of the form [length]: positions are taken from there, so that float32 suffices far from the origin. */
  centre: IUniform<Vector3>;
  /** Of the picture [CSS pixels], and how many pixels of the picture each has. */
  size: IUniform<Vector2>;
  ratio: IUniform<number>;
}

export const common = (): Common => ({
  positions: { value: null },
  centre: { value: new Vector3() },
  size: { value: new Vector2(1, 1) },
  ratio: { value: 1 },
});

const HEAD = `precision highp float;
precision highp int;
precision highp sampler2D;
`;

const SHARED = `
uniform mat4 modelViewMatrix, projectionMatrix;
uniform sampler2D positions;
uniform vec3 centre;
uniform vec2 size;
uniform float ratio;
// columns are ${WIDTH} wide
ivec2 place(int row) { return ivec2(row & ${WIDTH - 1}, row >> ${Math.log2(WIDTH)}); }
vec3 particle(int i) { return texelFetch(positions, place(i), 0).xyz - centre; }
vec3 seen(vec3 p) { return (modelViewMatrix * vec4(p, 1.0)).xyz; }
// length of a CSS pixel at a point of the eye's space
float pixel(vec3 p) { return -2.0 * p.z / (projectionMatrix[1][1] * size.y); }
// on the picture, with the depth of a point nearer to the eye; the camera looks straight ahead
vec4 drawn(vec3 p, float nearer) {
  float part = 1.0 - min(0.5, nearer / max(-p.z, 1e-30));
  float depth = projectionMatrix[2][2] * p.z + projectionMatrix[3][2] / part;
  return vec4(projectionMatrix[0][0] * p.x, projectionMatrix[1][1] * p.y, depth, -p.z);
}
`;

export interface Look {
  vertex: string;
  fragment: string;
  uniforms?: Record<string, IUniform>;
  /** Soft edges: mixed with what is behind. */
  soft?: boolean;
  depthTest?: boolean;
  depthWrite?: boolean;
}

/** A material of these shaders. They know `particle(i)`, `seen`, `drawn`, and what Common has. */
export function material(shared: Common, look: Look): RawShaderMaterial {
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: HEAD + SHARED + look.vertex,
    fragmentShader: `${HEAD}out vec4 colour;\n${look.fragment}`,
    uniforms: { ...shared, ...look.uniforms },
    side: DoubleSide,
    transparent: look.soft ?? false,
    depthTest: look.depthTest ?? true,
    depthWrite: look.depthWrite ?? !(look.soft ?? false),
  });
}
