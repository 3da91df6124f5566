// The picture and the changed scene as files.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import type { Live } from "../../live/live";
import { Section } from "../parts";

const FORMATS: [string, string, string][] = [
  ["png", "PNG", "The picture as it is seen"], ["exr", "EXR", "The light itself, neither exposed nor tone-mapped"], ["pbrt", ".pbrt", "The scene with all changes; its files stay where they are. A scene whose pictures or large meshes lie within its file comes as .zip"],
  ["zip", ".zip", "The scene with all changes and all its files, to be unpacked anywhere"],
];

/** Fetches a file of the program and gives it to the browser as a download. Says what went wrong. */
async function download(address: string, name: string): Promise<string | null> {
  const answer = await fetch(address);
  if (!answer.ok) return (await answer.text()).trim() || `${answer.status} ${answer.statusText}`;
  const named = /filename="?([^";]+)"?/.exec(answer.headers.get("content-disposition") ?? "")?.[1] ?? name;
  const url = URL.createObjectURL(await answer.blob());
  const link = document.createElement("a");
  [link.href, link.download] = [url, named];
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
  return null;
}

export function Save({ live }: { live: Live }): JSX.Element {
  const problem = useSignal("");
  const busy = useSignal("");
  const save = async (format: string): Promise<void> => {
    const words = new URLSearchParams(location.search);
    words.set("session", live.main.link.session ?? "");
    words.set("format", format);
    busy.value = format;
    try {
      problem.value = (await download(`/save?${words}`, `${live.main.scene.value?.name ?? "picture"}.${format}`)) ?? "";
    } catch (error) {
      problem.value = `It could not be fetched: ${String(error)}`;
    }
    busy.value = "";
  };
  return (
    <Section title="Save">
      <div class="rowed">{FORMATS.map(([format, word, says]) => (
        <button key={format} type="button" title={says} disabled={busy.value !== ""} onClick={() => void save(format)}>{word}</button>
      ))}</div>
      {problem.value && <p class="wrong" role="alert">{problem.value}</p>}
    </Section>
  );
}
