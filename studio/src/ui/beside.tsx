// Beside the canvas: a variant on another one, with linked cameras, and the names of both.
import { useEffect, useRef, useState } from "preact/hooks";
import { drawBeside } from "../view/beside";
import { ownOf, type Variant } from "../variants";
import type { View } from "../view/types";
import type { Studio } from "./studio";
import { calledOf } from "./words";

export function BesideCanvas({ studio }: { studio: Studio }) {
  const variant = studio.beside.value;
  const view = studio.view.value;
  const summary = studio.session.summary.value;
  if (!variant || !view || !summary) return null;
  const other = ownOf(calledOf(variant.summary));
  return (
    <>
      <p class="paired-name">{ownOf(calledOf(summary))}</p>
      <Other key={variant.summary.key} studio={studio} variant={variant} view={view} name={other} />
      <p class="paired-name other">{other}</p>
    </>
  );
}

function Other({ studio, variant, view, name }: { studio: Studio; variant: Variant; view: View; name: string }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [fault, setFault] = useState("");
  useEffect(() => {
    if (!canvas.current) return;
    try {
      const end = drawBeside(canvas.current, variant, view, studio.options);
      const turn = requestAnimationFrame(() => view.fit()); // into half of the room
      return () => {
        cancelAnimationFrame(turn);
        end();
      };
    } catch (error) {
      setFault(`This browser cannot draw the variant: ${error instanceof Error ? error.message : String(error)}`);
      return;
    }
  }, [studio, variant, view]);
  return (
    <>
      <canvas ref={canvas} class="other" role="img" aria-label={`The variant ${name}, seen from the same place`} />
      {fault && (
        <p class="fault over" role="alert">
          {fault}
        </p>
      )}
    </>
  );
}
