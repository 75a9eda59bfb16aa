// Groups of particles: in this browser by session, and in the file of a model.
import type { Groups, Kept } from "../view/types";
import { packed } from "../view/packed";
import { stepped } from "./checked";
import { remember, remembered } from "./theme";

const name = (key: string) => `hookean-groups-${key}`;
/** Characters of a packed view: addresses of this length work everywhere. */
const LONGEST = 40_000;

export const keptGroups = (key: string) => remembered<Groups>(name(key), {});

/** Have this browser keep the groups of a session, or forget that there were some. */
export function keepGroups(key: string, groups: Groups): void {
  if (Object.keys(groups).length) remember(name(key), groups);
  else localStorage.removeItem(name(key));
}

const coloured = (key: string) => `hookean-group-colours-${key}`;

export const keptColours = (key: string) => remembered<Record<string, string>>(coloured(key), {});

export function keepColours(key: string, colours: Record<string, string>): void {
  if (Object.keys(colours).length) remember(coloured(key), colours);
  else localStorage.removeItem(coloured(key));
}

/** How the file that a session was made from was read. */
export interface Recipe {
  /** What that file is called. */
  file: string;
  text: string;
}

const recipes = (key: string) => `hookean-recipe-${key}`;

/** The recipe of a session as this browser keeps it; null for none. */
export const keptRecipe = (key: string) => remembered<Recipe | null>(recipes(key), null);

export const keepRecipe = (key: string, recipe: Recipe) => remember(recipes(key), recipe);

interface Fitted {
  /** Packed. */
  view: string;
  notes: string[];
}

/** A view as an address has it, packed, and sentences on what is too long for that. */
export async function fitting(view: Kept): Promise<Fitted> {
  const { groups, marked, recipe: _, design: __, ...rest } = view;
  const notes: string[] = [];
  let kept: Kept = rest;
  let made = await packed(JSON.stringify(kept));
  const keep = async (more: Partial<Kept>, note: string) => {
    const wider = { ...kept, ...more };
    const longer = await packed(JSON.stringify(stepped(wider)));
    if (longer.length <= LONGEST) [kept, made] = [wider, longer];
    else notes.push(note);
  };
  const names = Object.keys(groups ?? {}).join(", ");
  if (names) await keep({ groups }, `The groups ${names} are too large for the link; this browser keeps them.`);
  if (marked) await keep({ marked }, "The selection is too large for the link; keep it as a group and save the model.");
  return { view: made, notes };
}
