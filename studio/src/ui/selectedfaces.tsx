// Single faces selected: by clicks, a box, a line around them, strips, parts or numbers. Forces are then put on them.
import { useSignal } from "@preact/signals";
import type { Topology } from "../model";
import { enclosedBy } from "./selecting";
import { joined, present, rimOf, strip } from "../view/faces";
import { facesOf } from "../view/form";
import type { Studio } from "./studio";
import { numbered } from "./targets";
import { counted } from "./words";

export function SelectedFaces({ studio }: { studio: Studio }) {
  const { options, session } = studio;
  const fault = useSignal("");
  const topology = session.topology.value;
  if (!topology) return null;
  const all = facesOf(topology);
  const chosen = present(topology, options.markedFaces.value);
  const choose = (faces: number[][]) => (options.markedFaces.value = faces);
  const last = chosen.at(-1);
  const along = (isAcross: boolean) => {
    if (last) choose(strip(all, last, chosen.at(-2) ?? null, isAcross));
  };
  const button = (name: string, hint: string, does: () => void, able = true) => (
    <button type="button" class="small" title={hint} disabled={!able} onClick={does}>
      {name}
    </button>
  );
  const byNumber = (text: string) => {
    const numbers = numbered(text);
    const beyond = typeof numbers === "string" ? undefined : numbers.find((one) => one >= all.length);
    fault.value =
      typeof numbers === "string"
        ? numbers.replace("particle", "face")
        : beyond === undefined
          ? ""
          : `There is no face ${beyond}; the model has ${all.length}, counted from 0.`;
    if (typeof numbers !== "string" && beyond === undefined) choose(numbers.map((one) => all[one]!));
  };
  const ends = () => {
    options.element.value = "particles";
    [options.picked.value, options.marked.value] = [null, [...new Set(chosen.flat())].sort((a, b) => a - b)];
  };
  const rim = () => {
    options.element.value = "particles";
    [options.picked.value, options.marked.value] = [null, [...new Set(rimOf(chosen).flat())].sort((a, b) => a - b)];
  };
  return (
    <>
      <div class="row" role="group" aria-label="Ways to select faces">
        {enclosedBy(options)}
        {button("Strip", "Faces from edge to opposite edge: on from the last two selected", () => along(false), !!last)}
        {button("Strip across", "The same, the other way through the last one selected", () => along(true), !!last)}
        {button("All faces", "All faces of all meshes", () => choose(all))}
        {button("Invert faces", "Those that are not selected", () => choose(joined(all, chosen, false)))}
        {button("No faces", "Nothing", () => choose([]), chosen.length > 0)}
      </div>
      <PartOf topology={topology} choose={choose} />
      <label class="field" title={`Faces by number, in the order of the meshes, 0 to ${all.length - 1}; Enter selects`}>
        <span>Face numbers</span>
        <input
          type="text"
          aria-label="Face numbers"
          placeholder={all.length ? "0 3 5-8" : "none"}
          onChange={(event) => byNumber(event.currentTarget.value)}
        />
      </label>
      {fault.value && (
        <p class="fault" role="alert">
          {fault.value}
        </p>
      )}
      <div class="row">
        {button("Their particles", "Select the particles at their corners", ends, chosen.length > 0)}
        {button("Their edge", "Select the particles along the edge of these faces", rim, chosen.length > 0)}
      </div>
      <p role="status" class="note">
        {counted(chosen.length, "face")} selected.{" "}
        {all.length ? "Click a face to add or remove it." : "The model has no faces."}
        {!session.readOnly && ' Forces are added to them by "Selected faces" below.'}
      </p>
    </>
  );
}

/** All faces of a mesh, by its name. */
function PartOf({ topology, choose }: { topology: Topology; choose: (faces: number[][]) => void }) {
  const names = Object.keys(topology.meshes);
  return (
    <label class="field" title="All faces of a mesh, by its name">
      <span>A mesh</span>
      <select
        aria-label="Select a mesh"
        value=""
        disabled={!names.length}
        onChange={(event) => {
          const mesh = topology.meshes[event.currentTarget.value];
          if (mesh) choose(mesh.faces);
        }}
      >
        <option value="">choose one</option>
        {names.map((name) => (
          <option key={name} value={name}>
            {name}
          </option>
        ))}
      </select>
    </label>
  );
}
