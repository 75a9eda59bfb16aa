// The recipe by which a session's file was read: shown, edited, saved for the command line, used again.
import { useSignal } from "@preact/signals";
import { useRef } from "preact/hooks";
import * as api from "../api";
import { keepRecipe, keptRecipe } from "./kept";
import { refuse, tellOpen } from "./notices";
import { go, met } from "./place";
import type { Studio } from "./studio";

/** A recipe without white space, where it is JSON. */
export function compact(text: string): string {
  try {
    return JSON.stringify(JSON.parse(text));
  } catch {
    return text; // TOML, or what somebody is still writing
  }
}

const spread = (text: string) => {
  try {
    return JSON.stringify(JSON.parse(text), null, 2);
  } catch {
    return text;
  }
};

/** Download a recipe under the name of its file. */
export function saveRecipe(file: string, text: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], { type: "application/json" }));
  link.download = file.replace(/\.\w+$/, "-recipe.json");
  link.click();
  URL.revokeObjectURL(link.href);
}

export function RecipeKept({ studio: { session } }: { studio: Studio }) {
  const kept = keptRecipe(session.key);
  const text = useSignal(kept ? spread(kept.text) : "");
  const busy = useSignal(false);
  const input = useRef<HTMLInputElement>(null);
  if (!kept) return null;
  const again = async (file: File) => {
    busy.value = true;
    try {
      const made = await api.open(file, text.value);
      keepRecipe(made.key, { file: file.name, text: compact(text.value) });
      go(made.key);
      tellOpen(file.name, made.warnings);
    } catch (error) {
      met(error);
      refuse(error, `${file.name} was not opened. `);
    } finally {
      busy.value = false;
    }
  };
  return (
    <details class="seldom">
      <summary>Recipe of {kept.file}</summary>
      <p class="note">
        How the file was read. It is saved with the model, and hookean relax accepts it with the option --recipe.
      </p>
      <textarea
        aria-label="Recipe of the file"
        rows={8}
        spellcheck={false}
        value={text.value}
        onInput={(event) => (text.value = event.currentTarget.value)}
      />
      <div class="row">
        <button
          type="button"
          class="small"
          title="A file for the command line and for automated checks"
          onClick={() => saveRecipe(kept.file, text.value)}
        >
          Save this recipe
        </button>
        <button
          type="button"
          class="small"
          title="Reads a file by this recipe, as a new session: the same file, or one with the same layers"
          disabled={busy.value}
          onClick={() => input.current?.click()}
        >
          Import a file by it ...
        </button>
        <input
          ref={input}
          class="unseen"
          type="file"
          accept=".3dm,.obj,.json"
          aria-label="File to import by the recipe"
          tabIndex={-1}
          onChange={(event) => {
            const [file] = event.currentTarget.files ?? [];
            event.currentTarget.value = "";
            if (file) void again(file);
          }}
        />
      </div>
    </details>
  );
}
