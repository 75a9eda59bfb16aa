// A load for a scene that has none, and self weight: the scene is given anew, its particles stay where they are.
import { useSignal } from "@preact/signals";
import * as api from "../api";
import type { Scene, SceneForce, Topology } from "../model";
import type { Session } from "../session";
import { amount, isValue } from "./amounts";
import { refuse, tell } from "./notices";
import { measured } from "./words";

export function AddLoad({ session }: { session: Session }) {
  const busy = useSignal(false);
  const scene = session.scene.value;
  const topology = session.topology.value;
  if (!scene || !topology) return null;
  const has = (kind: string) => scene.forces.some((force) => force.kind === kind);
  const add = async (force: SceneForce, done: string) => {
    busy.value = true;
    try {
      await api.replace(session.key, { ...scene, anchors: heldNow(session), forces: [...scene.forces, force] });
      tell(done);
    } catch (error) {
      refuse(error);
    } finally {
      busy.value = false;
    }
  };
  const size = fitting(scene, topology);
  const disabled = busy.value || session.connection.value !== "live";
  const load = () => {
    const held = new Set(session.anchors.value.flatMap((anchor) => anchor.particles));
    const particles = Array.from({ length: topology.particles }, (_, i) => i).filter((i) => !held.has(i));
    const force = { kind: "unary", name: freeName(scene, "load"), particles, vector: [0, 0, -size] };
    if (!particles.length) refuse(new Error("Every particle is held: there is none that a load would move."));
    else void add(force, `A load of ${measured(size, scene.units.force)} downwards is on every free particle.`);
  };
  const weight = {
    kind: "self_weight",
    name: freeName(scene, "self weight"),
    total: Number((size * topology.particles).toPrecision(2)),
  };
  return (
    <div class="row">
      {!has("unary") && (
        <button type="button" disabled={disabled} onClick={load}>
          Add a load
        </button>
      )}
      {!has("self_weight") && (
        <button
          type="button"
          disabled={disabled}
          onClick={() =>
            void add(weight, `Self weight of ${measured(weight.total, scene.units.force)} in total is added.`)
          }
        >
          Add self weight
        </button>
      )}
    </div>
  );
}

/** The anchors as edits have left them, for a scene. */
const heldNow = (session: Session) =>
  session.anchors.value
    .filter((anchor) => anchor.particles.length > 0)
    .map(({ name, particles, targets, axes }) => ({ name, particles, targets, axes }));

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
function freeName(scene: Scene, name: string): string {
  let found = name;
  for (let n = 2; scene.forces.some((force) => force.name === found); n++) found = `${name} ${n}`;
  return found;
}
