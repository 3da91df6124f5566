// The page's parts and how they lie beside each other: three columns, two, or one.
import type { JSX } from "preact";

import { openTab } from "../state/keys";
import type { Store } from "../state/store";
import { Header } from "./Header";
import { Help } from "./Help";
import { RayPanel, rayTabs } from "./RayPanel";
import { Stage } from "./Stage";
import { Tabs } from "./Tabs";
import { TreePanel } from "./TreePanel";
import { useWide } from "./wide";

export function App({ store }: { store: Store }): JSX.Element {
  const wide = useWide();
  return (
    <div class={`page ${wide ? "wide" : ""}`}>
      <Header store={store} />
      {wide && (
        <aside class="column tree" aria-label="Ray tree"><TreePanel store={store} /></aside>
      )}
      <main class="stage"><Stage store={store} /></main>
      <Panels store={store} wide={wide} />
      <Help store={store} />
      <div class="hidden" role="status" aria-live="polite">{store.said.value}</div>
    </div>
  );
}

function Panels({ store, wide }: { store: Store; wide: boolean }): JSX.Element {
  const shown = rayTabs(wide, store.page.other !== null);
  const tab = wide && store.tab.value === "tree" ? "ray" : store.tab.value;
  return (
    <aside class="column panel" aria-label="Details">
      <Tabs tabs={shown} tab={tab} choose={(to) => openTab(store, to)}><RayPanel store={store} tab={tab} /></Tabs>
    </aside>
  );
}
