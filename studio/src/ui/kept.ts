// Groups of particles: in this browser by session, and in the file of a model.
import type { Groups, Kept } from "../view/types";
import { isAny, type Kept as Problem } from "./designing";
import { packed } from "../view/packed";
import { remember, remembered } from "./theme";

const name = (key: string) => `hookean-groups-${key}`;
/** Characters of a packed view: the service accepts heads of 16 kB, and addresses of this length work everywhere. */
const LONGEST = { file: 14_000, link: 40_000 };

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

/** The view as a file or an address keeps it, packed, with the design problem, and sentences on what is too long. */
export async function fitting(view: Kept, design: Problem, place: keyof typeof LONGEST): Promise<Fitted> {
  const { groups, recipe, ...rest } = view;
  const notes: string[] = [];
  let kept: Kept = rest;
  let made = await packed(JSON.stringify(kept));
  const keep = async (more: Partial<Kept>, note: string) => {
    const wider = { ...kept, ...more };
    const longer = await packed(JSON.stringify(wider));
    if (longer.length <= LONGEST[place]) [kept, made] = [wider, longer];
    else notes.push(note);
  };
  if (isAny(design)) await keep({ design }, `The design problem is too large for the ${place}; this browser keeps it.`);
  const names = Object.keys(groups ?? {}).join(", ");
  if (groups) await keep({ groups }, `The groups ${names} are too large for the ${place}; this browser keeps them.`);
  if (recipe) await keep({ recipe }, `The recipe is too long for the ${place}; save it by itself.`);
  return { view: made, notes };
}
