// The rays of the chosen pixel: which sample, how long it took, all views of a ray tree, and what they are compared with.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { counts } from "../../live/fields";
import type { Live } from "../../live/live";
import type { Rival, Value } from "../../live/protocol";
import { openTab } from "../../state/keys";
import type { Store } from "../../state/store";
import { Empty, Section } from "../parts";
import { RayPanel, rayTabs } from "../RayPanel";
import { Tabs } from "../Tabs";
import { Field } from "./Field";

export function RaySide({ live, store, wide }: { live: Live; store: Store; wide: boolean }): JSX.Element {
  const tab = wide && store.tab.value === "tree" ? "ray" : store.tab.value;
  return (
    <Tabs tabs={rayTabs(wide, true)} tab={tab} choose={(to) => (to === "compare" ? (store.tab.value = to, store.machine.value = false) : openTab(store, to))}>
      {tab === "compare" && <Versus live={live} />}
      {tab === "compare" && !store.page.other ? <Empty>Nothing is compared yet.</Empty> : <RayPanel store={store} tab={tab} />}
    </Tabs>
  );
}

/** Which pixel and which of its samples. */
export function RayHead({ live }: { live: Live }): JSX.Element {
  const { rays, main } = live;
  const store = rays.store.value;
  const of = store?.page.values.length || main.picture.value?.header.of || 1;
  const at = store?.g.value.tree.sample ?? 0;
  return (
    <div class="rayhead">
      <div class="line">
        <b>Pixel ({rays.pixel.value?.join(", ")})</b>
        <span class="quiet">{rays.busy.value ? "tracing …" : rays.ms.value !== null ? `${Math.max(rays.ms.value, 0.1).toFixed(1)} ms` : ""}</span>
        <button type="button" aria-pressed={rays.sample.value === "brightest"} title="The sample that adds most light"
          onClick={() => rays.choose(rays.sample.value === "brightest" ? at : "brightest")}>brightest</button>
        <button type="button" class="close" title="Close the ray tree (Esc)" onClick={() => live.closeRays()}>×<span class="hidden">Close the ray tree</span></button>
      </div>
      {of > 1 && (
        <label class="scrub">sample <output>{at}</output>
          <input type="range" min="0" max={of - 1} value={at} aria-label={`Sample, of ${of}`} onInput={(event) => scrub(live, store, Number(event.currentTarget.value))} />
        </label>
      )}
      {rays.problem.value && <p class="wrong" role="alert">{rays.problem.value}</p>}
    </div>
  );
}

/** Goes to a sample: at once if its rays are here. */
function scrub(live: Live, store: Store | null, sample: number): void {
  const here = store?.page.trees.findIndex((tree) => tree.sample === sample) ?? -1;
  if (store && here >= 0) store.chooseTree(here);
  else live.rays.choose(sample);
}

/** What the rays are compared with: another integrator, or this one with other parameters. */
function Versus({ live }: { live: Live }): JSX.Element | null {
  const form = live.main.forms.value.get("integrator");
  const { rival } = live.rays;
  const words = useSignal<Record<string, Value>>(rival.value?.params ?? {});
  if (!form) return null;
  const kind = rival.value?.kind ?? "";
  const compare = (to: string, params: Record<string, Value>): void => {
    words.value = params;
    const next: Rival | null = to === "" ? null : { kind: to, params };
    rival.value = next;
  };
  // Of another integrator only the parameters are known that it shares with this one; the program says if it does not.
  const params = form.params.filter((param) => param.editable && (kind === form.kind || param.name === "maxdepth"));
  return (
    <Section title="Compare with" note="the same pixel and random numbers">
      <div class="field kind">
        <label for="rival">integrator</label>
        <div class="entry"><select id="rival" value={kind} onChange={(event) => compare(event.currentTarget.value, {})}>
          <option value="">nothing</option>
          {form.kinds.map((word) => <option key={word} value={word}>{word === form.kind ? `${word}, with other parameters` : word}</option>)}
        </select></div><span />
      </div>
      {kind !== "" && params.map((param) => {
        const own = words.value[param.name];
        return (
          <Field key={param.name} of="rival" param={{ ...param, default: counts(param) }} value={own ?? counts(param)} given={own !== undefined} textures={[]}
            set={(value) => {
              const { [param.name]: _, ...others } = words.value;
              compare(kind, value === null ? others : { ...others, [param.name]: value });
            }} />
        );
      })}
    </Section>
  );
}
