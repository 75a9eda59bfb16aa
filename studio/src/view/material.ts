// What all that is drawn shares: where particles are, how large the picture is, and how a shader reads both.
import { type Blending, DoubleSide, GLSL3, type IUniform, NormalBlending, RawShaderMaterial, Vector2, Vector3 } from "three";

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
ivec2 place(sampler2D column, int row) { int w = textureSize(column, 0).x; return ivec2(row % w, row / w); }
vec3 particle(int i) { return texelFetch(positions, place(positions, i), 0).xyz - centre; }
vec3 seen(vec3 p) { return (modelViewMatrix * vec4(p, 1.0)).xyz; }
// length of a CSS pixel at a point of the eye's space
float pixel(vec3 p) { return -2.0 * p.z / (projectionMatrix[1][1] * size.y); }
// on the picture, with the depth of a point nearer to the eye
vec4 drawn(vec3 p, float nearer) {
  vec4 c = projectionMatrix * vec4(p, 1.0);
  vec4 n = projectionMatrix * vec4(p * (1.0 - min(0.5, nearer / max(length(p), 1e-30))), 1.0);
  return vec4(c.xy, n.z / n.w * c.w, c.w);
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
  blending?: Blending;
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
    blending: look.blending ?? NormalBlending,
    depthTest: look.depthTest ?? true,
    depthWrite: look.depthWrite ?? !(look.soft ?? false),
  });
}
