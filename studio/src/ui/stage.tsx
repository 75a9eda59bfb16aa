// The canvas, and the messages over it.
import { useEffect, useRef, useState } from "preact/hooks";
import { expose } from "../automation";
import { PenView } from "../drawing/penview";
import { createView } from "../view/view";
import { BesideCanvas } from "./beside";
import { dark } from "./theme";
import { Labels } from "./measure";
import { Readout } from "./readout";
import { Report } from "./report";
import { LegendBox, Looks } from "./see";
import { Selecting } from "./selecting";
import { Solving } from "./solving";
import { StillBar } from "./still";
import type { Studio } from "./studio";
import { TagLabels } from "./tags";

export function Stage({ studio }: { studio: Studio }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const [fault, setFault] = useState("");
  useEffect(() => {
    if (!canvas.current) return;
    try {
      const view = createView(canvas.current, studio.session, studio.options);
      const hide = expose(studio.session, view);
      studio.view.value = view;
      return () => {
        hide();
        studio.view.value = null;
        view.dispose();
      };
    } catch (error) {
      setFault(`This browser cannot draw the form: ${error instanceof Error ? error.message : String(error)}`);
      return;
    }
  }, [studio]);
  const now = dark.value;
  useEffect(() => {
    studio.options.dark.value = now;
  }, [studio, now]);
  return (
    <>
      <div class={studio.beside.value ? "drawing paired" : "drawing"}>
        <canvas
          ref={canvas}
          tabIndex={0}
          role="application"
          aria-label="The form"
          aria-description="Arrows rotate the view, A picks the next anchor, ? lists keys. The panels show numbers."
        />
        <p class="unseen" aria-live="polite">
          {studio.view.value?.announcement.value}
        </p>
        {fault && (
          <p class="fault over" role="alert">
            {fault}
          </p>
        )}
        {studio.view.value?.away.value && (
          <button type="button" class="back-to-form" onClick={() => studio.view.value?.fit()}>
            The form is out of view: zoom to it
          </button>
        )}
        <BesideCanvas studio={studio} />
        <Labels studio={studio} />
        <TagLabels studio={studio} />
        <Selecting studio={studio} />
        <PenView studio={studio} />
        <Looks studio={studio} />
        <LegendBox studio={studio} />
        <Readout studio={studio} />
        <StillBar studio={studio} />
      </div>
      <Solving session={studio.session} />
      <Report studio={studio} />
    </>
  );
}
