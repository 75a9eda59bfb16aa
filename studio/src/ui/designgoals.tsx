// Goals and constraints of a design problem: quantities by the service's schema, goals with sliders of their targets.
import { useSignal } from "@preact/signals";
import { type Measured, type Variable, measure } from "../designs";
import type { Scene } from "../model";
import { titled, unit } from "./words";
import { quantities } from "./catalogue";
import { type Aim, type Goal, type Limit, anchorsOf, nameOf } from "./designing";
import { type Place, Fields, read } from "./designplace";
import { fold, free } from "./designvariables";
import { refuse } from "./notices";
import { NumberField } from "./number";
import { Lead } from "./slider";
import type { Studio } from "./studio";

/** So many values have a slider each. */
const FEW = 3;

const AIMS: [Aim, string][] = [
  ["target", "A target"],
  ["range", "A range"],
  ["least", "As little as possible"],
];

export function Goals({ studio }: { studio: Studio }) {
  const { design, session } = studio;
  const { goals } = design.problem.value;
  const put = (number: number, part: Partial<Goal>) =>
    design.change({ goals: goals.map((one, i) => (i === number ? { ...one, ...part } : one)) });
  return (
    <section class="part" aria-label="Goals">
      <h3>Goals</h3>
      {goals.map((goal, i) => (
        <fieldset key={goal.name} class="item" aria-label={`Goal ${goal.name}`}>
          <legend>{goal.name}</legend>
          <label class="field">
            <span>Asks for</span>
            <select
              aria-label={`Aim of ${goal.name}`}
              value={goal.aim}
              onChange={(event) => put(i, { aim: event.currentTarget.value as Aim })}
            >
              {AIMS.map(([aim, seen]) => (
                <option key={aim} value={aim}>
                  {seen}
                </option>
              ))}
            </select>
          </label>
          {goal.aim === "target" && <Targets goal={goal} scene={session.scene.value!} put={(part) => put(i, part)} />}
          {goal.aim === "range" && <Ends of={goal} scene={session.scene.value!} put={(part) => put(i, part)} />}
          <NumberField
            name={`Weight of ${goal.name}`}
            seen="Weight"
            value={goal.weight ?? 1}
            unit=""
            hint="How much it counts beside other goals: their squared distances are added by weight. Usually 1"
            bounds={{ more_than: 0 }}
            done={(to) => to !== null && put(i, { weight: to })}
          />
          <Remove name={goal.name} done={() => design.change({ goals: goals.filter((_, other) => other !== i) })} />
        </fieldset>
      ))}
      <Add studio={studio} what="goal" />
    </section>
  );
}

export function Constraints({ studio }: { studio: Studio }) {
  const { design, session } = studio;
  const { constraints } = design.problem.value;
  const put = (number: number, part: Partial<Limit>) =>
    design.change({ constraints: constraints.map((one, i) => (i === number ? { ...one, ...part } : one)) });
  return (
    <section class="part" aria-label="Constraints">
      <h3>Constraints</h3>
      {constraints.map((limit, i) => (
        <fieldset key={limit.name} class="item" aria-label={`Constraint ${limit.name}`}>
          <legend>{limit.name}</legend>
          <Ends of={limit} scene={session.scene.value!} put={(part) => put(i, part)} />
          <Remove
            name={limit.name}
            done={() => design.change({ constraints: constraints.filter((_, other) => other !== i) })}
          />
        </fieldset>
      ))}
      <Add studio={studio} what="constraint" />
    </section>
  );
}

function Remove({ name, done }: { name: string; done: () => void }) {
  return (
    <button type="button" class="small" aria-label={`Remove ${name}`} onClick={done}>
      Remove
    </button>
  );
}

interface Led<Of> {
  scene: Scene;
  put: (part: Partial<Of>) => void;
}

/** A slider for the target of each value, or of many one for all. */
function Targets({ goal, scene, put }: Led<Goal> & { goal: Goal }) {
  const all = [goal.target ?? 0].flat();
  const axes = typeof goal["axes"] === "string" && goal["axes"].length === all.length ? [...goal["axes"]] : [];
  const seen = (i: number) => (all.length === 1 ? "Target" : `Target ${axes[i] ?? i}`);
  return all.map((value, i) => (
    <Lead
      key={i}
      name={`${seen(i)} of ${goal.name}`}
      seen={seen(i)}
      value={value}
      unit={unit(goal.unit, scene.units)}
      hint={quantities.value?.get(goal.kind)?.summary ?? ""}
      {...(goal.values.length > all.length && { note: `One target for ${goal.values.length} values.` })}
      lead={(to) => put({ target: all.length === 1 ? to : all.map((old, j) => (j === i ? to : old)) })}
    />
  ));
}

function Ends({ of, scene, put }: Led<{ lower?: number; upper?: number }> & { of: Goal | Limit }) {
  const end = (which: "lower" | "upper", seen: string) => (
    <NumberField
      name={`${seen} ${of.name}`}
      seen={seen}
      value={of[which] ?? null}
      unit={unit(of.unit, scene.units)}
      hint={quantities.value?.get(of.kind)?.summary ?? ""}
      placeholder="no limit"
      done={(to) => put({ [which]: to ?? undefined } as { lower?: number })}
    />
  );
  return (
    <>
      {end("lower", "At least")}
      {end("upper", "At most")}
    </>
  );
}

/** A form for a goal or a constraint of any kind. */
function Add({ studio, what }: { studio: Studio; what: "goal" | "constraint" }) {
  const { session, design, options } = studio;
  const scene = session.scene.value!;
  const name = useSignal("position");
  const typed = useSignal<Record<string, string>>({});
  const ends = useSignal<{ lower: number | null; upper: number | null }>({ lower: null, upper: null });
  const fault = useSignal("");
  const busy = useSignal(false);
  const kind = quantities.value!.get(name.value) ?? [...quantities.value!.values()][0]!;
  const place: Place = { scene, topology: session.topology.value!, options };
  const add = async (event: Event) => {
    event.preventDefault();
    const form = event.currentTarget as Element;
    const given = read(kind, typed.value, place);
    const { lower, upper } = ends.value;
    if (typeof given === "string") return void (fault.value = given);
    if (what === "constraint" && lower === null && upper === null)
      return void (fault.value = "Give the least value, the largest, or both.");
    const { goals, constraints } = design.problem.value;
    const taken = [...goals, ...constraints].map((one) => one.name);
    const called = free(`${titled(kind.kind)} of ${given.seen}`, taken);
    const own: Measured = { ...given.fields, kind: kind.kind, name: called };
    [busy.value, fault.value] = [true, ""];
    try {
      const values = (await measure(scene, [anything(scene)], [own])).values[0]!;
      const { unit: words } = kind;
      if (what === "goal")
        design.change({ goals: [...goals, { ...own, aim: "target", target: first(values), unit: words, values }] });
      else {
        const limits = { ...(lower !== null && { lower }), ...(upper !== null && { upper }) };
        design.change({ constraints: [...constraints, { ...own, ...limits, unit: words, values }] });
      }
      typed.value = {};
      ends.value = { lower: null, upper: null };
      fold(form);
    } catch (error) {
      refuse(error, `The ${what} was not added. `);
    } finally {
      busy.value = false;
    }
  };
  const limit = (which: "lower" | "upper", seen: string) => (
    <NumberField
      name={seen}
      seen={seen}
      value={ends.value[which]}
      unit={unit(kind.unit, scene.units)}
      placeholder="no limit"
      done={(to) => (ends.value = { ...ends.value, [which]: to })}
    />
  );
  return (
    <details class="seldom">
      <summary title="A quantity with its aim or its limits">Add a {what}</summary>
      <form class="addforce" aria-label={`New ${what}`} onSubmit={(event) => void add(event)}>
        <label class="field">
          <span>Measures</span>
          <select
            aria-label="Measures"
            value={kind.kind}
            title={kind.summary}
            onChange={(event) => {
              name.value = event.currentTarget.value;
              [typed.value, fault.value] = [{}, ""];
            }}
          >
            {[...quantities.value!.values()].map((other) => (
              <option key={other.kind} value={other.kind}>
                {titled(other.kind)}
              </option>
            ))}
          </select>
        </label>
        <p class="note">{kind.summary}</p>
        <Fields kind={kind} typed={typed.value} place={place} put={(now) => (typed.value = now)} />
        {what === "constraint" && limit("lower", "At least")}
        {what === "constraint" && limit("upper", "At most")}
        {fault.value && (
          <p class="fault" role="alert">
            {fault.value}
          </p>
        )}
        <button type="submit" disabled={busy.value || session.connection.value !== "live"}>
          Add the {what}
        </button>
      </form>
    </details>
  );
}

/** Targets to begin with: what is there now, rounded. */
function first(values: number[]): number | number[] {
  const round = (value: number) => Number(value.toPrecision(4)) || 0;
  if (values.length > FEW) return round(values.reduce((sum, value) => sum + value, 0) / values.length);
  return values.length === 1 ? round(values[0]!) : values.map(round);
}

/** Something of a scene that could vary: the service measures goals together with their derivatives. */
function anything(scene: Scene): Variable {
  const anchors = anchorsOf(scene);
  if (anchors.length) return { name: "", anchor: 0, axes: anchors[0]!.axes, tie: "each" };
  const springs = scene.forces.findIndex(({ kind }) => kind === "springs");
  return { name: "", force: nameOf(scene.forces, Math.max(0, springs)), field: "stiffness", tie: "each" };
}
