// Small pieces that the views are made of: swatches, chips of kinds, bars, choices.
import type { ComponentChildren, JSX } from "preact";

import { css } from "../data/color";
import { cssOf, lookOf, stopOf } from "../data/kinds";
import { ofPage } from "../data/missing";
import { triple } from "../data/number";
import type { Kind, Rgb } from "../data/types";
import type { Store } from "../state/store";

/** A patch of the colour as a screen shows it. */
export function Swatch({ rgb, label }: { rgb: Rgb; label?: string }): JSX.Element {
  return <span class="swatch" style={{ background: css(rgb) }} title={label ?? triple(rgb)} />;
}

/** A line in the colour and dash pattern of a kind. */
export function KindLine({ kind, store }: { kind: Kind; store: Store }): JSX.Element {
  const dashes = ["", "6 4", "2 3", "10 3", "7 3 2 3"];
  return (
    <svg class="kindline" width="26" height="8" aria-hidden="true">
      <line x1="1" y1="4" x2="25" y2="4" class="casing" />
      <line x1="1" y1="4" x2="25" y2="4" stroke={cssOf(kind, store.palette.value)} stroke-width="3" stroke-dasharray={dashes[lookOf(kind).dash]} />
    </svg>
  );
}

/** The letter of a ray, with its line's colour; leads to the ray. */
export function RayChip({ store, id, plain }: { store: Store; id: number; plain?: boolean }): JSX.Element {
  const g = store.g.value;
  const kind = g.nodes[id]!.kind;
  return (
    <button
      type="button" class={`chip ${store.selected.value === id && !plain ? "on" : ""}`} style={{ "--kind": cssOf(kind, store.palette.value) }}
      title={lookOf(kind).word} onClick={() => store.select(id)}
      onMouseEnter={() => (store.hovered.value = id)} onMouseLeave={() => (store.hovered.value = null)}
    >
      <i />{g.letters[id]}
    </button>
  );
}

export function StopBadge({ stop, brief }: { stop: string; brief?: boolean }): JSX.Element {
  const { sign, word, says } = stopOf(stop);
  return <span class="badge" title={says}><b aria-hidden="true">{sign}</b>{brief ? <span class="hidden">{word}</span> : word}</span>;
}

/** A bar for a share of 0..1; negative shares are hatched. */
export function Bar({ share, color, label }: { share: number; color?: string; label?: string }): JSX.Element {
  const width = `${Math.min(Math.abs(share), 1) * 100}%`;
  return (
    <span class={`bar ${share < 0 ? "below" : ""}`} title={label}>
      <i style={{ width, ...(color && { background: color }) }} />
    </span>
  );
}

/** One of a few words. */
export function Choice<T extends string>(props: {
  label: string; value: T; options: [T, string][]; onChange: (value: T) => void;
}): JSX.Element {
  const { label, value, options, onChange } = props;
  return (
    <span class="choice" role="group" aria-label={label}>
      {options.map(([key, word]) => (
        <button key={key} type="button" aria-pressed={key === value} onClick={() => onChange(key)}>{word}</button>
      ))}
    </span>
  );
}

export function Section({ title, note, children }: { title: string; note?: string; children: ComponentChildren }): JSX.Element {
  return (
    <section class="section">
      <h3>{title}{note && <small> {note}</small>}</h3>
      {children}
    </section>
  );
}

/** What of the rays is not in this page, and how to get all. */
export function LeftOutNote({ store }: { store: Store }): JSX.Element | null {
  const said = ofPage(store.page, store.g.value.tree);
  if (said.length === 0) return null;
  const [first, ...rest] = said;
  return (
    <details class="left-out">
      <summary>{first}</summary>
      {rest.map((sentence) => <p key={sentence}>{sentence}</p>)}
    </details>
  );
}

export function Empty({ children }: { children: ComponentChildren }): JSX.Element {
  return <p class="empty">{children}</p>;
}
