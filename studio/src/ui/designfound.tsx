// What a search has found: how the best values stand to goals, constraints and bounds, in words, and their use.
import { useSignal } from "@preact/signals";
import type { Answer, Numbers } from "../designs";
import type { Units } from "../model";
import { refuse, tell } from "./notices";
import type { Studio } from "./studio";
import { measured, said, unit } from "./words";

/** So many values are written out. */
const FEW = 3;

export function Found({ studio }: { studio: Studio }) {
  const { session, design } = studio;
  const [answer, scene] = [design.answer.value, session.scene.value];
  if (!answer || !scene) return null;
  const { units } = scene;
  const stopped = design.search.value.stage === "stopped";
  return (
    <section class="found" aria-label="Best values">
      <h3>{stopped ? "Best values so far" : "Best values"}</h3>
      {!design.isCurrent && <p class="note">Of the problem before its last change.</p>}
      <p>{plainly(answer)}</p>
      <ul aria-label="Values">
        {answer.variables.map((entry, i) => (
          <li key={i}>
            {entry.name}: <strong class="numbers">{numbers(entry.value, entry.unit, units)}</strong>
            {boundOf(entry.at_bound)} {gainOf(entry, units)}
          </li>
        ))}
      </ul>
      <ul aria-label="Goals and constraints" class="verdicts">
        {answer.goals.map((entry, i) => (
          <li key={i} class={entry.met === false ? "missed" : ""}>
            {goalOf(entry, units)}
          </li>
        ))}
        {answer.constraints.map((entry, i) => (
          <li key={`c${i}`} class={entry.met ? "" : "missed"}>
            {entry.name}: <span class="numbers">{numbers(entry.value, entry.unit, units)}</span>.{" "}
            {entry.met ? "The constraint is met." : "The constraint is not met."}
          </li>
        ))}
      </ul>
      {answer.warnings.map((warning) => (
        <p key={warning} class="note">
          {warning}
        </p>
      ))}
      <Use studio={studio} />
    </section>
  );
}

/** Gives the model the values found: one edit, and Solve. */
function Use({ studio: { session, design } }: { studio: Studio }) {
  const busy = useSignal(false);
  const use = async () => {
    busy.value = true;
    try {
      await session.edit(design.values());
      tell("The model has these values now. Undo restores the ones before.");
      await session.act("relax");
    } catch (error) {
      refuse(error, "The values were not used. ");
    } finally {
      busy.value = false;
    }
  };
  return (
    <div class="row">
      <button
        type="button"
        disabled={busy.value || session.connection.value !== "live"}
        title="Give the model these values and solve; Undo restores the ones before"
        onClick={() => void use()}
      >
        Use these values
      </button>
      <button type="button" onClick={() => (design.answer.value = null)}>
        Hide
      </button>
    </div>
  );
}

const ENDS: Record<string, string> = {
  infeasible: "The constraints cannot all be met.",
  unbounded: "The objective falls without end: give bounds.",
  max_iterations: "The limit of iterations was reached.",
  stalled: "No step leads further.",
  cancelled: "Stopped before the end.",
};

const plainly = ({ status, message }: Answer) => [ENDS[status], message].filter(Boolean).join(" ");

const flat = (value: Numbers) => [value].flat(2);

function numbers(value: Numbers, words: string, units: Units): string {
  const all = flat(value);
  const measure = unit(words, units);
  if (all.length <= FEW) return `${all.map((one) => said(one)).join(", ")}${measure && ` ${measure}`}`;
  const [least, most] = [Math.min(...all), Math.max(...all)];
  return `${all.length} values from ${said(least)} to ${measured(most, measure)}`;
}

function boundOf(bounds: Answer["variables"][number]["at_bound"]): string {
  const all = [bounds].flat(2);
  const held = all.filter(Boolean).length;
  if (!held) return ".";
  return all.length === 1 ? ", at its bound." : `, ${held} of ${all.length} at a bound.`;
}

/** What a bound costs: only where one alone does. */
function gainOf({ gain, unit: words }: Answer["variables"][number], units: Units): string {
  const all = gain === null ? [] : flat(gain);
  if (all.length !== 1 || !all[0]) return "";
  return `A bound wider by ${measured(1, unit(words, units))} lowers the objective at a rate of ${said(all[0], 3)}.`;
}

function goalOf({ name, value, target, met, unit: words, conflicts }: Answer["goals"][number], units: Units): string {
  const now = `${name}: ${numbers(value, words, units)}`;
  if (target === null) return `${now}, as little as possible.`;
  const wanted = `${now}, wanted ${numbers(target, words, units)}.`;
  if (met) return `${wanted} Met.`;
  const aims = flat(target);
  const missed = Math.max(...flat(value).map((one, i) => Math.abs(one - (aims[i] ?? aims[0]!))));
  const against = conflicts.length ? ` It conflicts with ${conflicts.join(", ")}.` : "";
  return `${wanted} Missed by ${measured(missed, unit(words, units))}.${against}`;
}
