// The stiffness of the springs that are selected, whichever forces they belong to: one edit, which can be undone.
import type { Patch, Scene, Topology } from "../model";
import { useEdit } from "./loads";
import { NumberField } from "./number";
import type { Studio } from "./studio";
import { counted, unit } from "./words";

export function Stiffen({ studio, chosen }: { studio: Studio; chosen: number[] }) {
  const { session, options } = studio;
  const { busy, make } = useEdit(session);
  const [topology, scene, picked] = [session.topology.value, session.scene.value, options.picked.value];
  if (!topology || !scene) return null;
  const marked = new Set(chosen);
  const springs =
    picked?.kind === "spring"
      ? [picked.index]
      : topology.springs.flatMap(([a, b], spring) => (marked.has(a) && marked.has(b) ? [spring] : []));
  const found = stiffnesses(topology, scene, new Set(springs));
  const values = [...new Set(found.flatMap(({ places, column }) => places.map((place) => column[place]!)))];
  const count = found.reduce((sum, { places }) => sum + places.length, 0);
  const set = (value: number | null) => {
    if (value !== null) void make(patched(found, value), `${counted(count, "spring")} changed; Undo takes it back.`);
  };
  return (
    <NumberField
      name="Stiffness of the selected springs"
      seen="Stiffness"
      unit={unit("force/length", scene.units)}
      value={values.length === 1 ? values[0]! : null}
      placeholder={values.length ? "several" : "no springs"}
      hint={`Of ${counted(count, "selected spring")}; those with a material or an axial stiffness keep it`}
      bounds={{ minimum: 0 }}
      disabled={busy || !count || session.connection.value !== "live"}
      done={set}
    />
  );
}

interface Of {
  force: number;
  /** Of all its springs [force/length]. */
  column: number[];
  /** Of the springs that are selected. */
  places: number[];
}

/** The forces with selected springs whose stiffness is a number, or one for each. */
function stiffnesses({ spring_forces }: Topology, { forces }: Scene, springs: Set<number>): Of[] {
  const rows = new Map<number, number[]>();
  spring_forces.forEach((force, spring) => {
    const own = rows.get(force) ?? [];
    rows.set(force, own);
    own.push(spring);
  });
  return [...rows].flatMap(([force, all]) => {
    const value = forces[force]?.["stiffness"];
    const isColumn = Array.isArray(value) && value.length === all.length;
    const column = isColumn ? (value as number[]) : typeof value === "number" ? all.map(() => value) : null;
    const places = all.flatMap((spring, place) => (springs.has(spring) ? [place] : []));
    return column && places.length ? [{ force, column, places }] : [];
  });
}

function patched(found: Of[], value: number): Patch {
  const column = ({ column, places }: Of) => {
    const isChosen = new Set(places);
    const made = column.map((old, place) => (isChosen.has(place) ? value : old));
    return new Set(made).size === 1 ? value : made;
  };
  return { forces: Object.fromEntries(found.map((one) => [String(one.force), { stiffness: column(one) }])) };
}
