// Selections with names: kept by this browser, and in the view of a saved model.
import { useSignal } from "@preact/signals";
import type { Studio } from "./studio";
import { counted } from "./words";

/** Colours that people who are colour-blind tell apart; source: Okabe and Ito, Color universal design, 2008. */
const COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"];

interface Told {
  studio: Studio;
  chosen: number[];
  choose: (particles: number[]) => void;
}

export function Groups({ studio: { options, session }, chosen, choose }: Told) {
  const isOwn = !session.readOnly;
  const name = useSignal("");
  const groups = options.groups.value;
  const paint = (called: string, colour: string) =>
    (options.groupColours.value = { ...options.groupColours.value, [called]: colour });
  const keep = (event: Event) => {
    event.preventDefault();
    const called = name.value.trim().slice(0, 80);
    if (!called || !chosen.length) return;
    options.groups.value = { ...groups, [called]: chosen };
    const taken = Object.values(options.groupColours.value);
    const free = COLOURS.find((one) => !taken.includes(one)) ?? COLOURS[taken.length % COLOURS.length]!;
    paint(called, options.groupColours.value[called] ?? free);
    name.value = "";
  };
  const forget = (called: string) => {
    const without = <T,>(all: Record<string, T>) =>
      Object.fromEntries(Object.entries(all).filter(([other]) => other !== called));
    options.groups.value = without(groups);
    options.groupColours.value = without(options.groupColours.value);
  };
  return (
    <>
      {isOwn && (
        <form class="row" onSubmit={keep}>
          <input
            type="text"
            aria-label="Name of the group"
            title="A name for the selected particles, such as edge"
            placeholder="Name"
            value={name.value}
            onInput={(event) => (name.value = event.currentTarget.value)}
          />
          <button
            type="submit"
            class="small"
            title="The selection under this name, with a colour; saved with the model"
            disabled={!chosen.length || !name.value.trim()}
          >
            Keep as a group
          </button>
        </form>
      )}
      <ul aria-label="Groups" class="groups">
        {Object.entries(groups).map(([called, particles]) => (
          <li key={called} class="row">
            <input
              type="color"
              class="swatch"
              aria-label={`Colour of the group ${called}`}
              title="Rings of this colour mark the particles of the group"
              disabled={!isOwn}
              value={options.groupColours.value[called] ?? COLOURS[0]}
              onInput={(event) => paint(called, event.currentTarget.value)}
            />
            <button type="button" class="small" title="Select the group" onClick={() => choose(particles)}>
              {called}
            </button>
            <span class="faint">{counted(particles.length, "particle")}</span>
            {isOwn && (
              <button
                type="button"
                class="plain"
                aria-label={`Forget the group ${called}`}
                title="Forget the group; its particles stay"
                onClick={() => forget(called)}
              >
                ×
              </button>
            )}
          </li>
        ))}
      </ul>
    </>
  );
}
