// Loads and self weight, added to a running session and removed from it: edits, which can be undone.
import { useSignal } from "@preact/signals";
import type { Patch, Scene, SceneForce, Topology } from "../model";
import type { Session } from "../session";
import { amount, isValue } from "./amounts";
import { kinds } from "./catalogue";
import { refuse, tell } from "./notices";
import { counted, measured } from "./words";

export function AddLoad({ session }: { session: Session }) {
  const { busy, make } = useEdit(session);
  const scene = session.scene.value;
  const topology = session.topology.value;
  if (!scene || !topology) return null;
  const size = fitting(scene, topology);
  const unit = scene.units.force;
  const add = async (force: SceneForce, done: string) => {
    if (await make({ add: [force] }, done)) choose(force.name);
  };
  const load = () => {
    const held = new Set(session.anchors.value.flatMap((anchor) => anchor.particles));
    const particles = Array.from({ length: topology.particles }, (_, i) => i).filter((i) => !held.has(i));
    const force = { kind: "unary", name: freeName(scene, "load"), particles, vector: [0, 0, -size] };
    if (!particles.length) refuse(new Error("All particles are held, so a load would have no effect."));
    else void add(force, `A load of ${measured(size, unit)} downwards acts on every free particle.`);
  };
  const weight = () => {
    const total = Number((size * topology.particles).toPrecision(2));
    const force = { kind: "self_weight", name: freeName(scene, "self weight"), total };
    void add(force, `Self weight of ${measured(total, unit)} in total acts on all particles.`);
  };
  const turned = mirrored(scene);
  const turn = () =>
    make(
      { forces: turned },
      `${counted(Object.keys(turned).length, "load")} turned over: what pulled down pushes up. Solve finds the form.`,
    );
  const disabled = busy || session.connection.value !== "live";
  return (
    <div class="row">
      <button
        type="button"
        disabled={disabled}
        title="A force downwards on every particle that is not held; its size can be changed above"
        onClick={load}
      >
        Add a load
      </button>
      {!scene.forces.some((force) => force.kind === "self_weight") && (
        <button
          type="button"
          disabled={disabled}
          title="The weight of the model itself, shared among all particles; its total can be changed above"
          onClick={weight}
        >
          Add self weight
        </button>
      )}
      {Object.keys(turned).length > 0 && (
        <button
          type="button"
          disabled={disabled}
          title="Mirror all loads in a horizontal plane: a net that hangs becomes the vault of the same forces"
          onClick={() => void turn()}
        >
          Turn the loads over
        </button>
      )}
    </div>
  );
}

const TURNED = ["vector", "direction"];

/** Loads of a scene mirrored in a horizontal plane, by force and column: those that have a part along z. */
function mirrored(scene: Scene): Record<string, Record<string, unknown>> {
  const flip = (row: number[]) => [row[0], row[1], row[2] && -row[2]];
  const found: Record<string, Record<string, unknown>> = {};
  scene.forces.forEach((force, number) => {
    if (kinds.value?.get(force.kind)?.role !== "load") return;
    for (const name of TURNED) {
      const rows = force[name];
      if (!isValue(rows) || typeof rows === "number") continue;
      const turned = Array.isArray(rows[0]) ? (rows as number[][]).map(flip) : flip(rows as number[]);
      if (JSON.stringify(turned) !== JSON.stringify(rows)) (found[String(number)] ??= {})[name] = turned;
    }
  });
  return found;
}

/** Removes a force of the scene. */
export function RemoveForce({ session, number, title }: { session: Session; number: number; title: string }) {
  const { busy, make } = useEdit(session);
  return (
    <button
      type="button"
      class="small"
      aria-label={`Remove ${title}`}
      title="Remove this force from the model; Undo restores it"
      disabled={busy || session.connection.value !== "live"}
      onClick={() => void make({ remove: [number] }, `${title} was removed; Undo restores it.`)}
    >
      Remove
    </button>
  );
}

/** Make an edit with a notice on it; `busy` until the session has answered. */
export function useEdit(session: Session) {
  const busy = useSignal(false);
  const make = async (patch: Patch, done: string) => {
    busy.value = true;
    try {
      await session.edit(patch);
      tell(done);
      return true;
    } catch (error) {
      refuse(error);
      return false;
    } finally {
      busy.value = false;
    }
  };
  return { busy: busy.value, make };
}

/** A load for each particle [force] that is seen and does not tear: a hundredth of what doubles a spring's length. */
function fitting(scene: Scene, topology: Topology): number {
  const stiffness = scene.forces
    .filter((force) => force.kind === "springs" && isValue(force["stiffness"]))
    .map((force) => amount(force["stiffness"] as number, false));
  const lengths = topology.springs.slice(0, 1000).map(([a, b]) => {
    const [p, q] = [topology.start[a]!, topology.start[b]!];
    return Math.hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  });
  const mean = lengths.reduce((sum, length) => sum + length, 0) / lengths.length || 1;
  return Number((0.01 * (Math.max(...stiffness, 0) || 1) * mean).toPrecision(1));
}

/** A name that no force has yet. */
export function freeName(scene: Scene, name: string): string {
  let found = name;
  for (let n = 2; scene.forces.some((force) => force.name === found); n++) found = `${name} ${n}`;
  return found;
}

/** Bring a force's fields into view, once they are drawn, and give them the focus. */
export function choose(name: string): void {
  const look = (tries: number) => {
    const found = [...document.querySelectorAll<HTMLElement>("fieldset.force")].find(
      (set) => set.dataset["force"] === name,
    );
    if (!found) return void (tries && setTimeout(() => look(tries - 1), 50));
    found.scrollIntoView({ block: "nearest" });
    found.focus({ preventScroll: true });
  };
  look(100);
}
