// Whether the window is wide.
import { signal } from "@preact/signals";
import { useEffect } from "preact/hooks";

/** Wide enough for the tree to have a column of its own. */
const wide = signal(true);

export function useWide(): boolean {
  useEffect(() => {
    const query = matchMedia("(min-width: 1080px)");
    const follow = (): void => void (wide.value = query.matches);
    follow();
    query.addEventListener("change", follow);
    return () => query.removeEventListener("change", follow);
  }, []);
  return wide.value;
}
