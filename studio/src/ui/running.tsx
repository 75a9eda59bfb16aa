// The sessions of the service, whoever started them.
import { useEffect, useState } from "preact/hooks";
import * as api from "../api";
import type { Store, Summary } from "../model";
import { refuse, tell } from "./notices";
import { linkTo, met } from "./place";
import { counted } from "./words";

const AGAIN = 2000;

export function Running() {
  const [sessions, setSessions] = useState<Summary[] | null>(null);
  const [store, setStore] = useState<Store | null>(null);
  const [fault, setFault] = useState("");
  useEffect(() => {
    let here = true;
    let timer = 0;
    const read = async () => {
      const found = await api.sessions().catch((error: Error) => {
        met(error);
        return error;
      });
      if (!here) return;
      setFault(found instanceof Error ? found.message : "");
      if (!(found instanceof Error)) {
        setSessions(found.sessions);
        setStore(found.store ?? null);
      }
      timer = window.setTimeout(read, document.hidden ? 5 * AGAIN : AGAIN);
    };
    void read();
    return () => {
      here = false;
      clearTimeout(timer);
    };
  }, []);
  const forgotten = (key: string) => setSessions((now) => now?.filter((session) => session.key !== key) ?? null);
  return (
    <>
      {fault && (
        <p class="fault" role="alert">
          {fault} What follows is as it was last known.
        </p>
      )}
      {store && <Stored store={store} />}
      {sessions?.length === 0 && <p class="faint">None yet: open a figure or a file, or begin one in Grasshopper.</p>}
      <ul class={fault ? "sessions stale" : "sessions"}>
        {sessions?.map((session) => (
          <Row key={session.key} session={session} forgotten={forgotten} />
        ))}
      </ul>
    </>
  );
}

/** What is wrong with the store, and what was lost from it, until the copy of the damaged files is deleted. */
function Stored({ store }: { store: Store }) {
  const losses = (store.repairs ?? []).flatMap((repair) => repair.losses);
  if (!store.warnings.length && !losses.length) return null;
  return (
    <div class="stored" role="status" aria-label="The store">
      {store.warnings.map((warning) => (
        <p key={warning}>{warning}</p>
      ))}
      <ul>
        {losses.map((loss) => (
          <li key={loss.what}>{loss.what}</li>
        ))}
      </ul>
    </div>
  );
}

function Row({ session, forgotten }: { session: Summary; forgotten: (key: string) => void }) {
  const name = session.label || session.key;
  const forget = async () => {
    if (!window.confirm(`Forget the session "${name}"? It cannot be brought back.`)) return;
    try {
      await api.forget(session.key);
      forgotten(session.key);
      tell(`${name} is forgotten.`);
    } catch (error) {
      met(error);
      refuse(error);
    }
  };
  return (
    <li>
      <a href={linkTo(session.key)}>{name}</a>
      <span class="faint">
        {counted(session.particles, "particle")} · {session.playing ? "playing" : stateOf(session)}
      </span>
      <button type="button" class="plain" aria-label={`Forget ${name}`} title="Forget" onClick={() => void forget()}>
        ×
      </button>
    </li>
  );
}

const STATES: Record<string, string> = {
  running: "paused",
  converged: "at rest",
  max_iterations: "ended by its limit of iterations",
  time_limit: "ended by its limit of time",
};

/** How a session that does not play stands, in words. */
export const stateOf = (session: Summary) => STATES[session.status] ?? session.status;
