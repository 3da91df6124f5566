// The live page: the picture, what can be set, and the rays of a pixel, beside each other or behind tabs.
import type { JSX } from "preact";

import { count } from "../../data/number";
import type { Live, Pane, Side } from "../../live/live";
import { PICTURE_HELP } from "../../live/keys";
import { HELP } from "../../state/keys";
import { LookButtons } from "../Header";
import { HelpSheet, Legend } from "../Help";
import { Choice } from "../parts";
import { Stage } from "../Stage";
import { Tabs } from "../Tabs";
import { TreePanel } from "../TreePanel";
import { useWide } from "../wide";
import { Banners } from "./Banners";
import { PictureView } from "./PictureView";
import { RayHead, RaySide } from "./RaySide";
import { SCENE_TABS, ScenePanel } from "./ScenePanel";
import { StatusBar } from "./StatusBar";

export function LiveApp({ live }: { live: Live }): JSX.Element {
  const wide = useWide();
  const store = live.rays.store.value;
  return (
    <div class={`page live ${wide ? "wide" : ""} ${store ? "with-rays" : ""} shows-${live.pane.value}`}>
      <LiveHeader live={live} />
      {wide && store && <aside class="column tree" aria-label="Ray tree"><TreePanel key={live.rays.stage.value} store={store} /></aside>}
      <main class="stage">
        <Banners live={live} />
        <PictureView live={live} />
        {store && <div class="space" data-stage={live.rays.stage.value}><Stage key={live.rays.stage.value} store={store} /></div>}
        <StatusBar live={live} />
      </main>
      <Panels live={live} wide={wide} />
      <HelpSheet looks={live.looks} groups={store ? [...PICTURE_HELP, ...HELP] : PICTURE_HELP} hands={HANDS}>{store && <Legend store={store} />}</HelpSheet>
      <div class="hidden" role="status" aria-live="polite">{live.looks.said.value}</div>
    </div>
  );
}

const HANDS: [string, string][] = [
  ["drag, one finger", "orbit, look around or shift, as chosen above the picture"], ["right drag, two fingers", "shift"],
  ["wheel, pinch", "nearer, farther; with Ctrl magnify"], ["click, tap", "the rays of the pixel; with Alt only what is there"],
];

function LiveHeader({ live }: { live: Live }): JSX.Element {
  const { scene, forms, picture } = live.main;
  const film = picture.value?.header.film;
  return (
    <header class="header">
      <h1>{scene.value?.name ?? "…"}</h1>
      <p class="facts">
        {film && <span class="wide-only">{film[0]} × {film[1]}</span>}
        <span class="wide-only">{forms.value.get("integrator")?.kind}</span>
        {scene.value && scene.value.triangles > 0 && <span class="wide-only">{count(scene.value.triangles)} triangles</span>}
      </p>
      {live.rays.store.value && (
        <Choice<Pane> label="What is shown above" value={live.pane.value} options={[["picture", "Picture"], ["space", "3D"]]} onChange={(pane) => (live.pane.value = pane)} />
      )}
      <LookButtons looks={live.looks} />
    </header>
  );
}

function Panels({ live, wide }: { live: Live; wide: boolean }): JSX.Element {
  const store = live.rays.store.value;
  const rays = live.rays.open.value;
  const side: Side = rays ? live.side.value : "scene";
  return (
    <aside class="column panel" aria-label="Details">
      {rays && (
        <div class="sidehead">
          <Choice<Side> label="Settings or rays" value={side} options={[["scene", "Scene"], ["rays", "Rays"]]} onChange={(to) => (live.side.value = to)} />
          <RayHead live={live} />
        </div>
      )}
      {side === "rays"
        ? store ? <RaySide key={live.rays.stage.value} live={live} store={store} wide={wide} /> : <p class="empty body">{live.rays.problem.value ? "" : "Tracing …"}</p>
        : <Tabs tabs={SCENE_TABS} tab={live.tab.value} choose={(tab) => (live.tab.value = tab)}><ScenePanel live={live} tab={live.tab.value} /></Tabs>}
    </aside>
  );
}
