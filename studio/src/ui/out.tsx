// The session as a file, as a picture, and as a link.
import { useSignal } from "@preact/signals";
import * as api from "../api";
import { glb, stl } from "../shapes";
import { form } from "../view/form";
import type { View } from "../view/types";
import { Copied } from "./copied";
import { barOf, picture, sizeOf, svg } from "./drawing";
import { refuse } from "./notices";
import { linkTo, met } from "./place";
import { isAny } from "./designing";
import { keptRecipe } from "./kept";
import { completed } from "./reelfile";
import { seenNow, Share } from "./share";
import type { Studio } from "./studio";
import { dark } from "./theme";
import { said } from "./words";

const FILES: { format: api.Format; seen: string; ending: string; hint: string }[] = [
  {
    format: "hookean",
    seen: "Save",
    ending: ".hookean",
    hint: "The whole model: scene, shape, view, recording, bookmarks; opens here, in hookean relax and in Python",
  },
  {
    format: "scene",
    seen: "Scene",
    ending: ".json",
    hint: "The model with all edits, at its start positions; opens here and in hookean relax",
  },
  {
    format: "npz",
    seen: "npz",
    ending: ".npz",
    hint: "The model at its present shape and velocities; opens here and in Python: Simulation.load",
  },
  {
    format: "3dm",
    seen: "Rhino .3dm",
    ending: ".3dm",
    hint: "The shape with its forces on layers, and the model; opens here",
  },
  {
    format: "compas",
    seen: "COMPAS JSON",
    ending: "-compas.json",
    hint: "A Mesh, or a Graph of the springs, with supports, loads and the model; opens here",
  },
  { format: "obj", seen: "OBJ", ending: ".obj", hint: "The shape only: meshes, lines and held points" },
  { format: "csv", seen: "CSV", ending: ".csv", hint: "A table of forces and reactions" },
];

/** What this page makes of what it draws. */
const SEEN: {
  seen: string;
  ending: string;
  hint: string;
  made: (studio: Studio, view: View, title: string) => Blob | Promise<Blob>;
}[] = [
  {
    seen: "PNG",
    ending: ".png",
    hint: "A picture of the present view with its title, legend and size; Top, Front and Right have a scale",
    made: ({ options, session }, view, title) => {
      const { load, reaction } = view.arrows.value;
      const { loads, reactions } = options.layers.value;
      const unit = session.topology.value?.units.force ?? "";
      const arrows = [
        loads && load > 0 && `Load up to ${said(load, 3)} ${unit}`,
        reactions && reaction > 0 && `Reaction up to ${said(reaction, 3)} ${unit}`,
      ].filter((sentence) => sentence !== false);
      const canvas = document.querySelector(".drawing > canvas") ?? document.documentElement;
      const length = session.topology.value?.units.length ?? "";
      const bar = barOf(view, canvas.clientHeight, length);
      const lines = [...arrows, sizeOf(view.particles(), length)];
      const legend = view.legend.value ?? view.faces.value;
      return picture(view, { title, legend, arrows: lines, bar }, dark.value, canvas.clientWidth);
    },
  },
  {
    seen: "SVG",
    ending: ".svg",
    hint: "The lines of the present view as a drawing; Top, Front and Right are drawn to scale",
    made: ({ session }, view, title) => {
      const held = new Set(session.anchors.value.flatMap(({ particles }) => particles));
      return svg(view, form(session.topology.value!), held, title);
    },
  },
  {
    seen: "STL",
    ending: ".stl",
    hint: "The faces as triangles, in the model's unit of length",
    made: ({ session }, view) => stl(form(session.topology.value!), view.particles()),
  },
  {
    seen: "GLB",
    ending: ".glb",
    hint: "Faces and lines as glTF, in metres, for web pages and viewers",
    made: ({ session }, view) => {
      const { value } = session.topology;
      return glb(form(value!), view.particles(), value!.units.length);
    },
  },
];

export function OutPanel({ studio, title }: { studio: Studio; title: string }) {
  const { session, view } = studio;
  const done = useSignal("");
  const link = useSignal("");
  const busy = useSignal("");
  const name =
    title
      .normalize("NFKD")
      .replace(/[^\w.-]+/g, "-")
      .replace(/^-+|-+$/g, "") || "session";
  const exported = async (format: api.Format) => {
    const made = await api.exported(session.key, format);
    if (format !== "hookean") return made;
    const [seen, recipe, design] = [seenNow(studio), keptRecipe(session.key), studio.design.problem.value];
    const view = seen && { ...seen, ...(recipe && { recipe }), ...(isAny(design) && { design }) };
    return { ...made, blob: await completed(made.blob, view, studio.film.reel()) };
  };
  const take = async (seen: string, file: string, made: () => Promise<{ blob: Blob; notes: string[] }>) => {
    busy.value = seen;
    done.value = "";
    try {
      const { blob, notes } = await made();
      keep(blob, file);
      done.value = [`${file} was downloaded.`, ...notes].join(" ");
    } catch (error) {
      met(error);
      refuse(error, `${file} could not be saved. `);
    } finally {
      busy.value = "";
    }
  };
  const copy = async () => {
    const address = `${location.origin}/${linkTo(session.key)}`;
    link.value = "";
    try {
      await navigator.clipboard.writeText(address);
      done.value = "The link was copied; it opens in a browser that is logged in.";
    } catch {
      link.value = address;
      done.value = "Copy the link below; it opens in a browser that is logged in.";
    }
  };
  const live = session.connection.value === "live";
  return (
    <>
      {!session.readOnly && <Rename studio={studio} title={title} />}
      <div class="row">
        {FILES.map(({ format, seen, ending, hint }) => (
          <button
            key={format}
            type="button"
            title={hint}
            disabled={!live || busy.value !== ""}
            aria-busy={busy.value === seen}
            onClick={() => void take(seen, name + ending, () => exported(format))}
          >
            {seen}
          </button>
        ))}
        {SEEN.map(({ seen, ending, hint, made }) => (
          <button
            key={seen}
            type="button"
            title={hint}
            disabled={!view.value || busy.value !== ""}
            aria-busy={busy.value === seen}
            onClick={() =>
              void take(seen, name + ending, async () => ({ blob: await made(studio, view.value!, title), notes: [] }))
            }
          >
            {seen}
          </button>
        ))}
        {!session.readOnly && (
          <button
            type="button"
            title="The address of this session, for a browser that is logged in"
            onClick={() => void copy()}
          >
            Copy link
          </button>
        )}
      </div>
      <Copied told={done.value} address={link.value} name="Link to this session" />
      {!session.readOnly && <Share studio={studio} />}
    </>
  );
}

/** The name of the session, in the list of sessions and of its files. */
function Rename({ studio: { session }, title }: { studio: Studio; title: string }) {
  const give = async (field: HTMLInputElement) => {
    const name = field.value.trim();
    try {
      if (name) await session.rename(name);
      else field.value = title;
    } catch (error) {
      field.value = title;
      met(error);
      refuse(error, "The session was not renamed. ");
    }
  };
  return (
    <label class="field name" title="In the list of sessions, and of files that are saved">
      <span>Name</span>
      <input
        type="text"
        aria-label="Name of the session"
        maxLength={200}
        value={title}
        disabled={session.connection.value !== "live"}
        onChange={(event) => void give(event.currentTarget)}
      />
    </label>
  );
}

/** Download a file. */
export function keep(blob: Blob, file: string): void {
  const address = URL.createObjectURL(blob);
  const anchor = document.createElement("a");
  anchor.href = address;
  anchor.download = file;
  anchor.click();
  // the download has begun with the click's task
  window.setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
