// What keys do on the page of a session, and the list of them.
import { useEffect, useRef } from "preact/hooks";
import { holder, inTurn, pin, release } from "../hand";
import { deleted } from "../drawing/change";
import { LOOKS } from "./see";
import type { Studio } from "./studio";

const LIST: [string, string][] = [
  ["Space", "Play or pause"],
  [".", "One step"],
  ["Ctrl Z", "Undo"],
  ["Ctrl Shift Z", "Redo"],
  ["Shift", "On a slider: a wider range"],
  ["f", "Zoom to fit"],
  ["1 2 3 4", "Perspective, top, front, right"],
  ["p", "Pin or release the picked particle"],
  ["Delete", "Delete what is picked or selected"],
  ["Esc", "Close the notice, else clear the selection"],
  ["?", "Show this list"],
];

/** Keys while the canvas has the focus: all that a pointer can do there. */
const ON_CANVAS: [string, string][] = [
  ["Arrows", "Rotate the view; with Shift pan"],
  ["+ -", "Zoom in, zoom out"],
  ["a", "Pick the next anchor; with Shift the previous one"],
  ["Alt Arrows", "Move the picked anchor parallel to the screen"],
  ["Alt PageUp PageDown", "Move it in depth"],
  ["x y z", "Drag along this axis; with Shift in the plane normal to it"],
];

/** Keys that a read-only page does not have. */
const EDITS = new Set([" ", ".", "p", "z", "delete"]);

export function Keys({ studio }: { studio: Studio }) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => {
    const pressed = (event: KeyboardEvent) => {
      if (event.defaultPrevented || dialog.current?.open || isTaken(event)) return;
      if (event.key === "?") dialog.current?.showModal();
      else if (!obeyed(studio, event)) return;
      event.preventDefault();
    };
    window.addEventListener("keydown", pressed);
    return () => window.removeEventListener("keydown", pressed);
  }, [studio]);
  return (
    <>
      <button
        type="button"
        class="help"
        title="The keys that replace the mouse (?)"
        aria-keyshortcuts="?"
        onClick={() => dialog.current?.showModal()}
      >
        Keys
      </button>
      <dialog ref={dialog} aria-labelledby="keys-title">
        <h2 id="keys-title">Keys</h2>
        <List keys={LIST} />
        <h3>On the canvas</h3>
        <List keys={ON_CANVAS} />
        <form method="dialog">
          <button type="submit" class="first">
            Close
          </button>
        </form>
      </dialog>
    </>
  );
}

function List({ keys }: { keys: [string, string][] }) {
  return (
    <dl>
      {keys.map(([key, does]) => (
        <div key={key}>
          <dt>
            {key.split(" ").map((part) => (
              <kbd key={part}>{part}</kbd>
            ))}
          </dt>
          <dd>{does}</dd>
        </div>
      ))}
    </dl>
  );
}

/** Whether the focused element uses the key itself. */
function isTaken(event: KeyboardEvent): boolean {
  const focus = event.target as HTMLElement;
  if (focus.matches("textarea, select, [contenteditable], input:not([type=range], [type=checkbox], [type=radio])"))
    return true;
  return event.key === " " && focus.matches("button, a, summary, input:not([type=range])");
}

/** Do the action of a key; whether it has one. */
function obeyed(studio: Studio, event: KeyboardEvent): boolean {
  const { session, view } = studio;
  if (event.altKey || (session.readOnly && EDITS.has(event.key.toLowerCase()))) return false;
  if (event.ctrlKey || event.metaKey) {
    if (event.key.toLowerCase() !== "z") return false;
    void session.tell(event.shiftKey ? "redo" : "undo");
    return true;
  }
  const look = LOOKS[Number(event.key) - 1];
  if (look) view.value?.look(look[0]);
  else if (event.key === " ") void session.tell(session.summary.value?.playing ? "pause" : "play");
  else if (event.key === ".") void session.tell("step");
  else if (event.key === "f") view.value?.fit();
  else if (event.key === "p") hold(studio);
  else if (event.key === "Delete") return deleted(studio);
  else if (event.key === "Escape") studio.options.picked.value = null;
  else return false;
  return true;
}

function hold({ session, options }: Studio): void {
  const picked = options.picked.value;
  if (picked?.kind !== "particle") return;
  const { index } = picked;
  inTurn(async () => (holder(await session.anchorsOfNow(), index) ? release : pin)(session, index));
}
