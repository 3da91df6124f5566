// How the page looks and what it tells: shared by all that is shown, whatever tree or picture that is.
import { effect, signal } from "@preact/signals";

import type { Palette } from "../data/kinds";

export type Theme = "auto" | "light" | "dark";

export function createLooks() {
  const said = signal("");
  /** Tells people who listen to the page. */
  function say(text: string): void {
    said.value = "";
    queueMicrotask(() => (said.value = text));
  }
  return { theme: signal<Theme>("auto"), dark: signal(false), palette: signal<Palette>("lecture"), help: signal(false), said, say };
}

export type Looks = ReturnType<typeof createLooks>;

/** Light or dark as chosen, else as the system has it. */
export function followTheme(looks: Looks): void {
  const system = matchMedia("(prefers-color-scheme: dark)");
  const apply = (): void => {
    looks.dark.value = looks.theme.value === "auto" ? system.matches : looks.theme.value === "dark";
    document.documentElement.dataset["theme"] = looks.dark.value ? "dark" : "light";
  };
  system.addEventListener("change", apply);
  effect(apply);
}
