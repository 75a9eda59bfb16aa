// Light or dark: as the system has it, or as was chosen in this browser, which remembers that.
import { computed, effect, signal } from "@preact/signals";

export type Theme = "system" | "light" | "dark";

const NAME = "hookean-theme";
const system = window.matchMedia("(prefers-color-scheme: dark)");
const systemDark = signal(system.matches);
system.addEventListener("change", () => (systemDark.value = system.matches));

const kept = remembered<Theme>(NAME, "system");

export const theme = signal<Theme>(["light", "dark"].includes(kept) ? kept : "system");
export const dark = computed(() => (theme.value === "system" ? systemDark.value : theme.value === "dark"));

effect(() => {
  document.documentElement.dataset["theme"] = dark.value ? "dark" : "light";
  remember(NAME, theme.value);
});

/** What this browser remembers; `otherwise` where it remembers nothing or may not. */
export function remembered<T>(name: string, otherwise: T): T {
  try {
    return JSON.parse(localStorage.getItem(name) ?? "null") ?? otherwise;
  } catch {
    return otherwise;
  }
}

/** Have this browser remember something; one that must not forgets it. */
export function remember(name: string, value: unknown): void {
  try {
    localStorage.setItem(name, JSON.stringify(value));
  } catch {
    // a browser that keeps nothing shows the same page
  }
}
