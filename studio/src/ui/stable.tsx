// Below the status: the stability of a shape at rest, and how accurate its positions are.
import type { Studio } from "./studio";
import { measured } from "./words";

export function Stable({ studio: { session, rested, options, view } }: { studio: Studio }) {
  const summary = session.summary.value;
  if (!summary || summary.playing || summary.status !== "converged") return null;
  const { result } = rested;
  if (!result)
    return rested.isReading ? (
      <p class="faint">Checking the stability ...</p>
    ) : (
      <p>
        <button
          type="button"
          class="small"
          title="Whether the shape is stable, and how accurate its positions are; takes seconds for a large model"
          onClick={() => rested.ask()}
        >
          Check the stability
        </button>
      </p>
    );
  const { stability, stability_reason: reason, soft_particle: soft, position_error: error } = result;
  const why = [...new Set([reason, error === null ? result.position_reason : ""])].filter(Boolean).map(sentence);
  const unit = session.topology.value?.units.length ?? "";
  const mark = () => {
    options.marked.value = [soft!];
    view.value?.show([soft!]);
  };
  return (
    <p class="stability">
      <strong>Stability: {stability.replaceAll("_", " ")}.</strong>{" "}
      {error !== null && `Positions are within ${measured(Number(error.toPrecision(2)), unit)} of the equilibrium. `}
      {why.join(" ")}{" "}
      {soft !== null && (
        <button type="button" class="small" title="Mark the particle that moves most" onClick={mark}>
          Show particle {soft}
        </button>
      )}
    </p>
  );
}

/** A reason of the service as a sentence of its own. */
const sentence = (reason: string) => reason.charAt(0).toUpperCase() + reason.slice(1).replace(/\.?$/, ".");
