// Files become sessions: dropped anywhere, or chosen.
import { signal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as api from "../api";
import { viewOf } from "../view/kept";
import { keepSeen } from "./looked";
import { quiet, refuse, tellOpen } from "./notices";
import { go, met } from "./place";
import { keepReel } from "./reel";
import { reelOf } from "./reelfile";
import { drafted } from "./sheetstate";

const over = signal(false);
/** What is being opened; "" for nothing. */
export const opening = signal("");

const KINDS = ".3dm,.obj,.json,.npz,.hookean";

/** Open a file as a new session and go there; what is drawn in a file gets its roles in the import sheet first. */
async function openFile(file: File): Promise<void> {
  opening.value = file.name;
  quiet();
  try {
    if (/\.(3dm|obj|json)$/i.test(file.name) && (await drafted(file))) return;
    const { reel, model } = await reelOf(file);
    const made = await api.open(model);
    if (reel) await keepReel(made.key, reel);
    const note = keepSeen(made.key, await viewOf(file), made.particles);
    go(made.key);
    tellOpen(file.name, made.warnings, note ? [note] : []);
  } catch (error) {
    met(error);
    refuse(error, `${file.name} was not opened. `);
  } finally {
    opening.value = "";
  }
}

/** A button to choose a file, and the places to drop one. */
export function FileButton() {
  const input = useRef<HTMLInputElement>(null);
  return (
    <div class="drop">
      <p>
        Drop a file anywhere on this page: a saved model (.hookean), a Rhino model (.3dm), an OBJ mesh, a COMPAS
        document or a scene (.json), or a saved simulation (.npz).
      </p>
      <button
        type="button"
        disabled={opening.value !== ""}
        title="Choose a file of this computer; drawn files get a role for each layer first"
        onClick={() => input.current?.click()}
      >
        {opening.value ? `Opening ${opening.value} ...` : "Open a file ..."}
      </button>
      <input
        ref={input}
        class="unseen"
        type="file"
        accept={KINDS}
        aria-label="File to open"
        tabIndex={-1}
        onChange={(event) => {
          const [file] = event.currentTarget.files ?? [];
          event.currentTarget.value = "";
          if (file) void openFile(file);
        }}
      />
    </div>
  );
}

/** Takes what is dropped on the page, and shows that it may be. */
export function Dropping() {
  useEffect(() => {
    const end = new AbortController();
    const listen = { signal: end.signal };
    window.addEventListener("dragover", dragged, listen);
    window.addEventListener("dragleave", (event) => event.relatedTarget === null && (over.value = false), listen);
    window.addEventListener("drop", dropped, listen);
    return () => end.abort();
  }, []);
  return (
    over.value && (
      <div class="dropping" aria-hidden="true">
        <p>Drop the file to open it as a session</p>
      </div>
    )
  );
}

/** Which file is being opened. */
export function Opening() {
  return (
    <p class={opening.value ? "notice" : "unseen"} role="status">
      {opening.value && `Opening ${opening.value} ...`}
    </p>
  );
}

const holdsFiles = (event: DragEvent) => event.dataTransfer?.types.includes("Files") === true;

function dragged(event: DragEvent): void {
  if (!holdsFiles(event)) return;
  event.preventDefault();
  over.value = true;
}

function dropped(event: DragEvent): void {
  if (!holdsFiles(event)) return;
  event.preventDefault();
  over.value = false;
  const files = [...(event.dataTransfer?.files ?? [])];
  if (opening.value) refuse(new Error(`${opening.value} is being opened; drop the next file when it is open.`));
  else if (files.length > 1) refuse(new Error(`${files.length} files were dropped; drop one at a time.`));
  else if (files[0]) void openFile(files[0]);
}
