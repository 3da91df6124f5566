// Statistics of the rays: what they bring by length, kind, light and lobe; what was cut off.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { luminance } from "../data/color";
import { cssOf, stopOf } from "../data/kinds";
import { count, num, percent } from "../data/number";
import { statistics, type Share, type Statistics } from "../data/statistics";
import type { Store } from "../state/store";
import { Bar, Choice, Empty, KindLine, LeftOutNote, Section } from "./parts";

export function Numbers({ store }: { store: Store }): JSX.Element {
  const all = useSignal<"this" | "all">("this");
  const many = store.page.trees.length > 1;
  const s = statistics(all.value === "all" ? store.page.trees : [store.g.value.tree]);
  const part = (light: number): number => (s.value > 0 ? light / s.value : 0);
  return (
    <>
      {many && <div class="rowed"><Choice<"this" | "all"> label="Which samples" value={all.value} options={[["this", "This sample"], ["all", `All ${store.page.trees.length} in this page`]]} onChange={(v) => (all.value = v)} /></div>}
      <LeftOutNote store={store} />
      <Killed s={s} />
      <Section title="Light by length of the path" note="what the rays of each depth add themselves">
        <Depths s={s} />
      </Section>
      <Section title="Rays by kind">
        <Table rows={s.kinds} part={part} most={(row) => (row.kind ? cssOf(row.kind, store.palette.value) : undefined)} lead={(row) => row.kind && <KindLine kind={row.kind} store={store} />} />
        <p class="note">{count(s.rays)} rays, {count(s.boxes)} boxes and {count(s.primitives)} primitives tested{s.rays > 0 && `: ${num(s.boxes / s.rays, 3)} and ${num(s.primitives / s.rays, 3)} per ray`}.</p>
      </Section>
      <Section title="Light by where it comes from"><Table rows={s.lobes} part={part} /></Section>
      <Section title="Lights" note="shadow rays">
        {s.lights.length === 0 ? <Empty>No shadow rays.</Empty> : <LightTable s={s} part={part} />}
      </Section>
      <Section title="Why rays end">
        <table class="numbers"><tbody>
          {s.stops.map((stop) => (
            <tr key={stop.name}><th scope="row"><b class="sign">{stopOf(stop.name).sign}</b> {stopOf(stop.name).word}</th><td class="wide"><Bar share={stop.rays / s.stops[0]!.rays} /></td><td>{count(stop.rays)}</td></tr>
          ))}
        </tbody></table>
      </Section>
    </>
  );
}

/** How much light the cut branches can have carried at most. */
function Killed({ s }: { s: Statistics }): JSX.Element {
  const relative = s.value > 0 ? s.bound / s.value : s.bound > 0 ? Infinity : 0;
  const whole = s.value + s.bound || 1;
  return (
    <Section title="Cut off">
      <div class="killed" role="img" aria-label={`${s.unbounded ? "About" : "At most"} ${percent(relative)} of the value was cut off`}>
        <i style={{ width: `${(s.value / whole) * 100}%` }} /><b style={{ width: `${(s.bound / whole) * 100}%` }} />
      </div>
      <p class="note">
        {s.bound === 0
          ? "No branch was given up: nothing is missing."
          : <>Branches that were given up had {num(luminance(s.killed), 3)} of the pixel. {s.unbounded
            ? <>There is no bound on what they would have brought: {s.unbounded}. If each had brought the brightest light seen here, {num(s.bound, 3)} would be missing</>
            : <>{num(s.bound, 3)} is missing at most, whatever in the scene they had met</>}: {percent(relative)} of the value {num(s.value, 3)}.</>}
      </p>
    </Section>
  );
}

function Depths({ s }: { s: Statistics }): JSX.Element {
  const most = Math.max(...s.depths.map((d) => Math.abs(d.light)), 1e-30);
  return (
    <table class="numbers"><tbody>
      {s.depths.map((d) => (
        <tr key={d.depth}><th scope="row">{d.depth}</th><td class="wide"><Bar share={d.light / most} /></td><td>{percent(s.value > 0 ? d.light / s.value : 0)}</td><td class="quiet">{count(d.rays)} {d.rays === 1 ? "ray" : "rays"}</td></tr>
      ))}
    </tbody></table>
  );
}

function Table(props: { rows: Share[]; part: (light: number) => number; most?: (row: Share) => string | undefined; lead?: (row: Share) => JSX.Element | undefined }): JSX.Element {
  const { rows, part, most, lead } = props;
  return (
    <table class="numbers"><tbody>
      {rows.map((row) => {
        const color = most?.(row);
        return (
          <tr key={row.name}><th scope="row">{lead?.(row)}{row.name}</th><td class="wide"><Bar share={part(row.light)} {...(color && { color })} /></td><td>{percent(part(row.light))}</td><td class="quiet">{count(row.rays)}</td></tr>
        );
      })}
    </tbody></table>
  );
}

function LightTable({ s, part }: { s: Statistics; part: (light: number) => number }): JSX.Element {
  return (
    <>
      <table class="numbers"><tbody>
        {s.lights.map((light) => (
          <tr key={light.name}><th scope="row">{light.name}</th><td class="wide"><Bar share={part(light.light)} /></td><td>{percent(part(light.light))}</td>
            <td class="quiet">{light.occluded} of {light.asked} in shadow</td></tr>
        ))}
      </tbody></table>
      <p class="note">{percent(s.asked > 0 ? s.occluded / s.asked : 0)} of the shadow rays met something in the way.</p>
    </>
  );
}
