// The samples of the pixel: their colours, how their values spread, which lie far out, and where they were taken.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { css, luminance } from "../data/color";
import { dimensions, type Dimension } from "../data/dimensions";
import { convergence, histogram } from "../data/histogram";
import { num } from "../data/number";
import type { Store } from "../state/store";
import { Empty, Section, Swatch } from "./parts";

export function Samples({ store }: { store: Store }): JSX.Element {
  const { values } = store.page;
  if (values.length < 2) return <Empty>This pixel has one sample. With --spp there are more.</Empty>;
  const inPage = new Map(store.page.trees.map((tree, index) => [tree.sample, index]));
  const current = store.g.value.tree.sample;
  const choose = (sample: number): void => {
    const index = inPage.get(sample);
    if (index !== undefined) store.chooseTree(index);
    else store.ask.value?.(sample);
  };
  // Where there is somebody to ask, all samples can be had.
  const recorded = store.ask.value ? new Map(values.map((_, sample) => [sample, sample])) : inPage;
  const mean = store.page.mean;
  return (
    <>
      <p class="lead"><Swatch rgb={mean} /> The pixel is the mean of {values.length} samples: {mean.map((x) => num(x, 3)).join("  ")}</p>
      <Strip values={values} current={current} recorded={recorded} choose={choose} />
      <Histogram store={store} current={current} recorded={recorded} choose={choose} />
      <Convergence values={values} current={current} />
      <Scatter store={store} current={current} recorded={recorded} choose={choose} />
      {recorded.size < values.length && <p class="note">The rays of {recorded.size} of the samples are in this page.</p>}
    </>
  );
}

interface Choosing { current: number; recorded: Map<number, number>; choose: (sample: number) => void }

function Strip({ values, current, recorded, choose }: { values: Store["page"]["values"] } & Choosing): JSX.Element {
  return (
    <div class="strip" role="group" aria-label="Samples">
      {values.slice(0, 1024).map((value, sample) => (
        <button key={sample} type="button" class={sample === current ? "on" : ""} disabled={!recorded.has(sample)}
          style={{ background: css(value) }} title={`sample ${sample}: ${value.map((x) => num(x, 3)).join("  ")}`} onClick={() => choose(sample)}>
          <span class="hidden">sample {sample}</span>
        </button>
      ))}
    </div>
  );
}

const [W, H] = [320, 110];

function Histogram({ store, current, recorded, choose }: { store: Store } & Choosing): JSX.Element {
  const { values } = store.page;
  const h = histogram(values, Math.min(40, Math.max(8, Math.ceil(Math.sqrt(values.length) * 2))));
  const most = Math.max(...h.bins.map((bin) => bin.length), 1);
  const x = (light: number): number => (h.to > h.from ? ((light - h.from) / (h.to - h.from)) * W : W / 2);
  const step = W / h.bins.length;
  const drag = (event: PointerEvent): void => {
    if (event.type === "pointermove" && event.buttons === 0) return;
    const box = (event.currentTarget as Element).getBoundingClientRect();
    const light = h.from + ((event.clientX - box.left) / box.width) * (h.to - h.from);
    const near = [...recorded.keys()].filter((s) => values[s]).sort((a, b) => Math.abs(luminance(values[a]!) - light) - Math.abs(luminance(values[b]!) - light));
    if (near[0] !== undefined) choose(near[0]);
  };
  const mine = values[current];
  return (
    <Section title="Values" note="by luminance; drag to a sample">
      <svg class="plot drag" viewBox={`0 -14 ${W} ${H + 32}`} role="img" onPointerDown={drag} onPointerMove={drag}
        aria-label={`Histogram of ${values.length} samples from ${num(h.from)} to ${num(h.to)}; ${h.outliers.size} outliers`}>
        {h.bins.map((bin, i) => bin.length > 0 && (
          <rect key={i} x={i * step + 0.5} width={Math.max(step - 1, 0.6)} y={H - (bin.length / most) * (H - 6)} height={(bin.length / most) * (H - 6)}
            class={bin.every((s) => h.outliers.has(s)) ? "out" : bin.includes(current) ? "on" : "in"} />
        ))}
        <line x1="0" x2={W} y1={H} y2={H} class="axis" />
        <line x1={x(h.mean)} x2={x(h.mean)} y1="-4" y2={H} class="mean" />
        {mine && <path d={`M${x(luminance(mine))} ${H + 1}l-4 7h8z`} class="here" />}
        <text x="0" y={H + 16}>{num(h.from, 3)}</text><text x={W} y={H + 16} text-anchor="end">{num(h.to, 3)}</text>
        <text x={Math.min(Math.max(x(h.mean), 34), W - 34)} y="-6" text-anchor="middle">mean {num(h.mean, 3)}</text>
      </svg>
      <p class="note">Standard deviation {num(h.deviation, 3)}. {h.outliers.size > 0 ? <Outliers list={[...h.outliers]} choose={choose} recorded={recorded} /> : "No sample lies far out."}</p>
    </Section>
  );
}

function Outliers({ list, choose, recorded }: { list: number[]; choose: (sample: number) => void; recorded: Map<number, number> }): JSX.Element {
  return (
    <span class="outliers">Far out: {list.slice(0, 12).map((sample) => (
      <button key={sample} type="button" disabled={!recorded.has(sample)} onClick={() => choose(sample)}>{sample}</button>
    ))}{list.length > 12 && ` and ${list.length - 12} more`}</span>
  );
}

function Convergence({ values, current }: { values: Store["page"]["values"]; current: number }): JSX.Element {
  const curve = convergence(values);
  const most = Math.max(...curve.map((p) => p.mean + p.error), 1e-12);
  const least = Math.min(...curve.map((p) => p.mean - p.error), 0);
  const x = (i: number): number => (i / Math.max(curve.length - 1, 1)) * W;
  const y = (v: number): number => H - ((v - least) / (most - least || 1)) * H;
  const band = [...curve.map((p, i) => `${x(i)},${y(p.mean + p.error)}`), ...curve.map((p, i) => `${x(i)},${y(p.mean - p.error)}`).reverse()].join(" ");
  const last = curve[curve.length - 1]!;
  return (
    <Section title="Convergence" note="mean of the first n samples, 95 % interval">
      <svg class="plot" viewBox={`0 -4 ${W} ${H + 20}`} role="img" aria-label={`Mean ${num(last.mean)} ± ${num(last.error)}`}>
        <polygon points={band} class="band" />
        <polyline points={curve.map((p, i) => `${x(i)},${y(p.mean)}`).join(" ")} class="curve" />
        {curve[current] && <circle cx={x(current)} cy={y(curve[current]!.mean)} r="3.5" class="here" />}
        <line x1="0" x2={W} y1={H} y2={H} class="axis" />
        <text x="0" y={H + 14}>1</text><text x={W} y={H + 14} text-anchor="end">{curve.length}</text>
        <text x={W / 2} y={H + 14} text-anchor="middle">{num(last.mean, 3)} ± {num(last.error, 2)}</text>
      </svg>
    </Section>
  );
}

function Scatter({ store, current, recorded, choose }: { store: Store } & Choosing): JSX.Element | null {
  const all = dimensions(store.page);
  const [across, up] = [useSignal(0), useSignal(1)];
  if (all.length < 2) return null;
  const [a, b] = [all[across.value % all.length]!, all[up.value % all.length]!];
  const size = 220;
  const place = (d: Dimension, v: number): number => (d.to > d.from ? (v - d.from) / (d.to - d.from) : 0.5) * (size - 16) + 8;
  const samples = [...a.values.keys()].filter((sample) => b.values.has(sample));
  const pick = (label: string, value: number, set: (v: number) => void): JSX.Element => (
    <label>{label} <select value={value} onChange={(event) => set(Number(event.currentTarget.value))}>
      {all.map((d, i) => <option key={d.name} value={i}>{d.name}</option>)}
    </select></label>
  );
  const lines = Math.round(Math.sqrt(samples.length));
  return (
    <Section title="Where they were taken" note="two dimensions of the samples">
      <div class="rowed">{pick("across", across.value, (v) => (across.value = v))}{pick("up", up.value, (v) => (up.value = v))}</div>
      <svg class="plot square" viewBox={`0 0 ${size} ${size}`} role="group" aria-label={`${a.name} against ${b.name}`}>
        <rect x="8" y="8" width={size - 16} height={size - 16} class="frame" />
        {Array.from({ length: Math.max(0, lines - 1) }, (_, i) => 8 + ((i + 1) * (size - 16)) / lines).map((at) => (
          <path key={at} d={`M${at} 8V${size - 8}M8 ${at}H${size - 8}`} class="grid" />
        ))}
        {samples.slice(0, 4096).map((sample) => (
          <circle key={sample} cx={place(a, a.values.get(sample)!)} cy={size - place(b, b.values.get(sample)!)} r={sample === current ? 5 : 3}
            fill={css(store.page.values[sample] ?? [0.5, 0.5, 0.5])} class={sample === current ? "dot on" : "dot"}
            onClick={() => recorded.has(sample) && choose(sample)}><title>sample {sample}</title></circle>
        ))}
      </svg>
    </Section>
  );
}
