// A design problem, driven from the page: what may vary, goals with sliders, constraints, and the best values found.
import { useEffect } from "preact/hooks";
import { form } from "../view/form";
import { know, quantities } from "./catalogue";
import { Found } from "./designfound";
import { Constraints, Goals } from "./designgoals";
import { Variables } from "./designvariables";
import type { Studio } from "./studio";
import { said } from "./words";

export function Design({ studio }: { studio: Studio }) {
  const { session, design } = studio;
  const live = session.connection.value === "live";
  useEffect(() => {
    if (live) know().catch(() => undefined);
  }, [live]);
  useOverlay(studio);
  if (!session.scene.value || !session.topology.value || !quantities.value)
    return <p class="faint">Loading the scene ...</p>;
  const { variables } = design.problem.value;
  return (
    <>
      <p class="note">
        Solve finds the form of given values. A design problem finds the values of a form: choose what may vary, and
        what the form should be like.
      </p>
      <Variables studio={studio} />
      {variables.length > 0 && <Goals studio={studio} />}
      {variables.length > 0 && <Constraints studio={studio} />}
      <Search studio={studio} />
      <Found studio={studio} />
    </>
  );
}

/** The form of the best values over the present one, until they are used or the page is left. */
function useOverlay({ session, design, options }: Studio): void {
  const [answer, topology] = [design.answer.value, session.topology.value];
  useEffect(() => {
    if (!answer || !topology || answer.result.particles.length !== topology.particles) return;
    const { springs, edges, strokes } = form(topology);
    const shadow = {
      name: "Best values",
      positions: Float32Array.from(answer.result.particles.flat()),
      ends: Int32Array.from([...springs, ...edges, ...strokes]),
    };
    options.ghost.value = shadow;
    return () => {
      if (options.ghost.peek() === shadow) options.ghost.value = null;
    };
  }, [options, answer, topology]);
}

function Search({ studio: { session, design } }: { studio: Studio }) {
  const { stage, iterations, objective, fault } = design.search.value;
  const searching = stage === "searching";
  return (
    <>
      <div class="row">
        <button
          type="button"
          disabled={!design.isWhole || session.connection.value !== "live"}
          title="Search the values for which the equilibrium has these goals; moving a goal searches again"
          onClick={() => design.start()}
        >
          Search
        </button>
        {searching && (
          <button type="button" title="Stop the search and keep the best values so far" onClick={() => design.stop()}>
            Cancel the search
          </button>
        )}
      </div>
      {searching && (
        <div role="group" aria-label="Search">
          <progress aria-label="Progress of the search" />
          <p class="numbers note">
            {objective === null
              ? "Searching ..."
              : `Searching: ${iterations} equilibria, least objective ${said(objective, 3)}`}
          </p>
        </div>
      )}
      {fault && (
        <p class="fault" role="alert">
          {fault}
        </p>
      )}
    </>
  );
}
