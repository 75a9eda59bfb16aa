// How the session stands in a sentence, what the report warns of, and what was lost on the way.
import { useEffect } from "preact/hooks";
import { tellReturns } from "./returns";
import type { Studio } from "./studio";
import { stateOf } from "./running";
import { measured, particlesOf, said, titled } from "./words";

export function Report({ studio }: { studio: Studio }) {
  useEffect(() => tellReturns(studio.session), [studio]);
  return (
    <section class="report" aria-label="Status">
      <Lost studio={studio} />
      <Standing studio={studio} />
      <Warnings studio={studio} />
    </section>
  );
}

const TOLD = {
  silent: "It plays, but nothing has come for two seconds: the numbers are the last that were heard.",
  lost: "The connection to the service is lost and tried again; the form and its numbers are the last that were heard.",
  gone: "The service has forgotten this session: it is shown as it was last heard.",
  broken: "Load the page anew.",
};

const NONE = "The service has no such session: it was forgotten, or the link is one to another service.";

function Lost({ studio: { session } }: { studio: Studio }) {
  const connection = session.connection.value;
  const none = connection === "gone" && !session.summary.value;
  const told = none ? NONE : connection in TOLD ? TOLD[connection as keyof typeof TOLD] : "";
  return (
    <>
      <p role="alert" class={session.said.value ? "fault" : "unseen"}>
        {session.said.value}
      </p>
      <p role="status" class={told ? "lost" : "unseen"}>
        {told}
      </p>
    </>
  );
}

function Standing({ studio: { session } }: { studio: Studio }) {
  const summary = session.summary.value;
  if (!summary) return session.connection.value === "connecting" ? <p>Waiting for the session ...</p> : null;
  const stale = session.connection.value !== "live";
  const state = summary.playing ? (stale ? "Was playing" : "Playing") : titled(stateOf(summary));
  // while it plays the service's sentence is of its start: frames tell more
  const sentence = summary.playing ? "" : sentenceOf(summary.message, state);
  return (
    <div class={stale ? "standing stale" : "standing"}>
      <p aria-live="polite">
        <strong class={`state ${summary.playing ? "playing" : summary.status}`}>{state}</strong>{" "}
        <span class="sentence">{sentence}</span>
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
  const warnings = session.summary.value?.warnings ?? [];
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
                {sentence}
              </button>
            ) : (
              sentence
            )}
          </li>
        );
      })}
    </ul>
  );
}
