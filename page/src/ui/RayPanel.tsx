// The views of a ray tree, each behind a tab.
import type { JSX } from "preact";

import type { Store, Tab } from "../state/store";
import { Compare } from "./Compare";
import { Inspector } from "./Inspector";
import { MachinePanel } from "./MachinePanel";
import { Numbers } from "./Numbers";
import { PlayPanel } from "./PlayPanel";
import { Samples } from "./Samples";
import { TreePanel } from "./TreePanel";
import { Walk } from "./Walk";

const TABS: [Tab, string][] = [
  ["tree", "Tree"], ["ray", "Ray"], ["play", "Play"], ["samples", "Samples"], ["numbers", "Numbers"],
  ["compare", "Compare"], ["walk", "Walk"], ["machine", "Machine"],
];

/** The tabs that there is something for; on wide screens the tree has a column of its own. */
export function rayTabs(wide: boolean, compares: boolean): [Tab, string][] {
  return TABS.filter(([tab]) => (tab !== "tree" || !wide) && (tab !== "compare" || compares));
}

/** What a tab shows. */
export function RayPanel({ store, tab }: { store: Store; tab: Tab }): JSX.Element {
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
