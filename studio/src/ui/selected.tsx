// Several particles at once: found by a box, a lasso, a row of springs or a range of forces; held, moved, named.
import { useSignal } from "@preact/signals";
import { inTurn } from "../hand";
import type { Anchor, Point, Scene, Topology } from "../model";
import { between, endsOf, rim, row } from "../view/sets";
import type { Element } from "../view/types";
import { kinds } from "./catalogue";
import { Choice } from "./choice";
import { titleOf } from "./forces";
import { Groups } from "./groups";
import { useEdit } from "./loads";
import { NumberField } from "./number";
import { SelectedFaces } from "./selectedfaces";
import { enclosedBy } from "./selecting";
import { Stiffen } from "./stiffen";
import type { Studio } from "./studio";
import { counted, titled } from "./words";

const ELEMENTS: [Element, string, string][] = [
  ["particles", "Particles", "A click picks a particle or a spring"],
  ["faces", "Faces", "A click selects a face or takes it out of the selection"],
];
const AXES = ["xyz", "xy", "xz", "yz", "x", "y", "z"];

export function Selected({ studio }: { studio: Studio }) {
  const { options } = studio;
  const topology = studio.session.topology.value;
  if (!topology) return null;
  return (
    <details
      class="seldom"
      onToggle={(event) => {
        if (!event.currentTarget.open) options.element.value = "particles"; // so that clicks pick particles again
      }}
    >
      <summary title="By a box, a line around them, a part or a range of forces; then hold, move or name them">
        Select several
      </summary>
      <div class="row choices" role="radiogroup" aria-label="What to select">
        {ELEMENTS.map(([element, seen, hint]) => (
          <label key={element} title={hint}>
            <input
              type="radio"
              name="element"
              checked={options.element.value === element}
              onChange={() => (options.element.value = element)}
            />
            {seen}
          </label>
        ))}
      </div>
      {options.element.value === "faces" ? (
        <SelectedFaces studio={studio} />
      ) : (
        <SelectedParticles studio={studio} topology={topology} />
      )}
    </details>
  );
}

function SelectedParticles({ studio, topology }: { studio: Studio; topology: Topology }) {
  const { options, session } = studio;
  const chosen = options.marked.value.filter((particle) => particle < topology.particles);
  const choose = (particles: number[]) => ([options.picked.value, options.marked.value] = [null, particles]);
  const all = Array.from({ length: topology.particles }, (_, i) => i);
  const known = new Set(chosen);
  const picked = options.picked.value;
  const around = picked?.kind === "particle" ? [picked.index] : chosen;
  const along = () => {
    if (picked?.kind === "spring") choose(endsOf(topology.springs, row(topology, picked.index)));
  };
  const button = (name: string, hint: string, does: () => void, able = true) => (
    <button type="button" class="small" title={hint} disabled={!able} onClick={does}>
      {name}
    </button>
  );
  return (
    <>
      <div class="row" role="group" aria-label="Ways to select">
        {enclosedBy(options)}
        {button("Row", "All springs that go on straight from the picked one", along, picked?.kind === "spring")}
        {button(
          "Edge loop",
          "All along the edge of the mesh on which the picked or a selected particle lies",
          () => choose(rim(topology, around)),
          around.length > 0,
        )}
        {button("All", "All particles", () => choose(all))}
        {button("Invert", "Those that are not selected", () => choose(all.filter((one) => !known.has(one))))}
        {button("None", "Nothing", () => choose([]), chosen.length > 0)}
      </div>
      <ByPart studio={studio} choose={choose} />
      <ByForce studio={studio} choose={choose} />
      <p role="status" class="note">
        {counted(chosen.length, "particle")} selected.
        {!session.readOnly && ' Forces are added to them by "What is picked" below.'}
      </p>
      {!session.readOnly && <Acts studio={studio} chosen={chosen} />}
      {!session.readOnly && <Stiffen studio={studio} chosen={chosen} />}
      <Groups studio={studio} chosen={chosen} choose={choose} />
    </>
  );
}

/** Particles of an anchor, of a force with its name or layer, of a mesh, or of what was drawn. */
function ByPart({ studio: { session }, choose }: { studio: Studio; choose: (particles: number[]) => void }) {
  const [topology, scene] = [session.topology.value, session.scene.value];
  if (!topology || !scene) return null;
  const parts = partsOf(topology, scene, session.anchors.value);
  return (
    <label class="field" title="By the names that layers, objects and forces have in the model">
      <span>A part</span>
      <select
        aria-label="Select a part"
        value=""
        onChange={(event) => {
          const found = parts[Number(event.currentTarget.value)];
          if (found) choose(ascending(found[1]));
        }}
      >
        <option value="">choose one</option>
        {parts.map(([name], i) => (
          <option key={i} value={i}>
            {name}
          </option>
        ))}
      </select>
    </label>
  );
}

const ascending = (particles: number[]) => [...new Set(particles)].sort((a, b) => a - b);

function partsOf(topology: Topology, scene: Scene, anchors: Anchor[]): [string, number[]][] {
  const found: [string, number[]][] = scene.forces.map((force, number) => [
    titleOf(force, kinds.value?.get(force.kind), number),
    [
      ...topology.springs.filter((_, i) => topology.spring_forces[i] === number).flat(),
      ...topology.loads.filter((load) => load.force === number).flatMap((load) => load.particles),
    ],
  ]);
  anchors.forEach(({ name, number, particles }) =>
    found.push([name || (number < 0 ? "Held by hand" : `Anchor ${number}`), particles]),
  );
  for (const [name, { faces }] of Object.entries(topology.meshes)) found.push([`Mesh ${name}`, faces.flat()]);
  for (const { name, kind, particles } of topology.geometry)
    found.push([`${titled(kind)} ${name}`.trim(), (particles as (number | number[])[]).flat()]);
  return found.filter(([, particles]) => particles.length);
}

function ByForce({ studio: { session }, choose }: { studio: Studio; choose: (particles: number[]) => void }) {
  const range = useSignal<{ low: number | null; high: number | null }>({ low: null, high: null });
  const topology = session.topology.value;
  if (!topology?.springs.length) return null;
  const end = (which: "low" | "high", seen: string) => (
    <NumberField
      name={`${seen} force`}
      seen={seen}
      value={range.value[which]}
      unit={topology.units.force}
      placeholder="any"
      hint="Tension is above 0, compression below; empty: no limit"
      done={(value) => (range.value = { ...range.value, [which]: value })}
    />
  );
  const find = () => {
    const forces = session.frame?.springForces;
    if (forces) choose(endsOf(topology.springs, between(forces, range.value.low, range.value.high)));
  };
  return (
    <div class="row" role="group" aria-label="Springs by force">
      {end("low", "From")}
      {end("high", "To")}
      <button type="button" class="small" title="The ends of springs with forces of this range" onClick={find}>
        Select by force
      </button>
    </div>
  );
}

/** What is done with all of them: each is one edit. */
function Acts({ studio: { session }, chosen }: { studio: Studio; chosen: number[] }) {
  const { busy, make } = useEdit(session);
  const axes = useSignal("xyz");
  const shift = useSignal<Point>([0, 0, 0]);
  const held = new Set(session.anchors.value.flatMap((anchor) => anchor.particles));
  const [fixed, able] = [chosen.filter((one) => held.has(one)), !busy && session.connection.value === "live"];
  const move = async () => {
    const pins = (await session.anchorsOfNow()).flatMap((anchor) => {
      const rows = anchor.particles.map((_, i) => i).filter((i) => fixed.includes(anchor.particles[i]!));
      const targets = rows.map((i) => anchor.targets[i]!.map((x, axis) => x + shift.value[axis]!) as Point);
      return rows.length ? [{ particles: rows.map((i) => anchor.particles[i]!), targets, axes: anchor.axes }] : [];
    });
    await make({ pin: pins }, `${counted(fixed.length, "held particle")} moved; Undo takes it back.`);
  };
  const unit = session.topology.value?.units.length ?? "";
  return (
    <>
      <Choice
        name="Hold along"
        hint="The axes along which particles cannot move; xyz: not at all, z: they slide in a level plane"
        value={axes.value}
        choices={AXES}
        done={(to) => (axes.value = to)}
      />
      <div class="row">
        <button
          type="button"
          class="small"
          title="Selected particles stay where they are, along the axes above"
          disabled={!able || !chosen.length}
          onClick={() =>
            void make({ pin: [{ particles: chosen, axes: axes.value }] }, `${counted(chosen.length, "particle")} held.`)
          }
        >
          Hold the selected
        </button>
        <button
          type="button"
          class="small"
          title="Selected particles that are held follow the forces again"
          disabled={!able || !fixed.length}
          onClick={() => void make({ release: fixed }, `${counted(fixed.length, "particle")} released.`)}
        >
          Release the selected
        </button>
      </div>
      <div
        class="components"
        role="group"
        aria-label="Move by"
        title="How far held particles are moved along each axis"
      >
        <span class="seen">Move by</span>
        {shift.value.map((value, axis) => (
          <NumberField
            key={axis}
            name={`Move by ${"xyz"[axis]}`}
            seen={"xyz"[axis]!}
            value={value}
            unit=""
            done={(to) => (shift.value = shift.value.map((old, i) => (i === axis ? (to ?? 0) : old)) as Point)}
          />
        ))}
        <span class="unit">{unit}</span>
      </div>
      <button
        type="button"
        class="small"
        title="Selected particles that are held go so far; Solve finds the form of the others"
        disabled={!able || !fixed.length}
        onClick={() => inTurn(move)}
      >
        Move the held ones
      </button>
    </>
  );
}
