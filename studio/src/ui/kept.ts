// Groups of particles: in this browser by session, and in the file of a model.
import type { Groups, Kept } from "../view/types";
import { isAny, type Kept as Problem } from "./designing";
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

/** The view as a file keeps it, with the design problem, and sentences on what does not fit into it. */
export function fitting(view: Kept, design: Problem): { view: Kept; notes: string[] } {
  const { groups, ...rest } = view;
  const fits = (more: Partial<Kept>) => JSON.stringify({ ...kept, ...more }).length <= LONGEST;
  const notes: string[] = [];
  let kept: Kept = rest;
  if (isAny(design)) {
    if (fits({ design })) kept = { ...kept, design };
    else notes.push("The design problem is too large for the file; this browser keeps it.");
  }
  if (groups && fits({ groups })) kept = { ...kept, groups };
  else if (groups)
    notes.push(`The groups ${Object.keys(groups).join(", ")} are too large for the file; this browser keeps them.`);
  return { view: kept, notes };
}
