// The split view: another integrator, a picture from a file, or this picture as it is now.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import type { Live } from "../../live/live";
import { Section } from "../parts";
import { FormCard } from "./FormCard";

export function Split({ live }: { live: Live }): JSX.Element {
  const other = live.against.value;
  const problem = useSignal("");
  const kinds = live.main.forms.value.get("integrator")?.kinds ?? [];
  const read = async (file: File | undefined): Promise<void> => {
    if (!file) return;
    try {
      await live.compareWith(file);
      problem.value = "";
    } catch (error) {
      problem.value = `${file.name}: ${error instanceof Error ? error.message : String(error)}`;
    }
  };
  const keep = async (): Promise<void> => {
    const now = live.main.picture.value;
    if (now) live.hold(await createImageBitmap(now.image), "as it was");
  };
  return (
    <Section title="Split view" note={other ? `right: ${nameOf(live)}` : "drag the line to compare"}>
      <div class="rowed">
        <label>with <select value="" aria-label="Another integrator" onChange={(event) => event.currentTarget.value && live.split(event.currentTarget.value)}>
          <option value="">integrator …</option>
          {kinds.map((kind) => <option key={kind} value={kind}>{kind}</option>)}
        </select></label>
        <label class="filebutton" title="PNG, JPEG, WebP; OpenEXR, Radiance HDR and PFM are exposed and tone-mapped like this picture">a file …<input type="file" accept="image/*,.exr,.hdr,.pfm,.tga" class="hidden" onChange={(event) => void read(event.currentTarget.files?.[0])} /></label>
        <button type="button" title="Keeps the picture as it is now, to see what a change does" onClick={() => void keep()}>this, as it is</button>
        {other && <button type="button" onClick={() => live.unsplit()}>End</button>}
      </div>
      {problem.value && <p class="wrong" role="alert">{problem.value}</p>}
      {other?.is === "session" && other.session.forms.value.get("integrator") && (
        <FormCard session={other.session} form={other.session.forms.value.get("integrator")!} name="right side" />
      )}
    </Section>
  );
}

/** What stands right of the line. */
export function nameOf(live: Live): string {
  const other = live.against.value;
  if (!other) return "";
  return other.is === "image" ? other.name : other.session.forms.value.get("integrator")?.kind ?? "…";
}
