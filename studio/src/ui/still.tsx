// Over the canvas while another shape than the present one is shown: what it is, and the way back.
import type { Studio } from "./studio";

/** The frame that the canvas shows; null for none. */
export const shownFrame = ({ session, options }: Studio) => options.still.value?.frame ?? session.frame;

export function StillBar({ studio: { options, film } }: { studio: Studio }) {
  const still = options.still.value;
  if (!still) return null;
  return (
    <div class="still" role="group" aria-label="Shown shape">
      <span>{still.said}</span>
      <button type="button" class="small" title="Show the present shape" onClick={() => film.leave()}>
        Back to now
      </button>
    </div>
  );
}
