// One of several words.
interface Told {
  name: string;
  value: string;
  choices: string[];
  hint?: string;
  disabled?: boolean;
  done: (value: string) => void;
}

export function Choice({ name, value, choices, hint, disabled, done }: Told) {
  return (
    <label class="field">
      <span>{name}</span>
      <select
        aria-label={name}
        title={hint}
        value={value}
        disabled={disabled}
        onChange={(event) => done(event.currentTarget.value)}
      >
        {choices.map((one) => (
          <option key={one}>{one}</option>
        ))}
      </select>
    </label>
  );
}
