// The walk of a ray through the hierarchy, box by box, and the lecture's solution for the triangle that it hit.
import type { JSX } from "preact";

import { checks, cramer, type Matrix } from "../data/cramer";
import { num } from "../data/number";
import { HIT, MISS } from "../scene/boxes";
import type { Vec3 } from "../data/types";
import type { Store } from "../state/store";
import { Empty, RayChip, Section } from "./parts";

const ink = (color: number[]): string => `rgb(${color.map((x) => Math.round(255 * x)).join(" ")})`;

export function Walk({ store }: { store: Store }): JSX.Element {
  const node = store.node.value;
  const withWalk = store.g.value.nodes.filter((other) => (other.walk?.length ?? 0) > 0);
  return (
    <>
      <p class="lead"><RayChip store={store} id={node.id} plain /> tested {node.tests?.boxes ?? 0} boxes and {node.tests?.primitives ?? 0} primitives.</p>
      {node.walk?.length ? <Boxes store={store} /> : (
        <Empty>The boxes of this ray are not in this page. {withWalk.length > 0 && <>Those of {withWalk.slice(0, 6).map((other) => <RayChip key={other.id} store={store} id={other.id} plain />)} are.</>}</Empty>
      )}
      {node.triangle ? <Triangle store={store} /> : <p class="note">{node.point ? "What it hit is no triangle." : "It hits no triangle."}</p>}
    </>
  );
}

function Boxes({ store }: { store: Store }): JSX.Element {
  const walk = store.node.value.walk!;
  const at = store.walkStep.value ?? walk.length - 1;
  const hits = walk.filter((box) => box.hit).length;
  return (
    <Section title="Boxes" note={`in the order tested; ${hits} hit, ${walk.length - hits} missed`}>
      <input class="full" type="range" min="0" max={walk.length - 1} value={at} aria-label="Box"
        onInput={(event) => (store.walkStep.value = Number(event.currentTarget.value))} />
      <ol class="boxes">
        {walk.slice(0, 400).map((box, index) => (
          <li key={index} class={index === at ? "on" : index > at ? "later" : ""}>
            <button type="button" style={{ paddingLeft: `${8 + Math.min(box.depth, 20) * 9}px` }} onClick={() => (store.walkStep.value = index)}>
              <i style={{ background: ink(box.hit ? HIT : MISS) }} />{box.hit ? "hit" : "missed"}
              <small>{size(box.box)} m</small>
            </button>
          </li>
        ))}
      </ol>
    </Section>
  );
}

function size([a, b]: [Vec3, Vec3]): string {
  return [0, 1, 2].map((i) => num(b[i]! - a[i]!, 3)).join(" × ");
}

function Triangle({ store }: { store: Store }): JSX.Element {
  const node = store.node.value;
  const s = cramer(node.triangle!, node.origin, node.direction);
  const rows: [string, Matrix, number, number][] = [
    ["β", s.beta, s.detBeta, s.values.beta], ["γ", s.gamma, s.detGamma, s.values.gamma], ["t", s.t, s.detT, s.values.t],
  ];
  return (
    <Section title="The triangle, by Cramer’s rule">
      <p class="math"><var>a + β (b − a) + γ (c − a) = O + t D</var></p>
      <p class="math cramer"><span><var>|A|</var> =</span><Determinant of={s.a} /><span>= {num(s.detA, 5)}</span></p>
      {rows.map(([name, matrix, value, result]) => (
        <p class="math cramer" key={name}>
          <span><var>{name}</var> =</span><Determinant of={matrix} /><span>/ <var>|A|</var></span>
          <span>= {num(value, 5)} / {num(s.detA, 5)} = <b>{num(result, 6)}</b></span>
        </p>
      ))}
      <p class="math"><var>α = 1 − β − γ</var> = <b>{num(s.values.alpha, 6)}</b>{inside(s.values)}</p>
      <ul class="checks">
        {checks(node, s).map((check) => (
          <li key={check.name} class={check.agrees ? "agrees" : "differs"}><b aria-hidden="true">{check.agrees ? "✓" : "≠"}</b> <var>{check.name}</var> recorded {num(check.recorded, 7)}</li>
        ))}
      </ul>
    </Section>
  );
}

function inside({ alpha, beta, gamma }: { alpha: number; beta: number; gamma: number }): string {
  return alpha >= 0 && beta >= 0 && gamma >= 0 ? ": all three are positive, so the point is inside" : ": outside, within rounding";
}

/** Three rows between bars. */
function Determinant({ of }: { of: Matrix }): JSX.Element {
  return (
    <span class="det" role="math">
      {[0, 1, 2].map((row) => of.map((column, i) => <span key={`${row} ${i}`}>{num(column[row], 4)}</span>))}
    </span>
  );
}
