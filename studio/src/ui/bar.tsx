// The bar on top: title, connection and controls of time.
import type { Connection } from "../session";
import type { Action } from "../model";
import { type Mark, Icon } from "./icons";
import { Keys } from "./keys";
import { go } from "./place";
import type { Studio } from "./studio";
import { ThemeChoice } from "./themechoice";

const CHIPS: Record<Exclude<Connection, "silent">, string> = {
  connecting: "Connecting ...",
  live: "Live",
  lost: "Reconnecting ...",
  locked: "Not logged in",
  gone: "Not found",
  broken: "Not compatible",
};

export function Bar({ studio, title }: { studio: Studio; title: string }) {
  const connection = studio.session.connection.value;
  return (
    <header class="bar">
      {!studio.session.readOnly && (
        <a
          class="back"
          href={location.pathname}
          onClick={(event) => {
            event.preventDefault();
            go("");
          }}
        >
          All sessions
        </a>
      )}
      <h1 title={title}>{title}</h1>
      <span class={`chip ${connection}`} role="status">
        {connection === "silent" ? <Quiet studio={studio} /> : CHIPS[connection]}
      </span>
      {studio.session.readOnly ? <span class="chip reading">Read only</span> : <Transport studio={studio} />}
      <Keys studio={studio} />
      <ThemeChoice />
    </header>
  );
}

/** It plays or an order waits, and nothing comes. The seconds are not read out: they change all the time. */
function Quiet({ studio: { pulse, session } }: { studio: Studio }) {
  const beat = pulse.beat.value;
  const answers = beat === null || beat === "slow";
  if (!session.summary.value?.playing)
    return (
      <>
        {answers ? "Waiting" : "No answer"} <span aria-hidden="true">for {pulse.age.value} s</span>
      </>
    );
  return (
    <>
      {beat === null ? "Last" : answers ? "Slow: last" : "No answer: last"} update{" "}
      <span aria-hidden="true">{pulse.age.value} s ago</span>
    </>
  );
}

interface Control {
  name: string;
  mark: Mark;
  action: Action;
  hint: string;
  keys?: string;
}

const CONTROLS: Control[] = [
  { name: "Play", mark: "play", action: "play", hint: "Play in real time", keys: "Space" },
  { name: "Pause", mark: "pause", action: "pause", hint: "Pause", keys: "Space" },
  { name: "Step", mark: "step", action: "step", hint: "One frame forward", keys: "." },
  { name: "Solve", mark: "rest", action: "relax", hint: "Solve to equilibrium; Pause keeps the shape so far" },
  { name: "Reset", mark: "reset", action: "reset", hint: "Go back to the start; edits are kept" },
  { name: "Undo", mark: "undo", action: "undo", hint: "Undo the last edit", keys: "Control+Z" },
  { name: "Redo", mark: "redo", action: "redo", hint: "Redo the last undone edit", keys: "Control+Shift+Z" },
];

function Transport({ studio: { session } }: { studio: Studio }) {
  const summary = session.summary.value;
  const live = session.connection.value === "live" || session.connection.value === "silent";
  const able = (action: Action) =>
    live && (action === "undo" ? summary?.undo !== 0 : action === "redo" ? summary?.redo !== 0 : true);
  const pressed = (name: string) =>
    name === "Play" ? summary?.playing === true : name === "Pause" ? summary?.playing === false : undefined;
  return (
    <div class="transport" role="group" aria-label="Time">
      {CONTROLS.map(({ name, mark, action, hint, keys }) => (
        <button
          key={name}
          type="button"
          disabled={!able(action)}
          aria-pressed={pressed(name)}
          aria-keyshortcuts={keys}
          title={keys ? `${hint} (${keys})` : hint}
          onClick={() => void session.tell(action)}
        >
          <Icon mark={mark} />
          {name}
        </button>
      ))}
    </div>
  );
}
