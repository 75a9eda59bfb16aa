// How it is solved.
import type { Field } from "../model";
import type { Session } from "../session";
import { settings } from "./catalogue";
import { Slider } from "./slider";
import { titled, unit } from "./words";

const SHOWN = ["drag", "time_step", "sub_iterations", "tolerance"];
const IN_POWERS = ["tolerance", "time_step"];

export function Settings({ session }: { session: Session }) {
  const scene = session.scene.value;
  if (!scene || !settings.value) return null;
  const shown = SHOWN.map((name) => settings.value?.find((field) => field.name === name)).filter(
    (field) => field !== undefined,
  );
  const solver = settings.value.find((field) => field.name === "solver");
  return (
    <fieldset class="force">
      <legend>Settings</legend>
      {solver && <Solver session={session} field={solver} />}
      {shown.map((field) => (
        <Slider
          key={field.name}
          session={session}
          name={titled(field.name)}
          seen={titled(field.name)}
          value={Number(scene.settings[field.name])}
          unit={unit(field.unit, scene.units)}
          hint={field.description}
          bounds={field.bounds}
          log={IN_POWERS.includes(field.name)}
          whole={field.type === "whole number"}
          patch={(value) => ({ settings: { [field.name]: value } })}
        />
      ))}
    </fieldset>
  );
}

function Solver({ session, field }: { session: Session; field: Field }) {
  return (
    <label class="field">
      <span>Solver</span>
      <select
        value={String(session.scene.value?.settings["solver"])}
        title={field.description}
        disabled={session.connection.value !== "live"}
        onChange={(event) => void session.tell({ settings: { solver: event.currentTarget.value } })}
      >
        {field.choices?.map((name) => (
          <option key={name} value={name}>
            {titled(name)}
          </option>
        ))}
      </select>
    </label>
  );
}
