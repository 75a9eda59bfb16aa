// A layer in the import sheet: its objects, its role with the values, and what it becomes.
import { useSignal } from "@preact/signals";
import type { Draft, Drawn, Row, Values } from "../model";
import { Choice } from "./choice";
import { seenOf } from "./families";
import { NumberField } from "./number";
import { chooseObject, chooseRow } from "./sheetstate";
import { plain, titled } from "./words";

const LABELS: Record<string, string> = { geometry: "Carried along", ignore: "Left out" };
const SUMMARIES: Record<string, string> = { floor: "A level floor at the top of the object", ignore: "Left out" };
const MOST = 200;

const labelled = (role: string) => LABELS[role] ?? titled(role);

export function SheetRow({ draft, row }: { draft: Draft; row: Row }) {
  const open = useSignal(false);
  const layer = row.layer.replaceAll("::", " / ") || "(no layer)";
  const called = row.family ? `${layer}, ${row.family}` : layer;
  const out = row.objects.filter((drawn) => drawn.why && drawn.role !== row.role);
  const reasons = [...new Set(out.map((drawn) => drawn.why!))];
  const becomes = row.becomes.join(", ");
  return (
    <>
      <tr>
        <th scope="row">
          <button
            type="button"
            class="plain disclose"
            aria-expanded={open.value}
            aria-label={`Objects of ${called}`}
            onClick={() => (open.value = !open.value)}
          >
            {open.value ? "▾" : "▸"}
          </button>
          {layer}
        </th>
        <td>{row.kinds}</td>
        <td>
          <RoleMenu
            name={`Role of ${called}`}
            {...{ draft, row }}
            role={row.role}
            done={(role) => void chooseRow(row, role)}
          />
        </td>
        <td>
          <Fields
            of={called}
            {...{ draft, row }}
            role={row.role}
            values={row.values}
            done={(values) => void chooseRow(row, row.role, values)}
          />
        </td>
        <td>
          {becomes}
          {reasons.map((why) => (
            <p key={why} class="left">
              {out.length < row.objects.length ? `${out.length} left out: ` : "Left out: "}
              {plain(why)}
            </p>
          ))}
        </td>
      </tr>
      {open.value && row.objects.slice(0, MOST).map((drawn) => <ObjectRow key={drawn.id} {...{ draft, row, drawn }} />)}
      {open.value && row.objects.length > MOST && (
        <tr class="single">
          <td colSpan={5}>{row.objects.length - MOST} more objects follow the layer, or the recipe below.</td>
        </tr>
      )}
    </>
  );
}

function ObjectRow({ draft, row, drawn }: { draft: Draft; row: Row; drawn: Drawn }) {
  const number = row.objects.indexOf(drawn) + 1;
  const called = drawn.name || `${drawn.kind} ${number}`;
  return (
    <tr class="single">
      <th scope="row">{called}</th>
      <td>{drawn.kind}</td>
      <td>
        <RoleMenu
          name={`Role of ${called}`}
          {...{ draft, row }}
          role={drawn.role ?? ""}
          own
          done={(role) => void chooseObject(drawn, role)}
        />
      </td>
      <td>
        {drawn.role && (
          <Fields
            of={called}
            {...{ draft, row }}
            role={drawn.role}
            values={drawn.values}
            done={(values) => void chooseObject(drawn, drawn.role!, values)}
          />
        )}
      </td>
      <td>{drawn.why && <span class="left">{plain(drawn.why)}</span>}</td>
    </tr>
  );
}

interface Told {
  draft: Draft;
  row: Row;
  role: string;
}

const roleOf = ({ draft, row, role }: Told) =>
  draft.roles.find((one) => one.family === row.family && one.role === role);

/** The roles that objects may have; `own`: of one object, which may have that of its layer. */
function RoleMenu({ name, own, done, ...told }: Told & { name: string; own?: boolean; done: (role: string) => void }) {
  return (
    <select
      aria-label={name}
      title={roleOf(told)?.summary ?? SUMMARIES[told.role]}
      value={told.role}
      onChange={(event) => done(event.currentTarget.value)}
    >
      {own && <option value="">As the layer</option>}
      {told.row.roles.map((role) => (
        <option key={role} value={role}>
          {labelled(role)}
        </option>
      ))}
    </select>
  );
}

function Fields({ of, values, done, ...told }: Told & { of: string; values: Values; done: (values: Values) => void }) {
  // meshes keep their faces
  const isMesh = /^[\d,]+ Mesh\w*$/.test(told.row.kinds);
  const fields = (roleOf(told)?.fields ?? []).filter(({ name }) => !isMesh || !name.startsWith("divide"));
  return (
    <div class="values">
      {fields.map((field) => {
        const { seen, ...more } = seenOf(field, told.draft.units);
        const value = values[field.name];
        const name = `${seen} of ${of}`;
        const set = (to: number | string | null) => to !== null && done({ ...values, [field.name]: to });
        if (typeof value === "string")
          return (
            <Choice
              key={field.name}
              name={name}
              seen={seen}
              value={value}
              choices={field.choices ?? ["", ...new Set(told.draft.rows.map(({ layer }) => layer).filter(Boolean))]}
              hint={more.hint}
              done={set}
            />
          );
        return (
          <NumberField
            key={field.name}
            name={name}
            seen={seen}
            {...more}
            value={value ?? null}
            bounds={field.bounds}
            done={set}
          />
        );
      })}
    </div>
  );
}
