// The parameters of the family that a model was made from. Each change makes the model again and can be undone.
import { useEffect } from "preact/hooks";
import type { Session } from "../session";
import { Choice } from "./choice";
import { families, knowFamilies, seenOf } from "./families";
import { Slider } from "./slider";

export function Shape({ session }: { session: Session }) {
  const live = session.connection.value === "live";
  const scene = session.scene.value;
  const made = scene?.family;
  useEffect(() => {
    if (live) knowFamilies().catch(() => undefined);
  }, [live]);
  const family = families.value?.find(({ name }) => name === made?.name);
  if (!scene || !made) return null;
  if (!family) return <p class="faint">Loading the parameters ...</p>;
  return (
    <fieldset class="force">
      <legend title={family.summary}>{family.title}</legend>
      {family.parameters.map((field) => {
        const { seen, ...told } = seenOf(field, scene.units);
        const value = made.parameters[field.name] ?? (field.default as number | string);
        const rebuild = (to: number | string) => ({ rebuild: { [field.name]: to } });
        if (typeof value === "string")
          return (
            <Choice
              key={field.name}
              name={seen}
              value={value}
              choices={field.choices ?? []}
              hint={told.hint}
              disabled={!live}
              done={(to) => void session.tell(rebuild(to))}
            />
          );
        return (
          <Slider
            key={field.name}
            session={session}
            name={seen}
            seen={seen}
            {...told}
            value={value}
            bounds={field.bounds}
            log={field.name.endsWith("stiffness")}
            patch={rebuild}
          />
        );
      })}
      <p class="note">A change makes the model again. Values and loads on the whole net stay; undo pins first.</p>
    </fieldset>
  );
}
