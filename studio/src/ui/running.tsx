// The sessions of the service, of all clients.
import { useEffect, useState } from "preact/hooks";
import * as api from "../api";
import type { Store, Summary } from "../model";
import { refuse, tell } from "./notices";
import { linkTo, met } from "./place";
import { pruneReels } from "./reel";
import { calledOf, counted } from "./words";

const AGAIN = 2000;

export function Running() {
  const [sessions, setSessions] = useState<Summary[] | null>(null);
  const [store, setStore] = useState<Store | null>(null);
  const [fault, setFault] = useState("");
  useEffect(() => {
    let here = true;
    let timer = 0;
    let isFirst = true;
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
        if (isFirst) void pruneReels(new Set(found.sessions.map(({ key }) => key)));
        isFirst = false;
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
          {fault} The list shows the last received state.
        </p>
      )}
      {store && <Stored store={store} />}
      {sessions?.length === 0 && <p class="faint">No sessions: open a figure or file, or start one in Grasshopper.</p>}
      <ul class={fault ? "sessions stale" : "sessions"}>
        {sessions?.map((session) => (
          <Row key={session.key} session={session} forgotten={forgotten} />
        ))}
      </ul>
    </>
  );
}

/** Damage of the store and its losses, until the copy of the damaged files is deleted. */
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
  const name = calledOf(session);
  const forget = async () => {
    if (!window.confirm(`Delete the session "${name}"? This cannot be undone.`)) return;
    try {
      await api.forget(session.key);
      forgotten(session.key);
      tell(`${name} was deleted.`);
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
      <button type="button" class="plain" aria-label={`Delete ${name}`} title="Delete" onClick={() => void forget()}>
        ×
      </button>
    </li>
  );
}

const STATES: Record<string, string> = {
  running: "paused",
  converged: "at rest",
  max_iterations: "iteration limit reached",
  time_limit: "time limit reached",
};

/** The status of a session that does not play, in words. */
export const stateOf = (session: Pick<Summary, "status">) => STATES[session.status] ?? session.status;
