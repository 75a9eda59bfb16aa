// The form as files that other programs open: STL of its faces, glTF of faces and lines. Written here: both are small.
import type { Form } from "./view/form";

/** Metres of a unit of length. */
const METRES: Record<string, number> = { m: 1, mm: 1e-3, cm: 1e-2, dm: 0.1, km: 1e3, in: 0.0254, ft: 0.3048 };

/** Faces as binary STL, in the scene's unit of length. Source: StereoLithography Interface Specification, 1989. */
export function stl(form: Form, positions: Float32Array): Blob {
  const { triangles } = form;
  if (!triangles.length) throw new Error("This model has no faces, which are all that STL holds. GLB holds its lines.");
  const [head, each, count] = [84, 50, triangles.length / 3];
  const view = new DataView(new ArrayBuffer(head + each * count));
  view.setUint32(80, count, true);
  for (let i = 0; i < count; i++) {
    const corners = [0, 1, 2].map((k) => at(positions, triangles[3 * i + k]!));
    const numbers = [normal(corners), ...corners].flat();
    numbers.forEach((number, k) => view.setFloat32(head + each * i + 4 * k, number, true));
  }
  return new Blob([view], { type: "model/stl" });
}

const at = (positions: Float32Array, i: number) => [...positions.subarray(3 * i, 3 * i + 3)];

function normal([a, b, c]: number[][]): number[] {
  const [u, v] = [b!.map((x, k) => x - a![k]!), c!.map((x, k) => x - a![k]!)];
  const n = [u[1]! * v[2]! - u[2]! * v[1]!, u[2]! * v[0]! - u[0]! * v[2]!, u[0]! * v[1]! - u[1]! * v[0]!];
  const size = Math.hypot(...n) || 1;
  return n.map((x) => x / size);
}

const [FLOATS, WHOLE, LINES, TRIANGLES] = [5126, 5125, 1, 4];
/** z up to y up. */
const TURN = [-Math.SQRT1_2, 0, 0, Math.SQRT1_2];

/** Light and dull: viewers show what has no material as metal. */
const CLOTH = { baseColorFactor: [0.72, 0.78, 0.84, 1], metallicFactor: 0, roughnessFactor: 0.8 };

/** Faces and lines as binary glTF 2.0, in metres and with y up, as that has them. */
export function glb(form: Form, positions: Float32Array, unit: string): Blob {
  const lines = Uint32Array.from([...form.springs, ...form.edges, ...form.strokes]);
  const parts = [positions, form.triangles, lines];
  const [low, high] = extent(positions);
  const starts = [0, positions.byteLength, positions.byteLength + form.triangles.byteLength];
  const primitives = [
    { mode: TRIANGLES, indices: 1, attributes: { POSITION: 0 }, material: 0 },
    { mode: LINES, indices: 2, attributes: { POSITION: 0 } },
  ].filter(({ indices }) => parts[indices]!.length);
  const scale = METRES[unit] ?? 1;
  const json = {
    asset: { version: "2.0", generator: "hookean studio" },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, rotation: TURN, scale: [scale, scale, scale] }],
    meshes: [{ primitives }],
    materials: [{ doubleSided: true, pbrMetallicRoughness: CLOTH }],
    buffers: [{ byteLength: parts.reduce((sum, part) => sum + part.byteLength, 0) }],
    bufferViews: parts
      .map((part, i) => ({ buffer: 0, byteOffset: starts[i], byteLength: part.byteLength }))
      .filter(({ byteLength }) => byteLength),
    accessors: [] as object[],
  };
  // a view may not be empty, so those after an empty one move up
  const views = parts.map((_, i) => parts.slice(0, i).filter(({ length }) => length).length);
  const kept = parts.map((part, i) => [part, i] as const).filter(([part]) => part.length);
  json.accessors = kept.map(([part, i]) =>
    i === 0
      ? { bufferView: 0, componentType: FLOATS, count: part.length / 3, type: "VEC3", min: low, max: high }
      : { bufferView: views[i], componentType: WHOLE, count: part.length, type: "SCALAR" },
  );
  primitives.forEach((primitive) => (primitive.indices = views[primitive.indices]!));
  return packed(json, parts);
}

function packed(json: object, parts: (Float32Array | Uint32Array)[]): Blob {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const gap = -text.length & 3;
  const binary = parts.reduce((sum, part) => sum + part.byteLength, 0);
  const whole = 12 + 8 + text.length + gap + 8 + binary;
  const head = Uint32Array.of(0x46546c67, 2, whole, text.length + gap, 0x4e4f534a);
  const spaces = new Uint8Array(gap).fill(32);
  const pieces = [head, text, spaces, Uint32Array.of(binary, 0x004e4942), ...parts];
  return new Blob(pieces as BlobPart[], { type: "model/gltf-binary" });
}

function extent(positions: Float32Array): [number[], number[]] {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  positions.forEach((x, i) => {
    low[i % 3] = Math.min(low[i % 3]!, x);
    high[i % 3] = Math.max(high[i % 3]!, x);
  });
  return [low, high];
}
