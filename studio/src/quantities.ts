// What goals and constraints of a design can measure, as the service's schema has it: a new kind needs nothing here.

/** How a field of a quantity is given. */
export type Form =
  | "force"
  | "anchor"
  | "mesh"
  | "particles"
  | "choice"
  | "yes or no"
  | "number"
  | "numbers"
  | "rows"
  | "texts"
  | "text";

/** A field of a quantity, such as the force whose lengths are measured. */
export interface Asked {
  name: string;
  description: string;
  form: Form;
  required: boolean;
  default: unknown;
  choices: string[];
}

/** A kind of quantity: position, length, reaction ... */
export interface Quantity {
  kind: string;
  summary: string;
  /** In words: length, force. */
  unit: string;
  fields: Asked[];
}

interface Property {
  type?: string;
  description?: string;
  default?: unknown;
  enum?: string[];
  anyOf?: Property[];
  items?: Property;
}

interface Kind {
  title: string;
  description: string;
  properties: Record<string, Property>;
  required: string[];
  "x-unit"?: string;
}

/** The schema of a goal: one of these. */
export interface OneOf {
  oneOf: Kind[];
}

/** The kinds of the schema by name. Fields that all kinds have, such as the target, are not their own. */
export function quantitiesOf({ oneOf }: OneOf): Map<string, Quantity> {
  const shared = Object.keys(oneOf[0]!.properties).filter((name) => oneOf.every((kind) => name in kind.properties));
  return new Map(oneOf.map((kind) => [kind.title, quantity(kind, shared)]));
}

function quantity({ title, description, properties, required, "x-unit": unit = "" }: Kind, shared: string[]): Quantity {
  // particles may be named by points, which the page does not need: it knows their numbers
  const placed = "points" in properties;
  const own = Object.entries(properties).filter(
    ([name]) => !shared.includes(name) && !(placed && name === "points"),
  );
  return {
    kind: title,
    summary: description.split(/\n\n/)[0]!.replaceAll("\n", " ").replaceAll("`", ""),
    unit,
    fields: own.map(([name, property]) => ({
      name,
      description: property.description ?? "",
      form: formOf(name, property),
      required: required.includes(name) || (placed && name === "particles"),
      default: property.default ?? null,
      choices: property.enum ?? [],
    })),
  };
}

const OF_THE_SCENE: readonly string[] = ["force", "anchor", "mesh", "particles"];

function formOf(name: string, property: Property): Form {
  if (OF_THE_SCENE.includes(name)) return name as Form;
  if (property.enum) return "choice";
  const own = property.type ? property : (property.anyOf?.find(({ type }) => type !== "null") ?? property);
  if (own.type === "boolean") return "yes or no";
  if (own.type === "integer" || own.type === "number") return "number";
  if (own.type !== "array") return "text";
  const of = own.items?.type;
  return of === "array" ? "rows" : of === "string" ? "texts" : "numbers";
}
