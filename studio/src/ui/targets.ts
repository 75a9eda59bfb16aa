// On what a force is put: particles, pairs and rows of particles, or a mesh, as its kind has elements.
import type { Kind, Patch, SceneForce, Topology } from "../model";
import type { Session } from "../session";
import { meshOf } from "../view/faces";
import type { Options } from "../view/types";

export type Where = "faces" | "free" | "all" | "picked" | "numbers" | "springs" | `mesh ${string}`;

export const PER_MESH = "mesh ";

const has = (kind: Kind, name: string) => kind.fields.some((field) => field.name === name);

/** The places a kind of force may have in a scene, with their names; the first is the usual one. */
export function places(kind: Kind, topology: Topology, faces: number[][]): [Where, string][] {
  const own: [Where, string][] = has(kind, "mesh") && faces.length ? [["faces", "Selected faces"]] : [];
  return [...own, ...others(kind, topology)];
}

function others(kind: Kind, topology: Topology): [Where, string][] {
  const meshes = has(kind, "mesh")
    ? Object.keys(topology.meshes).map((name): [Where, string] => [`${PER_MESH}${name}`, `Mesh ${name}`])
    : [];
  if (!has(kind, "particles")) return meshes;
  const per = kind.particles_per_element;
  const found: [Where, string][] = [["picked", "What is picked"], ["numbers", "Particles by number"]];
  if (per === 1) return [["free", "Every free particle"], ["all", "Every particle"], ...found, ...meshes];
  if (per === 2 && topology.springs.length) return [["springs", "Every spring"], ...meshes, ...found];
  return [...meshes, ...found];
}

/** The fields of the place that was chosen, or a sentence on what is missing. */
export function placed(
  where: Where,
  kind: Kind,
  { session, options, numbers }: { session: Session; options: Options; numbers: string },
): Record<string, unknown> | string {
  if (where.startsWith(PER_MESH)) return { mesh: where.slice(PER_MESH.length) };
  const topology = session.topology.value!;
  if (where === "springs") return { particles: topology.springs };
  const { picked, marked } = { picked: options.picked.value, marked: new Set(options.marked.value) };
  if (where === "picked" && !picked && marked.size && kind.particles_per_element === 2) {
    const among = topology.springs.filter((ends) => ends.every((end) => marked.has(end)));
    return among.length ? { particles: among } : "No spring joins two of the selected particles.";
  }
  const flat = where === "numbers" ? numbered(numbers) : particlesAt(where, session, options);
  if (typeof flat === "string") return flat;
  const per = Math.max(1, kind.particles_per_element);
  const none = where === "picked" ? "Pick a particle or a spring, or select several, first." : "";
  if (!flat.length) return none || "There is no such particle.";
  if (flat.length % per)
    return `${flat.length} particles given; ${kind.title} needs ${per} for each element, in their order.`;
  if (per === 1) return { particles: flat };
  return { particles: Array.from({ length: flat.length / per }, (_, row) => flat.slice(per * row, per * (row + 1))) };
}

/** The edit that puts a force on faces: on the mesh that they are, or on a new one of the force's name. */
export function onFaces(topology: Topology, faces: number[][], force: SceneForce): Patch {
  const known = meshOf(topology, faces);
  if (known !== null) return { add: [{ ...force, mesh: known }] };
  let mesh = force.name;
  for (let n = 2; mesh in topology.meshes; n++) mesh = `${force.name} ${n}`;
  const rows = faces.map((face) => (face.length === 3 ? [...face, face[2]!] : face));
  return { draw: { add: { faces: { [mesh]: rows }, forces: [{ ...force, mesh }] } } };
}

function particlesAt(where: Where, session: Session, options: Options): number[] {
  const topology = session.topology.value!;
  if (where === "picked") {
    const picked = options.picked.value;
    if (!picked) return options.marked.value;
    return picked.kind === "particle" ? [picked.index] : [...(topology.springs[picked.index] ?? [])];
  }
  const held = new Set(where === "free" ? session.anchors.value.flatMap((anchor) => anchor.particles) : []);
  return Array.from({ length: topology.particles }, (_, i) => i).filter((i) => !held.has(i));
}

/** Whole numbers in a text: "0 3 5-8". */
export function numbered(text: string): number[] | string {
  const found: number[] = [];
  for (const part of text.split(/[\s,;]+/).filter(Boolean)) {
    const [, low, high] = /^(\d+)(?:-(\d+))?$/.exec(part) ?? [];
    if (low === undefined) return `${part} is not a particle; give numbers such as 0 3 5-8.`;
    for (let i = Number(low); i <= Number(high ?? low) && found.length < 1e6; i++) found.push(i);
  }
  return found;
}
