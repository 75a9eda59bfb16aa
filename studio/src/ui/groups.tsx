// Selections with names: kept by this browser, and in the view of a saved model.
import { useSignal } from "@preact/signals";
import type { Studio } from "./studio";
import { counted } from "./words";

interface Told {
  studio: Studio;
  chosen: number[];
  choose: (particles: number[]) => void;
}

export function Groups({ studio: { options }, chosen, choose }: Told) {
  const name = useSignal("");
  const groups = options.groups.value;
  const keep = (event: Event) => {
    event.preventDefault();
    const called = name.value.trim().slice(0, 80);
    if (!called || !chosen.length) return;
    options.groups.value = { ...groups, [called]: chosen };
    name.value = "";
  };
  const forget = (called: string) =>
    (options.groups.value = Object.fromEntries(Object.entries(groups).filter(([other]) => other !== called)));
  return (
    <>
      <form class="row" onSubmit={keep}>
        <input
        type="text"
          aria-label="Name of the group"
          placeholder="Name"
          value={name.value}
          onInput={(event) => (name.value = event.currentTarget.value)}
        />
        <button type="submit" class="small" disabled={!chosen.length || !name.value.trim()}>
          Keep as a group
        </button>
      </form>
      <ul aria-label="Groups" class="groups">
        {Object.entries(groups).map(([called, particles]) => (
          <li key={called} class="row">
            <button type="button" class="small" onClick={() => choose(particles)}>
              {called}
            </button>
            <span class="faint">{counted(particles.length, "particle")}</span>
            <button
              type="button"
              class="plain"
              aria-label={`Forget the group ${called}`}
              onClick={() => forget(called)}
            >
              ×
            </button>
          </li>
        ))}
      </ul>
    </>
  );
}
