// What is changed of the model by hand: springs and faces divided, edges extruded, anything deleted.
import { useSignal } from "@preact/signals";
import type { Draw, Point, Topology } from "../model";
import { refuse, tell } from "../ui/notices";
import { NumberField } from "../ui/number";
import type { Studio } from "../ui/studio";
import { counted } from "../ui/words";
import { numbersOf, present, rimOf } from "../view/faces";
import { naked } from "../view/sets";
import type { Pen } from "./pen";

interface Chosen {
  particles: number[];
  springs: number[];
  /** By mesh. */
  faces: Record<string, number[]>;
  edges: [number, number][];
}

/** What is picked or selected: particles, springs and faces all of whose corners are selected, edges to extrude. */
export function chosenOf({ options }: Studio, topology: Topology): Chosen {
  const own = present(topology, options.element.value === "faces" ? options.markedFaces.value : []);
  if (own.length) return { particles: [], springs: [], faces: numbersOf(topology, own), edges: rimOf(own) };
  const picked = options.picked.value;
  if (picked?.kind === "spring") {
    const pair = topology.springs[picked.index];
    return { particles: [], springs: [picked.index], faces: {}, edges: pair ? [pair] : [] };
  }
  const marked = new Set(picked ? [picked.index] : options.marked.value.filter((one) => one < topology.particles));
  const all = (ends: number[]) => ends.every((end) => marked.has(end));
  const springs = topology.springs.flatMap((pair, i) => (all(pair) ? [i] : []));
  const faces: Record<string, number[]> = {};
  for (const [name, mesh] of Object.entries(topology.meshes)) {
    const found = mesh.faces.flatMap((face, i) => (all(face) ? [i] : []));
    if (found.length) faces[name] = found;
  }
  const drawn = Object.values(topology.meshes).flatMap((mesh) => mesh.faces);
  const edges = springs.length ? springs.map((i) => topology.springs[i]!) : naked(drawn).filter(all);
  return { particles: [...marked], springs, faces, edges: distinct(edges as [number, number][]) };
}

const key = (a: number, b: number) => (a < b ? `${a} ${b}` : `${b} ${a}`);

const distinct = (edges: [number, number][]) => [...new Map(edges.map((edge) => [key(...edge), edge])).values()];

/** Delete what is picked or selected: faces, a spring, or particles; whether there was anything. */
export function deleted(studio: Studio): boolean {
  const topology = studio.session.topology.value;
  if (!topology) return false;
  const { particles, springs, faces } = chosenOf(studio, topology);
  const count = Object.values(faces).flat().length;
  const away = (edit: Draw["delete"], number: number, what: string) =>
    void draw(studio, { delete: edit }, `${counted(number, what)} deleted`);
  if (particles.length) away({ particles }, particles.length, "particle");
  else if (springs.length) away({ springs }, springs.length, "spring");
  else if (count) away({ faces }, count, "face");
  return particles.length + springs.length + count > 0;
}

/** Make an edit of the drawing, and report it. */
async function draw({ session, options }: Studio, edit: Draw, done: string): Promise<void> {
  try {
    await session.edit({ draw: edit });
    [options.picked.value, options.marked.value] = [null, []];
    tell(`${done}; Undo takes it back.`);
  } catch (error) {
    refuse(error);
  }
}

export function Change({ studio, pen }: { studio: Studio; pen: Pen }) {
  const { session } = studio;
  const pieces = useSignal(2);
  const by = useSignal<Point>([0, 0, 1]);
  const hasFaces = useSignal(true);
  const busy = useSignal(false);
  const topology = session.topology.value;
  if (!topology) return null;
  const { particles, springs, faces, edges } = chosenOf(studio, topology);
  const count = Object.values(faces).flat().length;
  const able = !busy.value && session.connection.value === "live";
  const change = async (edit: Draw, done: string) => {
    busy.value = true;
    await draw(studio, edit, done);
    busy.value = false;
  };
  const button = (name: string, hint: string, edit: () => Draw, is: boolean, done: string) => (
    <button type="button" class="small" title={hint} disabled={!able || !is} onClick={() => void change(edit(), done)}>
      {name}
    </button>
  );
  const extrusion = (): Draw => {
    const made = pen.faces();
    const mesh = made && typeof made !== "string" ? (made["mesh"] as string) : "faces";
    return { extrude: { edges, by: by.value, ...(hasFaces.value ? { mesh } : {}) } };
  };
  return (
    <details class="seldom">
      <summary title="Divide springs and faces, extrude edges, delete">Change what is selected</summary>
      <p class="note" role="status">
        {counted(particles.length, "particle")}, {counted(springs.length, "spring")} and{" "}
        {counted(count, "face")} selected.
        Click one, or select more under Selection.
      </p>
      <div class="row">
        <NumberField
          name="Pieces"
          seen="Pieces"
          unit=""
          whole
          hint="Pieces of each spring; usually 2 to 20"
          value={pieces.value}
          bounds={{ minimum: 2, maximum: 1000 }}
          done={(value) => (pieces.value = value ?? 2)}
        />
        {button(
          "Divide springs",
          "New particles on the springs; each row of pieces behaves as its spring did",
          () => ({ divide: { springs, pieces: pieces.value } }),
          springs.length > 0,
          `${counted(springs.length, "spring")} divided`,
        )}
        {button(
          "Divide faces",
          "Each face becomes four; neighbours get triangles where they meet new corners",
          () => ({ divide: { faces } }),
          count > 0,
          `${counted(count, "face")} divided`,
        )}
      </div>
      <div class="components" role="group" aria-label="Extrude by" title="How far the new edges are from the old ones">
        <span class="seen">Extrude by</span>
        {by.value.map((value, axis) => (
          <NumberField
            key={axis}
            name={`Extrude by ${"xyz"[axis]}`}
            seen={"xyz"[axis]!}
            value={value}
            unit=""
            done={(to) => (by.value = by.value.map((old, i) => (i === axis ? (to ?? 0) : old)) as Point)}
          />
        ))}
        <span class="unit">{topology.units.length}</span>
      </div>
      <div class="row">
        <label class="check" title="The faces join the mesh of the name that drawn faces have">
          <input
            type="checkbox"
            checked={hasFaces.value}
            onChange={(event) => (hasFaces.value = event.currentTarget.checked)}
          />
          With faces
        </label>
        {button(
          "Extrude edges",
          "Copies the selected springs, or edges of a mesh, by this vector, with springs and faces between",
          extrusion,
          edges.length > 0,
          `${counted(edges.length, "edge")} extruded`,
        )}
      </div>
      <div class="row" role="group" aria-label="Delete">
        {button(
          "Delete particles",
          "With all springs and faces on them",
          () => ({ delete: { particles } }),
          particles.length > 0,
          `${counted(particles.length, "particle")} deleted`,
        )}
        {button(
          "Delete springs",
          "Their particles stay",
          () => ({ delete: { springs } }),
          springs.length > 0,
          `${counted(springs.length, "spring")} deleted`,
        )}
        {button(
          "Delete faces",
          "Their particles stay",
          () => ({ delete: { faces } }),
          count > 0,
          `${counted(count, "face")} deleted`,
        )}
      </div>
    </details>
  );
}
