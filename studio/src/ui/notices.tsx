// What was refused or done, in sentences, in a place of their own: they cover nothing. What was refused stays until it
// is closed, by its button or Esc, or the next one comes.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";
import { Refused } from "../api";
import { counted, plain } from "./words";

interface Notice {
  kind: "refused" | "done";
  sentence: string;
  details: string[];
}

const SEEN = 8000;

const notice = signal<Notice | null>(null);

/** Show an error, with the places the service named. */
export function refuse(error: unknown, before = ""): void {
  const sentence = error instanceof Error ? error.message : String(error);
  const errors = error instanceof Refused ? error.errors : [];
  const details = errors.map((e) => `${e.pointer}: ${e.detail}`).filter((detail) => !sentence.includes(detail));
  const seen = plain(sentence);
  if (seen !== sentence) details.unshift(sentence);
  notice.value = { kind: "refused", sentence: before + seen, details };
}

/** Show what was done. */
export function tell(sentence: string, details: string[] = []): void {
  const done: Notice = { kind: "done", sentence, details };
  notice.value = done;
  if (!details.length) setTimeout(() => notice.value === done && quiet(), SEEN);
}

/** Show that a file is open, and sentences on it that are shown nowhere else; its other notes are below the form. */
export function tellOpen(name: string, warnings: string[] = [], only: string[] = []): void {
  const notes = warnings.filter((sentence) => sentence !== "nothing is held"); // that one comes with a repair
  if (only.length) tell(`${name} is open. Notes on what was opened:`, only);
  else if (notes.length) tell(`${name} is open, with ${counted(notes.length, "note")} below the form.`);
}

export const quiet = () => (notice.value = null);

export function Notices() {
  const now = notice.value;
  useEffect(() => {
    // before others that Esc has a meaning for: what is picked stays picked, an open dialog closes itself
    window.addEventListener("keydown", closing, { capture: true });
    return () => window.removeEventListener("keydown", closing, { capture: true });
  }, []);
  return (
    <>
      <div role="alert">{now?.kind === "refused" && <Said notice={now} />}</div>
      <div role="status">{now?.kind === "done" && <Said notice={now} />}</div>
    </>
  );
}

function closing(event: KeyboardEvent): void {
  if (event.key !== "Escape" || !notice.value || document.querySelector("dialog[open]")) return;
  quiet();
  event.preventDefault();
  event.stopPropagation();
}

function Said({ notice }: { notice: Notice }) {
  return (
    <div class={`notice ${notice.kind}`}>
      <div>
        <p>{notice.sentence}</p>
        {notice.details.length > 0 && (
          <details open={notice.kind === "done"}>
            <summary>Details</summary>
            <ul>
              {notice.details.map((detail) => (
                <li key={detail}>{notice.kind === "done" ? plain(detail) : detail}</li>
              ))}
            </ul>
          </details>
        )}
      </div>
      <button type="button" class="plain" aria-label="Close the notice" aria-keyshortcuts="Escape" onClick={quiet}>
        ×
      </button>
    </div>
  );
}
