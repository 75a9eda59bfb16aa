// What can be done about a warning or a run that failed, as buttons: each is an edit, which can be undone.
import type { Anchor, Patch, Scene, Summary, Topology } from "../model";
import type { Session } from "../session";
import { extremes } from "../view/extremes";
import { facesOf } from "../view/form";
import { naked } from "../view/sets";
import { useEdit } from "./loads";
import { counted, said } from "./words";

interface Repair {
  seen: string;
  /** Why it is offered, where nothing else on the page reports that. */
  why?: string;
  hint?: string;
  patch: Patch;
  done: string;
}

export function Repairs({ session }: { session: Session }) {
  const { busy, make } = useEdit(session);
  const [summary, scene, topology] = [session.summary.value, session.scene.value, session.topology.value];
  if (!summary || !scene || !topology) return null;
  const loose = isLoose(session.anchors.value, scene);
  const found = [...ofSentences(summary, scene), ...ofSize(topology, scene), ...(loose ? holds(topology) : [])];
  if (!found.length && !loose) return null;
  return (
    <div class="repairs" role="group" aria-label="Repairs">
      {loose && <p>Nothing is held: hold some particles, or pick one and pin it under Selection.</p>}
      {found.map(({ why }) => why && <p key={why}>{why}</p>)}
      {found.map(({ seen, hint, patch, done }) => (
        <button
          key={seen}
          type="button"
          class="small"
          title={hint}
          disabled={busy || session.connection.value !== "live"}
          onClick={() => void make(patch, done)}
        >
          {seen}
        </button>
      ))}
    </div>
  );
}

/** What the service's sentences advise. */
function ofSentences(summary: Summary, scene: Scene): Repair[] {
  const told = [summary.message, ...(summary.warnings ?? [])].join(" ");
  const found: Repair[] = [];
  const step = /Steps? (?:of|up to) ([\d.e-]+) /.exec(told)?.[1];
  if (step && Number(step) > 0) {
    const size = `${said(Number(step))} ${scene.units.time}`;
    found.push({
      seen: `Use step ${size}`,
      patch: { settings: { time_step: Number(step) } },
      done: `The time step is ${size}; Reset goes back to the start.`,
    });
  }
  const most = scene.settings["max_iterations"];
  if (/Raise max_iterations/.test(told) && typeof most === "number") {
    const more = 10 * most;
    const seen = `Allow ${more.toLocaleString("en")} iterations`;
    found.push({ seen, patch: { settings: { max_iterations: more } }, done: `${seen}: Solve goes on from here.` });
  }
  if (/use auto,/.test(told))
    found.push({ seen: "Use solver auto", patch: { settings: { solver: "auto" } }, done: "The solver is auto." });
  return found;
}

const METRES: Record<string, number> = { dm: 0.1, m: 1, km: 1000, ft: 0.3048, yd: 0.9144 };
const LARGEST = 1000;

/** The same for the same topology, found once: each edit asks again. */
function once<T>(make: (topology: Topology) => T): (topology: Topology) => T {
  const known = new WeakMap<Topology, { made: T }>();
  return (topology) => {
    const found = known.get(topology) ?? { made: make(topology) };
    known.set(topology, found);
    return found.made;
  };
}

/** The largest extent of a form along an axis as it starts [length]. */
const extentOf = once(({ start }) => {
  const spans = [0, 1, 2].map((axis) => {
    const [low, high] = extremes(start.map((point) => point[axis]!));
    return high - low;
  });
  return Math.max(...spans);
});

/** Of a model that is larger than anything built, as one that was drawn in mm and read in m. */
function ofSize(topology: Topology, { units }: Scene): Repair[] {
  const size = extentOf(topology);
  if (!(size * (METRES[units.length] ?? 0) > LARGEST && size * 1e-3 <= LARGEST)) return [];
  return [
    {
      seen: "Unit: mm",
      why: `The model is ${said(size, 3)} ${units.length} long: its lengths may be meant in mm.`,
      hint: "All lengths are read in mm instead, numbers stay",
      patch: { units: { length: "mm" } },
      done: `All lengths are in mm: the model is ${said(size * 1e-3, 3)} m long. Forces per length keep their numbers.`,
    },
  ];
}

/** Whether nothing holds the form: no anchor, no support and no floor. */
export function isLoose(anchors: Anchor[], scene: Scene): boolean {
  const supports = ["support", "anchor_spring", "floor", "solid_plane_collide"];
  const held = anchors.some((anchor) => anchor.particles.length && anchor.axes);
  return !held && !scene.settings["floor"] && !scene.forces.some((force) => supports.includes(force.kind));
}

/** The particles at the least height; none of a form that is level. */
function lowest({ start }: Topology): number[] {
  const [low, high] = extremes(start.map(([, , z]) => z));
  const level = low + 1e-3 * (high - low);
  return high > low ? start.flatMap(([, , z], i) => (z <= level ? [i] : [])) : [];
}

/** Ways to hold a form: the rim of its meshes, the ends of its lines; of a closed one where it stands. */
const holds = once((topology): Repair[] => {
  const counts = new Map<number, number>();
  for (const particle of topology.springs.flat()) counts.set(particle, (counts.get(particle) ?? 0) + 1);
  const places: [string, number[]][] = [
    ["rim", [...new Set(naked(facesOf(topology)).flat())]],
    ["ends", [...counts].filter(([, count]) => count === 1).map(([particle]) => particle)],
  ];
  if (!places.some(([, particles]) => particles.length)) places.push(["lowest particles", lowest(topology)]);
  return places
    .filter(([, particles]) => particles.length)
    .map(([name, particles]) => ({
      seen: `Hold the ${name}`,
      patch: { pin: [{ particles: particles.sort((a, b) => a - b) }] },
      done: `${counted(particles.length, "particle")} held where they are; Undo takes it back.`,
    }));
});
