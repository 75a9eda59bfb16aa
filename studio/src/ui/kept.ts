// Groups of particles: in this browser by session, and in the file of a model.
import type { Groups, Kept } from "../view/types";
import { isAny, type Kept as Problem } from "./designing";
import { remember, remembered } from "./theme";

const name = (key: string) => `hookean-groups-${key}`;
/** Characters of a view that the service takes. */
const LONGEST = 12_000;

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

/** The view as a file keeps it, with the design problem, and sentences on what does not fit into it. */
export function fitting(view: Kept, design: Problem): { view: Kept; notes: string[] } {
  const { groups, recipe, ...rest } = view;
  const notes: string[] = [];
  let kept: Kept = rest;
  const keep = (more: Partial<Kept>, note: string) => {
    const wider = { ...kept, ...more };
    if (JSON.stringify(wider).length <= LONGEST) kept = wider;
    else notes.push(note);
  };
  if (isAny(design)) keep({ design }, "The design problem is too large for the file; this browser keeps it.");
  const names = Object.keys(groups ?? {}).join(", ");
  if (groups) keep({ groups }, `The groups ${names} are too large for the file; this browser keeps them.`);
  if (recipe) keep({ recipe }, "The recipe is too long for the file; save it by itself.");
  return { view: kept, notes };
}
