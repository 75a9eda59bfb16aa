// How a session is looked at, in an address: of a read-only link, or of a saved model that the command has opened.
import type { Kept } from "../view/types";
import { keepView } from "../view/kept";
import { isPacked, unpacked } from "../view/packed";
import { guest } from "../guest";
import { isKept, keepDesign } from "./designing";
import { keepRecipe, keptRecipe } from "./kept";

/** Keep for the page of a session what its file has. */
export function keepSeen(key: string, view: Kept | null): void {
  keepView(key, view);
  keepDesign(key, view?.design);
  if (view?.recipe) keepRecipe(key, view.recipe);
}

/** The same from an address, plain or packed; one that was cut shows the session as without it. */
export async function keepLooked(key: string, told: string): Promise<void> {
  try {
    const view = JSON.parse(isPacked(told) ? await unpacked(told) : told) as Kept | null;
    if (!view || typeof view !== "object") return;
    keepView(key, view);
    // an address replaces nothing that this browser keeps
    if (!guest && !isKept(key)) keepDesign(key, view.design);
    if (!guest && view.recipe && !keptRecipe(key)) keepRecipe(key, view.recipe);
  } catch {
    // the rest of the address still names the session
  }
}
