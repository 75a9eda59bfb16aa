// What all that is drawn shares: where particles are, how large the picture is, and how a shader reads both.
import { DoubleSide, GLSL3, type IUniform, RawShaderMaterial, Vector2, Vector3, Vector4 } from "three";
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
  /** A plane in the eye's space beyond which nothing of the form is drawn; of no normal for none. */
  cut: IUniform<Vector4>;
}

export const common = (): Common => ({
  positions: { value: null },
  centre: { value: new Vector3() },
  size: { value: new Vector2(1, 1) },
  ratio: { value: 1 },
  cut: { value: new Vector4() },
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

// whether a fragment lies beyond the section, by its depth
const CUT = `
uniform highp mat4 projectionMatrix;
uniform highp vec2 size;
uniform highp float ratio;
uniform vec4 cut;
bool beyond() {
  if (cut.xyz == vec3(0)) return false;
  vec3 p = vec3(gl_FragCoord.xy / (size * ratio), gl_FragCoord.z) * 2.0 - 1.0;
  float z = -projectionMatrix[3][2] / (p.z + projectionMatrix[2][2]);
  vec2 at = -z * p.xy / vec2(projectionMatrix[0][0], projectionMatrix[1][1]);
  return dot(cut, vec4(at, z, 1.0)) > 0.0;
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
  // what lies on top of all, such as what is picked, is seen beyond the section, too
  const isCut = look.vertex.includes("particle(") && (look.depthTest ?? true);
  return new RawShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: HEAD + SHARED + look.vertex,
    fragmentShader: `${HEAD}out vec4 colour;\n${isCut ? cutting(look.fragment) : look.fragment}`,
    uniforms: { ...shared, ...look.uniforms },
    side: DoubleSide,
    transparent: look.soft ?? false,
    depthTest: look.depthTest ?? true,
    depthWrite: look.depthWrite ?? !(look.soft ?? false),
  });
}

function cutting(fragment: string): string {
  const bare = fragment.replace(/uniform float ([^;]*), ratio([^;]*);/, "uniform float $1$2;");
  const main = "void main() {";
  return CUT + bare.replace("uniform float ratio;", "").replace(main, `${main}\n  if (beyond()) discard;`);
}
