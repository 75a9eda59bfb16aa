// How a session is looked at, in a file, or in an address: of a read-only link, or of a saved model that the command
// has opened.
import { keepView } from "../view/kept";
import { isPacked, unpacked } from "../view/packed";
import { guest } from "../guest";
import { checked } from "./checked";
import { isKept, keepDesign } from "./designing";
import { keepRecipe, keptRecipe } from "./kept";
import { tellOpen } from "./notices";

/** Keep for the page of a session what its file has; a sentence on what is invalid of it, "" for nothing. */
export function keepSeen(key: string, told: unknown, particles: number): string {
  if (!told) return "";
  const { view, note } = checked(told, "file", particles);
  keepView(key, view);
  keepDesign(key, view.design);
  if (view.recipe) keepRecipe(key, view.recipe);
  return note;
}

/** The same from an address, plain or packed; one that was cut shows the session as without it, with a sentence. */
export async function keepLooked(key: string, told: string): Promise<void> {
  try {
    const { view, note } = checked(JSON.parse(isPacked(told) ? await unpacked(told) : told), "address");
    keepView(key, view);
    // an address replaces nothing that this browser keeps
    if (!guest && !isKept(key)) keepDesign(key, view.design);
    if (!guest && view.recipe && !keptRecipe(key)) keepRecipe(key, view.recipe);
    if (note) tellOpen("The session", [], [note]);
  } catch {
    // the rest of the address still names the session
    const note = "The view in the address is incomplete and was left out. Copy the whole link to see it.";
    tellOpen("The session", [], [note]);
  }
}
