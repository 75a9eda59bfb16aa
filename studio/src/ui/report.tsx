// The status of the session in a sentence, the warnings of its report, and losses.
import { useEffect } from "preact/hooks";
import type { Beat } from "./pulse";
import { isLoose, Repairs } from "./repairs";
import { tellReturns } from "./returns";
import { Stable } from "./stable";
import type { Studio } from "./studio";
import { stateOf } from "./running";
import { measured, particlesOf, plain, said, titled } from "./words";

export function Report({ studio }: { studio: Studio }) {
  useEffect(() => tellReturns(studio.session), [studio]);
  return (
    <section class="report" aria-label="Status" tabIndex={0}>
      <Lost studio={studio} />
      <Standing studio={studio} />
      <Stable studio={studio} />
      <Warnings studio={studio} />
      {!studio.session.readOnly && <Repairs session={studio.session} />}
    </section>
  );
}

const SILENT: Record<Beat | "waits", string> = {
  slow: "The session is running, but updates arrive slowly; showing the last received values.",
  waits: "The session is still working on the last edit; showing the last received values.",
  stuck:
    "The process of this session does not answer: it is in a long step, or hangs. Pause waits for it for 1.5 s, then " +
    "restarts it at its last checkpoint; edits are kept. Showing the last received values.",
  gone: "The service does not answer; showing the last received values.",
};

const LOST = {
  lost:
    "Connection to the service lost; retrying. If it has ended, start it with hookean studio: this page then " +
    "continues. Showing the last received values.",
  gone: "This session was deleted; showing the last received values.",
  broken: "Reload the page.",
};

const NONE =
  "Unknown session: it was deleted, or the link belongs to another service. Choose another one under All sessions.";

function Lost({ studio: { session, pulse } }: { studio: Studio }) {
  const connection = session.connection.value;
  const none = connection === "gone" && !session.summary.value;
  const known = none ? NONE : connection in LOST ? LOST[connection as keyof typeof LOST] : "";
  const beat = pulse.beat.value ?? "slow";
  const silent = beat === "slow" && !session.summary.value?.playing ? "waits" : beat;
  const sentence = connection !== "silent" ? known : SILENT[silent];
  return (
    <>
      <p role="alert" class={session.said.value ? "fault" : "unseen"}>
        {plain(session.said.value)}
      </p>
      <p role="status" class={sentence ? "lost" : "unseen"}>
        {sentence}
      </p>
    </>
  );
}

function Standing({ studio: { session } }: { studio: Studio }) {
  const summary = session.summary.value;
  if (!summary) return session.connection.value === "connecting" ? <p>Waiting for the session ...</p> : null;
  const stale = session.connection.value !== "live";
  const state = summary.playing ? (stale ? "Was playing" : "Playing") : titled(stateOf(summary));
  // while it plays the service's sentence is of its start: frames are newer
  const sentence = summary.playing ? "" : sentenceOf(summary.message, state);
  return (
    <div class={stale ? "standing stale" : "standing"}>
      <p aria-live="polite">
        <strong class={`state ${summary.playing ? "playing" : summary.status}`}>{state}</strong>{" "}
        <span class="sentence">{plain(sentence)}</span>
      </p>
      {summary.playing && <Now studio={{ session }} />}
    </div>
  );
}

/** The service's sentence without the state it begins with. */
const sentenceOf = (message: string, state: string) =>
  message.replace(/^Running: (.)/, (_, first: string) => first.toUpperCase()).replace(new RegExp(`^${state} `), "");

function Now({ studio: { session } }: { studio: Pick<Studio, "session"> }) {
  void session.ticks.value;
  const { frame } = session;
  if (!frame) return null;
  const time = session.topology.value?.units.time ?? "";
  return (
    <p class="numbers">
      {measured(frame.time, time)} · iteration {frame.iteration} · residual {said(frame.residual, 3)}
    </p>
  );
}

function Warnings({ studio }: { studio: Studio }) {
  const { session, options, view } = studio;
  const scene = session.scene.value;
  // below, the repairs report it with what to do
  const isKnown = scene !== null && isLoose(session.anchors.value, scene);
  const warnings = (session.summary.value?.warnings ?? []).filter((said) => !isKnown || said !== "nothing is held");
  if (!warnings.length) return null;
  const springs = session.topology.value?.springs ?? [];
  return (
    <ul class="warnings" aria-label="Warnings">
      {warnings.map((sentence) => {
        const particles = particlesOf(sentence, springs);
        const choose = () => {
          options.marked.value = particles;
          view.value?.show(particles);
        };
        return (
          <li key={sentence}>
            {particles.length > 0 ? (
              <button type="button" onClick={choose}>
                {plain(sentence)}
              </button>
            ) : (
              plain(sentence)
            )}
          </li>
        );
      })}
    </ul>
  );
}
