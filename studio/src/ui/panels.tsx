// What is beside the canvas, or below it where the screen is narrow.
import type { ComponentChildren } from "preact";
import { Cases } from "./cases";
import { namesOf } from "./casing";
import { useRef } from "preact/hooks";
import { DrawPanel } from "../drawing/drawpanel";
import { Charts } from "./charts";
import { Compare } from "./compare";
import { Design } from "./design";
import { Forces } from "./forces";
import { Measure } from "./measure";
import { OutPanel } from "./out";
import { PickedPanel } from "./picked";
import { RecipeKept } from "./recipe";
import { SectionChoice } from "./section";
import { SeePanel } from "./see";
import { Selected } from "./selected";
import { Shape } from "./shape";
import type { Studio } from "./studio";
import { SurfacePanel } from "./surface";
import { Tables } from "./tables";
import { Timeline } from "./timeline";
import { TagsChoice } from "./tags";

export function Panels({ studio, title }: { studio: Studio; title: string }) {
  // who begins with an empty page, or with points alone, draws, also after the first corner
  const isBlank = useRef(false);
  isBlank.current ||= studio.session.topology.value?.forces.length === 0;
  const isOwn = !studio.session.readOnly;
  return (
    <aside class="panels" aria-label="Panels">
      <Panel name="Selection">
        <PickedPanel studio={studio} />
        <Selected studio={studio} />
        <Measure studio={studio} />
      </Panel>
      {isOwn && (
        <Panel name="Draw" isClosed={!isBlank.current} isOpen={isBlank.current}>
          <DrawPanel studio={studio} />
        </Panel>
      )}
      {isOwn && studio.session.scene.value?.family && (
        <Panel name="Shape">
          <Shape session={studio.session} />
        </Panel>
      )}
      {isOwn && (
        <Panel name="Forces">
          <Forces studio={studio} />
        </Panel>
      )}
      <Panel name="Display">
        <SeePanel studio={studio} />
        <TagsChoice studio={studio} />
        <SectionChoice studio={studio} />
      </Panel>
      {isOwn && namesOf(studio.session.scene.value).length > 0 && (
        <Panel name="Load cases">
          <Cases studio={studio} />
        </Panel>
      )}
      <Panel name="Surface" isClosed>
        <SurfacePanel studio={studio} />
      </Panel>
      <Panel name="Charts">
        <Charts studio={studio} />
      </Panel>
      <Panel name="Time" isClosed>
        <Timeline studio={studio} title={title} />
      </Panel>
      <Panel name="Tables" isClosed>
        <Tables studio={studio} />
      </Panel>
      {isOwn && (
        <Panel name="Design" isClosed>
          <Design studio={studio} />
        </Panel>
      )}
      {isOwn && (
        <Panel name="Compare" isClosed>
          <Compare studio={studio} />
        </Panel>
      )}
      <Panel name="Save and export">
        <OutPanel studio={studio} title={title} />
        {isOwn && <RecipeKept studio={studio} />}
      </Panel>
    </aside>
  );
}

const INSIDE: Record<string, string> = {
  Selection: "Numbers of what is picked; several selected, held, moved, measured",
  Draw: "Particles, lines and faces drawn by clicks; springs and faces divided",
  Shape: "The measures that this model was made from",
  Forces: "The forces of the model with their values, and new ones; the solver",
  Display: "Colours, layers, labels and the section plane",
  "Load cases": "The form under each case and combination of loads",
  Surface: "Slope, curvature, stress of cloth, height lines and the ways of water",
  Charts: "Residual, energy and what is picked, over the last minute",
  Time: "Recordings, bookmarks and videos",
  Tables: "Springs, particles and reactions in numbers",
  Design: "Values found by a search for goals",
  Compare: "Variants of the model, and their differences",
  "Save and export": "The model as a file, picture or link",
};

interface Told {
  name: string;
  isClosed?: boolean;
  isOpen?: boolean;
  children: ComponentChildren;
}

function Panel({ name, isClosed = false, isOpen = false, children }: Told) {
  const narrow = window.matchMedia("(max-width: 820px)").matches;
  return (
    <details class="panel" open={isOpen || (!narrow && !isClosed) || ["Selection", "Shape", "Forces"].includes(name)}>
      <summary title={INSIDE[name]}>
        <h2>{name}</h2>
      </summary>
      <div class="inside">{children}</div>
    </details>
  );
}
