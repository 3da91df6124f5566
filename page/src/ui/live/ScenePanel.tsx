// What can be set of the scene and of its picture, each group behind a tab.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { count, num } from "../../data/number";
import type { Live, SceneTab } from "../../live/live";
import type { Form } from "../../live/protocol";
import { Empty, Section } from "../parts";
import { Folded, FormCard } from "./FormCard";
import { Save } from "./Save";
import { Split } from "./Split";

export const SCENE_TABS: [SceneTab, string][] = [
  ["look", "Look"], ["render", "Render"], ["camera", "Camera"], ["lights", "Lights"], ["materials", "Materials"], ["scene", "Scene"],
];

export function ScenePanel({ live, tab }: { live: Live; tab: SceneTab }): JSX.Element {
  switch (tab) {
    case "look": return <LookPanel live={live} />;
    case "render": return <><One live={live} id="integrator" title="Integrator" /><One live={live} id="sampler" title="Sampler" /><One live={live} id="film" title="Film" /></>;
    case "camera": return <CameraPanel live={live} />;
    case "lights": return <Many live={live} families={["light", "arealight"]} none="This scene has no lights." />;
    case "materials": return <Many live={live} families={["material"]} none="This scene has no materials." />;
    case "scene": return <ScenePage live={live} />;
  }
}

function One({ live, id, title }: { live: Live; id: string; title: string }): JSX.Element | null {
  const form = live.main.forms.value.get(id);
  return form ? <Section title={title}><FormCard session={live.main} form={form} /></Section> : null;
}

const LAYERS: Record<string, string> = {
  beauty: "the picture", depth: "distance", normal: "way that surfaces face", shading: "shading normals", albedo: "colour of surfaces",
  uv: "texture places", id: "objects", cost: "tests of rays: where time goes",
  rays: "rays of a sample", noise: "how much samples differ",
};

function LookPanel({ live }: { live: Live }): JSX.Element {
  const { main } = live;
  const header = main.picture.value?.header;
  return (
    <>
      <Section title="Layer" note={LAYERS[main.layer.value] ?? ""}>
        <div class="layers" role="group" aria-label="Layer">
          {main.layers.value.map((layer) => (
            <button key={layer} type="button" aria-pressed={layer === main.layer.value} onClick={() => main.show(layer)}>{layer}</button>
          ))}
        </div>
        {header?.range && header.layer === main.layer.value && <Scale from={`${num(header.range[0], 3)} m`} to={`${num(header.range[1], 3)} m`} kind="depth" />}
        {header?.white != null && header.layer === main.layer.value && <Scale from="0" to={header.layer === "noise" ? `±${num(header.white, 3)}` : `${num(header.white, 4)} ${header.layer === "rays" ? "rays" : "tests"}`} kind="cost" />}
      </Section>
      <One live={live} id="look" title="Exposure and tone" />
      <Split live={live} />
      <Save live={live} />
    </>
  );
}

/** What black and white of a layer stand for. */
function Scale({ from, to, kind }: { from: string; to: string; kind: string }): JSX.Element {
  return <p class={`scale ${kind}`}><span>{from}</span><i aria-hidden="true" /><span>{to}</span></p>;
}

function CameraPanel({ live }: { live: Live }): JSX.Element {
  const { scene, camera } = live.main;
  const names = scene.value?.cameras ?? [];
  const at = camera.value;
  return (
    <>
      <Section title="Where it stands">
        <div class="rowed">
          {names.length === 0 && <button type="button" onClick={() => live.home(null)}>Automatic</button>}
          {names.map((name) => (
            <button key={name} type="button" aria-pressed={at?.exact === true && at.name === name} onClick={() => live.home(name)}>{name}</button>
          ))}
        </div>
        {at && (
          <dl class="facts-list">
            <dt>eye</dt><dd>{at.eye.map((x) => num(x)).join("  ")}</dd>
            <dt>looks along</dt><dd>{at.forward.map((x) => num(x)).join("  ")}</dd>
            {at.fov && <><dt>opening</dt><dd>{at.fov.map((x) => `${num(x, 3)}°`).join(" × ")}</dd></>}
            <dt>turns around</dt><dd>{num(live.main.pose.value?.distance, 3)} m ahead</dd>
          </dl>
        )}
      </Section>
      <One live={live} id="camera" title="Camera" />
      <One live={live} id="moment" title="Time" />
    </>
  );
}

function Many({ live, families, none }: { live: Live; families: string[]; none: string }): JSX.Element {
  const words = useSignal("");
  const all = [...live.main.forms.value.values()].filter((form) => families.includes(form.family) || families.includes(form.id.split("/")[0]!));
  if (all.length === 0) return <Empty>{none}</Empty>;
  const fits = (form: Form): boolean => `${form.title} ${form.kind}`.toLowerCase().includes(words.value.toLowerCase());
  const shown = all.filter(fits);
  const chosen = live.shownForm.value;
  return (
    <>
      {all.length > 6 && <input class="search" type="search" placeholder={`Find among ${all.length}`} aria-label="Find by name" value={words.value} onInput={(event) => (words.value = event.currentTarget.value)} />}
      {shown.slice(0, 200).map((form) => (
        <Folded key={form.id} session={live.main} form={form} open={chosen === form.id || (all.length === 1 && chosen === null)}
          toggle={(open) => (live.shownForm.value = open ? form.id : "")} />
      ))}
      {shown.length > 200 && <p class="note">and {shown.length - 200} more: find them by name</p>}
      {shown.length === 0 && <Empty>None is called so.</Empty>}
    </>
  );
}

function ScenePage({ live }: { live: Live }): JSX.Element {
  const scene = live.main.scene.value;
  if (!scene) return <Empty>There is no scene yet.</Empty>;
  const changed = [...live.main.forms.value.values()].filter((form) => form.changed);
  return (
    <>
      <Section title={scene.name}>
        <dl class="facts-list">
          <dt>triangles</dt><dd>{count(scene.triangles)}</dd>
          <dt>objects</dt><dd>{count(scene.objects)}</dd>
          {scene.bounds && <><dt>size</dt><dd>{[0, 1, 2].map((i) => num(scene.bounds![1][i]! - scene.bounds![0][i]!, 3)).join(" × ")} m</dd></>}
          {scene.time[1] > scene.time[0] && <><dt>moves</dt><dd>{num(scene.time[0])} … {num(scene.time[1])} s</dd></>}
          {scene.revision > 1 && <><dt>read</dt><dd>{scene.revision} times</dd></>}
        </dl>
      </Section>
      <Section title="Changed here">
        {changed.length === 0 ? <Empty>Nothing: all is as the file has it.</Empty> : (
          <><ul class="changed">{changed.map((form) => <li key={form.id}><button type="button" onClick={() => live.showForm(form.id)}>{form.title}</button></li>)}</ul>
            <button type="button" onClick={() => live.main.reset(null)}>All as in the scene</button></>
        )}
      </Section>
      {scene.warnings.length > 0 && <Section title="Warnings"><ul class="warnings">{scene.warnings.map((warning) => <li key={warning}>{warning}</li>)}</ul></Section>}
      <p class="note">durer {live.main.durer.value}</p>
    </>
  );
}
