// What may vary in a design problem: columns of forces and anchors, all, each, or those of a group; with bounds.
import { useSignal } from "@preact/signals";
import type { Variable } from "../designs";
import type { Scene, Topology } from "../model";
import type { Options } from "../view/types";
import { isValue } from "./amounts";
import { kinds } from "./catalogue";
import { anchorsOf, nameOf, numberOf } from "./designing";
import { titleOf } from "./forces";
import { NumberField } from "./number";
import type { Studio } from "./studio";
import { unit } from "./words";

/** Types of columns whose numbers can vary. */
const TYPES = ["number", "numbers", "vector", "vectors"];

/** Something of a scene that may vary. */
interface Choice {
  key: string;
  seen: string;
  group: string;
  vary: Pick<Variable, "force" | "field" | "anchor">;
  /** Axes to choose from; "" for a column of plain numbers. */
  axes: string;
}

export function Variables({ studio }: { studio: Studio }) {
  const { session, design } = studio;
  const scene = session.scene.value!;
  const { variables } = design.problem.value;
  const put = (number: number, part: Partial<Variable>) =>
    design.change({ variables: variables.map((one, i) => (i === number ? clean({ ...one, ...part }) : one)) });
  return (
    <section class="part" aria-label="What may vary">
      <h3>What may vary</h3>
      {variables.map((variable, i) => {
        const measure = unit(unitOf(variable, scene), scene.units);
        const bound = (which: "lower" | "upper", seen: string, placeholder: string) => (
          <NumberField
            name={`${seen} ${variable.name}`}
            seen={seen}
            value={variable[which] ?? null}
            unit={measure}
            hint={
              variable.anchor !== undefined && variable.tie === "all"
                ? "Of the shift of the anchor as a whole"
                : "The search keeps to it"
            }
            placeholder={placeholder}
            done={(to) => put(i, to === null ? { [which]: undefined } : { [which]: to })}
          />
        );
        return (
          <fieldset key={variable.name} class="item">
            <legend>{variable.name}</legend>
            {bound("lower", "At least", "no bound")}
            {bound("upper", "At most", "no bound")}
            <button
              type="button"
              class="small"
              aria-label={`Remove ${variable.name}`}
              onClick={() => design.change({ variables: variables.filter((_, other) => other !== i) })}
            >
              Remove
            </button>
          </fieldset>
        );
      })}
      <AddVariable studio={studio} />
    </section>
  );
}

/** Without what was emptied. */
const clean = (variable: Variable) =>
  Object.fromEntries(Object.entries(variable).filter(([, value]) => value !== undefined)) as unknown as Variable;

function unitOf({ force, field }: Variable, scene: Scene): string {
  if (force === undefined) return "length";
  const kind = kinds.value?.get(scene.forces[numberOf(scene.forces, force)]?.kind ?? "");
  return kind?.fields.find(({ name }) => name === field)?.unit ?? "-";
}

function AddVariable({ studio: { session, design, options } }: { studio: Studio }) {
  const [scene, topology] = [session.scene.value!, session.topology.value!];
  const chosen = useSignal("");
  const tie = useSignal("all");
  const axes = useSignal("");
  const fault = useSignal("");
  const open = choices(scene);
  const choice = open.find(({ key }) => key === chosen.value) ?? open[0];
  if (!choice) return <p class="faint">This scene has no values that can vary.</p>;
  const ties = tiesOf(choice, options);
  const wanted = ties.find(([key]) => key === tie.value)?.[0] ?? "all";
  const along = subsets(choice.axes).includes(axes.value) ? axes.value : choice.axes;
  const add = (event: Event) => {
    event.preventDefault();
    const form = event.currentTarget as Element;
    const among = () => [elementsOf(choice, wanted, { topology, scene, options })];
    const tied = wanted === "all" || wanted === "each" ? wanted : among();
    fault.value = typeof tied !== "string" && !tied[0]!.length ? `No element of ${choice.group} is among these.` : "";
    if (fault.value) return;
    const taken = design.problem.value.variables;
    const group = wanted.startsWith(OF_GROUP) && wanted.slice(OF_GROUP.length);
    const seen = [choice.seen, along !== choice.axes && along, group].filter(Boolean).join(" ");
    const name = free(
      seen,
      taken.map((one) => one.name),
    );
    const variable: Variable = { ...choice.vary, name, tie: tied, ...(along && { axes: along }) };
    design.change({ variables: [...taken, variable] });
    fold(form);
  };
  return (
    <details class="seldom">
      <summary title="Values that the search may change, with their limits">Add what may vary</summary>
      <form class="addforce" onSubmit={add}>
        <label class="field" title="A value of a force, or the place of an anchor">
          <span>Value</span>
          <select
            aria-label="Value"
            value={choice.key}
            onChange={(event) => (chosen.value = event.currentTarget.value)}
          >
            {[...new Set(open.map(({ group }) => group))].map((group) => (
              <optgroup key={group} label={group}>
                {open
                  .filter((one) => one.group === group)
                  .map((one) => (
                    <option key={one.key} value={one.key}>
                      {one.seen}
                    </option>
                  ))}
              </optgroup>
            ))}
          </select>
        </label>
        <label class="field" title="One value for many elements, or a value for each of them">
          <span>Elements</span>
          <select aria-label="Elements" value={wanted} onChange={(event) => (tie.value = event.currentTarget.value)}>
            {ties.map(([key, seen]) => (
              <option key={key} value={key}>
                {seen}
              </option>
            ))}
          </select>
        </label>
        {choice.axes && (
          <label class="field">
            <span>Along</span>
            <select aria-label="Along" value={along} onChange={(event) => (axes.value = event.currentTarget.value)}>
              {subsets(choice.axes).map((some) => (
                <option key={some} value={some}>
                  {[...some].join(", ")}
                </option>
              ))}
            </select>
          </label>
        )}
        {fault.value && (
          <p class="fault" role="alert">
            {fault.value}
          </p>
        )}
        <button type="submit" title="The search changes this value between the limits above">
          Let it vary
        </button>
      </form>
    </details>
  );
}

/** All of a scene that may vary. */
function choices(scene: Scene): Choice[] {
  const found: Choice[] = scene.forces.flatMap((force, number) => {
    const kind = kinds.value?.get(force.kind);
    const group = titleOf(force, kind, number);
    return (kind?.fields ?? [])
      .filter(({ name, type }) => TYPES.includes(type) && isValue(force[name]))
      .map(({ name, type }) => ({
        key: `force ${number} ${name}`,
        seen: `${group} ${name.replaceAll("_", " ")}`,
        group,
        vary: { force: nameOf(scene.forces, number), field: name },
        axes: type.startsWith("vector") ? "xyz" : "",
      }));
  });
  const anchors = anchorsOf(scene);
  anchors.forEach(({ name, axes }, number) => {
    const group = name || `Anchor ${number}`;
    found.push({
      key: `anchor ${number}`,
      seen: `${group} position`,
      group: "Anchors",
      vary: { anchor: nameOf(anchors, number) },
      axes,
    });
  });
  return found;
}

const AXES = ["x", "y", "z", "xy", "xz", "yz", "xyz"];

const subsets = (axes: string) => AXES.filter((some) => [...some].every((axis) => axes.includes(axis)));

const OF_GROUP = "group ";

function tiesOf({ vary }: Choice, options: Options): [string, string][] {
  if (vary.anchor !== undefined)
    return [
      ["all", "Together: the anchor moves as a whole"],
      ["each", "Each particle by itself"],
    ];
  const found: [string, string][] = [
    ["all", "All have one value"],
    ["each", "Each its own value"],
  ];
  if (options.marked.value.length) found.push(["selected", "Those of the selected particles, one value"]);
  for (const name of Object.keys(options.groups.value)) found.push([OF_GROUP + name, `Those of ${name}, one value`]);
  return found;
}

/** Elements of a force all of whose particles are selected, or in a group. */
function elementsOf(
  { vary }: Choice,
  which: string,
  { topology, scene, options }: { topology: Topology; scene: Scene; options: Options },
): number[] {
  const groups = options.groups.value;
  const among = new Set(which === "selected" ? options.marked.value : groups[which.slice(OF_GROUP.length)]);
  const number = numberOf(scene.forces, vary.force!);
  const springs = topology.springs.filter((_, i) => topology.spring_forces[i] === number);
  const rows = springs.length ? springs : ((scene.forces[number]?.["particles"] ?? []) as (number | number[])[]);
  return [...rows.keys()].filter((i) => [rows[i]!].flat().every((particle) => among.has(particle)));
}

/** Fold the form away that has done its work. */
export const fold = (form: Element) => form.closest("details")?.removeAttribute("open");

/** A name that none of these has. */
export function free(name: string, taken: string[]): string {
  let found = name;
  for (let n = 2; taken.includes(found); n++) found = `${name} ${n}`;
  return found;
}
