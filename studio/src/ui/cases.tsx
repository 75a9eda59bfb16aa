// Load cases and combinations: solve them, show one, colour by what it does, and the largest of all.
import { type Casing, type Column, ENVELOPE, FORM, maxima, type Most, namesOf } from "./casing";
import { NumberField } from "./number";
import { keep } from "./out";
import type { Studio } from "./studio";
import { counted, said, titled, unit } from "./words";

const HINTS: Record<Column, string> = {
  force: "Tension is above 0, compression below",
  utilisation: "Part of the strength that each element uses; 100 % is the strength, without safety factors [%]",
  displacement: "How far the ends of each element move from the form",
};

export function Cases({ studio }: { studio: Studio }) {
  const { casing, session } = studio;
  const names = namesOf(session.scene.value);
  const solved = casing.solved.value;
  return (
    <>
      <p class="faint">
        {counted(names.length, "case")}: {names.join(", ")}. The form is found and frozen, then each case acts on it.
      </p>
      <div class="row">
        <button
          type="button"
          class={solved && casing.current.value ? "" : "first"}
          disabled={casing.busy.value || session.connection.value !== "live"}
          aria-busy={casing.busy.value}
          title="Find the form, freeze it, and solve every load case and combination; the model here stays as it is"
          onClick={() => void casing.solve()}
        >
          {casing.busy.value ? "Solving the cases ..." : "Solve the load cases"}
        </button>
        {casing.busy.value && (
          <button type="button" onClick={() => casing.cancel()}>
            Cancel
          </button>
        )}
      </div>
      {casing.fault.value && (
        <p class="fault" role="alert">
          {casing.fault.value}
        </p>
      )}
      {solved && !casing.current.value && (
        <p class="stale-note" role="status">
          The model has changed since; solve the load cases again.
        </p>
      )}
      {solved && <Shown casing={casing} names={names} />}
      {solved && <Told casing={casing} />}
      {solved && <Maxima studio={studio} />}
    </>
  );
}

function Shown({ casing, names }: { casing: Casing; names: string[] }) {
  const shown = casing.shown.value;
  const isCase = names.includes(shown);
  return (
    <>
      <label class="field" title="What the canvas shows: the present shape, the form, one case, or the largest of all">
        <span>Show</span>
        <select value={shown} aria-label="Show the case" onChange={(event) => show(casing, event.currentTarget.value)}>
          <option value="">present shape</option>
          <option value={FORM}>form</option>
          {names.map((name) => (
            <option key={name} value={name}>
              {name}
            </option>
          ))}
          <option value={ENVELOPE}>largest of all cases</option>
        </select>
      </label>
      {shown && (
        <fieldset class="choices">
          <legend>Colour springs by</legend>
          {casing.columns.map((column) => (
            <label key={column} title={HINTS[column]}>
              <input
                type="radio"
                name="case-column"
                checked={casing.seen === column}
                onChange={() => (casing.column.value = column)}
              />
              {titled(column)}
            </label>
          ))}
        </fieldset>
      )}
      {isCase && (
        <NumberField
          name="Displacements times"
          seen="Displacements times"
          value={casing.factor.value}
          unit=""
          hint="Displacements are drawn so many times as large; usual are 1 to 50"
          bounds={{ minimum: 0, maximum: 1000 }}
          done={(value) => (casing.factor.value = value ?? 1)}
        />
      )}
    </>
  );
}

function show(casing: Casing, name: string): void {
  casing.shown.value = name;
  if (!name) casing.leave();
}

/** What is to be known of the case that is shown. */
function Told({ casing }: { casing: Casing }) {
  const solved = casing.solved.value!;
  const one = solved.cases.find(({ name }) => name === casing.shown.value);
  if (!one) return null;
  const slack = one.slack.reduce((sum, { elements }) => sum + elements.length, 0);
  const factors = Object.entries(one.factors).map(([name, factor]) => `${said(factor)} × ${name}`);
  return (
    <p role="status">
      {factors.join(" + ")}. {titled(one.result.status)}, {one.result.stability}
      {slack ? `; ${counted(slack, "element")} ${slack === 1 ? "is" : "are"} slack` : ""}.
    </p>
  );
}

function Maxima({ studio }: { studio: Studio }) {
  const { casing, session, options } = studio;
  const topology = session.topology.value;
  if (!topology) return null;
  const rows = maxima(casing.solved.value!, topology);
  const of = (row: Most) => (row.unit === "%" ? "%" : unit(row.unit, topology.units));
  const save = () => keep(new Blob([csv(rows, of)], { type: "text/csv" }), `${session.key}-cases.csv`);
  const look = (row: Most) => {
    casing.shown.value = row.case;
    options.picked.value = row.picked;
  };
  return (
    <div class="compare">
      <div class="scrolled" tabIndex={0} role="region" aria-label="Largest of all load cases">
        <table>
          <thead>
            <tr>
              <th scope="col">Largest</th>
              <th scope="col">Value</th>
              <th scope="col">At</th>
              <th scope="col">Case</th>
            </tr>
          </thead>
          <tbody class="numbers">
            {rows.map((row) => (
              <tr key={row.name}>
                <th scope="row">
                  {titled(row.name)} {of(row) && <span class="unit">[{of(row)}]</span>}
                </th>
                <td>{said(row.value)}</td>
                <td>
                  <button
                    type="button"
                    class="small"
                    title={`Show this in ${row.case}`}
                    aria-label={`Show ${row.name} at ${row.where} in ${row.case}`}
                    onClick={() => look(row)}
                  >
                    {row.where}
                  </button>
                </td>
                <td>{row.case}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <button type="button" class="small" title="Save this table as a CSV file" onClick={save}>
        Save maxima
      </button>
    </div>
  );
}

const quoted = (text: string) => `"${text.replaceAll('"', '""')}"`;

const csv = (rows: Most[], of: (row: Most) => string) =>
  [
    "quantity,unit,value,at,case",
    ...rows.map((row) => [quoted(row.name), quoted(of(row)), row.value, row.where, quoted(row.case)].join()),
    "",
  ].join("\r\n");
