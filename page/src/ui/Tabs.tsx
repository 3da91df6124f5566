// A row of tabs with what the chosen one shows.
import type { ComponentChildren, JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

export function Tabs<T extends string>(props: { tabs: [T, string][]; tab: T; choose: (tab: T) => void; children: ComponentChildren }): JSX.Element {
  const { tabs, tab, choose, children } = props;
  const list = useRef<HTMLDivElement>(null);
  const body = useRef<HTMLDivElement>(null);
  useEffect(() => {
    if (body.current) body.current.scrollTop = 0;
    const chosen = list.current?.querySelector<HTMLElement>("[aria-selected=true]");
    chosen?.scrollIntoView({ block: "nearest", inline: "nearest" });
  }, [tab]);
  const move = (event: KeyboardEvent): void => {
    const at = tabs.findIndex(([key]) => key === tab);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    choose(tabs[(to + tabs.length) % tabs.length]![0]);
    requestAnimationFrame(() => list.current?.querySelector<HTMLElement>("[aria-selected=true]")?.focus());
  };
  return (
    <>
      <div class="tabs" role="tablist" ref={list} onKeyDown={move}>
        {tabs.map(([key, word]) => (
          <button
            key={key} type="button" role="tab" id={`tab-${key}`} aria-selected={key === tab} aria-controls="panel"
            tabIndex={key === tab ? 0 : -1} onClick={() => choose(key)}
          >{word}</button>
        ))}
      </div>
      <div class={`body of-${tab}`} role="tabpanel" id="panel" aria-labelledby={`tab-${tab}`} ref={body}>{children}</div>
    </>
  );
}
