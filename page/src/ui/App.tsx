// The page's parts and how they lie beside each other: three columns, two, or one.
import { signal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { openTab } from "../state/keys";
import type { Store, Tab } from "../state/store";
import { Compare } from "./Compare";
import { Header } from "./Header";
import { Help } from "./Help";
import { Inspector } from "./Inspector";
import { MachinePanel } from "./MachinePanel";
import { Numbers } from "./Numbers";
import { PlayPanel } from "./PlayPanel";
import { Samples } from "./Samples";
import { Stage } from "./Stage";
import { TreePanel } from "./TreePanel";
import { Walk } from "./Walk";

const TABS: [Tab, string][] = [
  ["tree", "Tree"], ["ray", "Ray"], ["play", "Play"], ["samples", "Samples"], ["numbers", "Numbers"],
  ["compare", "Compare"], ["walk", "Walk"], ["machine", "Machine"],
];

/** Wide enough for the tree to have a column of its own. */
const wide = signal(true);

export function App({ store }: { store: Store }): JSX.Element {
  useEffect(() => {
    const query = matchMedia("(min-width: 1080px)");
    const follow = (): void => void (wide.value = query.matches);
    follow();
    query.addEventListener("change", follow);
    return () => query.removeEventListener("change", follow);
  }, []);
  return (
    <div class={`page ${wide.value ? "wide" : ""}`}>
      <Header store={store} />
      {wide.value && (
        <aside class="column tree" aria-label="Ray tree"><TreePanel store={store} /></aside>
      )}
      <main class="stage"><Stage store={store} /></main>
      <Panels store={store} />
      <Help store={store} />
      <div class="hidden" role="status" aria-live="polite">{store.said.value}</div>
    </div>
  );
}

function Panels({ store }: { store: Store }): JSX.Element {
  const shown = TABS.filter(([tab]) => (tab !== "tree" || !wide.value) && (tab !== "compare" || store.page.other !== null));
  const tab = wide.value && store.tab.value === "tree" ? "ray" : store.tab.value;
  const list = useRef<HTMLDivElement>(null);
  const body = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (body.current) body.current.scrollTop = 0;
    const chosen = list.current?.querySelector<HTMLElement>("[aria-selected=true]");
    chosen?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }, [tab]);
  const move = (event: KeyboardEvent): void => {
    const at = shown.findIndex(([key]) => key === tab);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: shown.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    openTab(store, shown[(to + shown.length) % shown.length]![0]);
    requestAnimationFrame(() => list.current?.querySelector<HTMLElement>("[aria-selected=true]")?.focus());
  };
  return (
    <aside class="column panel" aria-label="Details">
      <div class="tabs" role="tablist" ref={list} onKeyDown={move}>
        {shown.map(([key, word]) => (
          <button
            key={key} type="button" role="tab" id={`tab-${key}`} aria-selected={key === tab} aria-controls="panel"
            tabIndex={key === tab ? 0 : -1} onClick={() => openTab(store, key)}
          >{word}</button>
        ))}
      </div>
      <div class={`body of-${tab}`} role="tabpanel" id="panel" aria-labelledby={`tab-${tab}`} ref={body}>
        {content(store, tab)}
      </div>
    </aside>
  );
}

function content(store: Store, tab: Tab): JSX.Element {
  switch (tab) {
    case "tree": return <TreePanel store={store} />;
    case "ray": return <Inspector store={store} />;
    case "play": return <PlayPanel store={store} />;
    case "samples": return <Samples store={store} />;
    case "numbers": return <Numbers store={store} />;
    case "compare": return <Compare store={store} />;
    case "walk": return <Walk store={store} />;
    case "machine": return <MachinePanel store={store} />;
  }
}
