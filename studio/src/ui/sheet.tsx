// The import sheet: what each layer and object of a file is, before it is opened as a session.
import { useSignal } from "@preact/signals";
import { useEffect, useRef } from "preact/hooks";
import * as api from "../api";
import type { Draft } from "../model";
import { Choice } from "./choice";
import { FORCES, LENGTHS } from "./new";
import { keepRecipe } from "./kept";
import { tellOpen } from "./notices";
import { NumberField } from "./number";
import { go, met } from "./place";
import { compact, saveRecipe } from "./recipe";
import { SheetRow } from "./sheetrow";
import { busy, chooseUnits, chooseWeld, close, draft, edited } from "./sheetstate";
import { file, recipe, refused, undo, undoable } from "./sheetstate";
import { counted, plain } from "./words";

export function Sheet() {
  const dialog = useRef<HTMLDialogElement>(null);
  const shown = file.value;
  const found = draft.value;
  useEffect(() => {
    if (shown && !dialog.current?.open) dialog.current?.showModal();
    if (!shown) dialog.current?.close();
  }, [shown]);
  return (
    <dialog ref={dialog} class="sheet" aria-labelledby="sheet-title" onClose={close} onKeyDown={pressed}>
      {shown && found && (
        <div class="filled">
          <h2 id="sheet-title">Import {shown.name}</h2>
          <p class="note">Choose what the objects of each layer become. The file itself is not changed.</p>
          <Whole found={found} />
          <Table found={found} />
          <Outcome found={found} />
          <Recipe name={shown.name} />
          <Foot found={found} shown={shown} />
        </div>
      )}
    </dialog>
  );
}

/** Undo, cancel, and the button that makes the model. */
function Foot({ found, shown }: { found: Draft; shown: File }) {
  const making = useSignal(false);
  const make = async () => {
    making.value = true;
    try {
      const made = await api.open(shown, recipe.value);
      keepRecipe(made.key, { file: shown.name, text: compact(recipe.value) });
      close();
      go(made.key);
      tellOpen(shown.name, made.warnings);
    } catch (error) {
      met(error);
      refused.value = plain(error instanceof Error ? error.message : String(error));
    } finally {
      making.value = false;
    }
  };
  return (
    <>
      <p class="fault" role="alert">
        {refused.value}
      </p>
      <div class="buttons">
        <button type="button" disabled={!undoable.value} aria-keyshortcuts="Control+Z" onClick={undo}>
          Undo
        </button>
        <button type="button" aria-keyshortcuts="Escape" onClick={close}>
          Cancel
        </button>
        <button
          type="button"
          class="first"
          disabled={making.value || busy.value || (found.fault !== "" && edited.value === null)}
          onClick={() => void make()}
        >
          Make the model
        </button>
      </div>
    </>
  );
}

/** Keys do here what they do in a dialog, and nothing on the page behind it. */
function pressed(event: KeyboardEvent): void {
  event.stopPropagation();
  const isText = (event.target as HTMLElement).matches("textarea");
  if (!(event.ctrlKey || event.metaKey) || event.shiftKey || event.key.toLowerCase() !== "z" || isText) return;
  event.preventDefault();
  undo();
}

/** What holds for all of the file. */
function Whole({ found }: { found: Draft }) {
  const { units } = found;
  return (
    <div class="values whole">
      <Choice
        name="Unit of length"
        value={units.length}
        choices={LENGTHS.includes(units.length) ? LENGTHS : [...LENGTHS, units.length]}
        done={(length) => void chooseUnits({ ...units, length })}
      />
      <Choice
        name="Unit of force"
        value={units.force}
        choices={FORCES.includes(units.force) ? FORCES : [...FORCES, units.force]}
        done={(force) => void chooseUnits({ ...units, force })}
      />
      <NumberField
        name="Weld tolerance"
        seen="Weld tolerance"
        unit={units.length}
        hint="Points nearer than this become one particle"
        value={found.weld_tolerance}
        bounds={{ minimum: 0 }}
        done={(weld) => void chooseWeld(weld)}
      />
      <span class="note">
        {sentence(found.said)}
        {found.size && `; the model measures ${found.size}`}
      </span>
    </div>
  );
}

function Table({ found }: { found: Draft }) {
  return (
    <div class="scrolled" role="region" aria-label="Layers" tabIndex={0}>
      <table>
        <thead>
          <tr>
            {["Layer", "Objects", "Role", "Values", "Becomes"].map((head) => (
              <th key={head} scope="col">
                {head}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {found.rows.map((row) => (
            <SheetRow key={`${row.family} ${row.layer}`} draft={found} row={row} />
          ))}
        </tbody>
      </table>
    </div>
  );
}

/** What the roles become, or why they become no model. */
function Outcome({ found }: { found: Draft }) {
  const { fault, notes } = found;
  return (
    <div role="status" aria-label="Outcome">
      {busy.value ? (
        <p>Counting what these roles become ...</p>
      ) : fault ? (
        <p class="fault">{sentence(fault)}</p>
      ) : (
        <p>
          The model has {counted(found.particles, "particle")}, {found.held.toLocaleString("en")} of them held.
        </p>
      )}
      {notes.length > 0 && (
        <details>
          <summary>{counted(notes.length, "note")}</summary>
          <ul>
            {notes.map((note) => (
              <li key={note}>{sentence(note)}</li>
            ))}
          </ul>
        </details>
      )}
    </div>
  );
}

const sentence = (text: string) => plain(text).replace(/^[a-z]/, (first) => first.toUpperCase());

/** The recipe of the roles: it may be changed by hand, and saved for the command line. */
function Recipe({ name }: { name: string }) {
  const save = () => saveRecipe(name, recipe.value);
  return (
    <details>
      <summary>Recipe</summary>
      <p class="note">
        What hookean relax accepts with the option --recipe. What is changed here counts until a role is chosen again.
      </p>
      <textarea
        aria-label="Recipe"
        rows={10}
        spellcheck={false}
        value={recipe.value}
        onInput={(event) => (edited.value = event.currentTarget.value)}
      />
      <button type="button" onClick={save}>
        Save the recipe
      </button>
    </details>
  );
}
