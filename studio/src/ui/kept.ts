// Groups of particles: in this browser by session, and in the file of a model.
import type { Groups, Kept } from "../view/types";
import { remember, remembered } from "./theme";

const name = (key: string) => `hookean-groups-${key}`;
/** Characters of a view that the service takes. */
const LONGEST = 3600;

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

/** The view as a file keeps it, and a sentence on groups that do not fit into it. */
export function fitting(view: Kept): { view: Kept; notes: string[] } {
  if (JSON.stringify(view).length <= LONGEST) return { view, notes: [] };
  const { groups, ...rest } = view;
  const lost = Object.keys(groups ?? {}).join(", ");
  return { view: rest, notes: [`The groups ${lost} are too large for the file; this browser keeps them.`] };
}
