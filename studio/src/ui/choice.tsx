// One of several words.
interface Told {
  /** Its name; `seen` is what stands before it, where that is shorter. */
  name: string;
  seen?: string;
  value: string;
  choices: string[];
  hint?: string;
  disabled?: boolean;
  done: (value: string) => void;
}

export function Choice({ name, seen, value, choices, hint, disabled, done }: Told) {
  return (
    <label class="field">
      <span>{seen ?? name}</span>
      <select
        aria-label={name}
        title={hint}
        value={value}
        disabled={disabled}
        onChange={(event) => done(event.currentTarget.value)}
      >
        {choices.map((one) => (
          <option key={one} value={one}>
            {one || "all"}
          </option>
        ))}
      </select>
    </label>
  );
}
