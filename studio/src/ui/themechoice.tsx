import { type Theme, theme } from "./theme";

/** Light, dark, or as the system has it. */
export function ThemeChoice() {
  return (
    <label class="theme" title="Light or dark colours; System follows this computer">
      <span>Theme</span>{" "}
      <select value={theme.value} onChange={(event) => (theme.value = event.currentTarget.value as Theme)}>
        <option value="system">System</option>
        <option value="light">Light</option>
        <option value="dark">Dark</option>
      </select>
    </label>
  );
}
