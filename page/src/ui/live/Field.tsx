// One parameter as a field: its name and story, the value, and the way back to the default.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";

import { hexOf, isTriple, numberOf, rgbOf, sliderOf, stepOf, told, typed } from "../../live/fields";
import type { Param, SceneInfo, Value } from "../../live/protocol";
import type { Rgb } from "../../data/types";

export interface FieldProps {
  param: Param;
  /** The value that counts, given or not. */
  value: Value | null;
  given: boolean;
  textures: SceneInfo["textures"];
  set: (value: Value | null) => void;
  /** Makes the field's names unique in the page. */
  of: string;
}

export function Field(props: FieldProps): JSX.Element {
  const { param, given, set, of } = props;
  const id = `${of}-${param.name}`.replace(/[^\w-]/g, "_");
  return (
    <div class={`field of-${param.type} ${given ? "given" : ""}`} data-param={param.name}>
      <label for={id} title={param.doc}>{param.name}{param.unit && <small> {param.unit}</small>}</label>
      <div class="entry">{param.editable ? <Entry {...props} id={id} /> : <span class="fixed" id={id}>{told(props.value)}</span>}</div>
      {given && param.editable
        ? <button type="button" class="back" title={`As if not given: ${told(param.default)}`} onClick={() => set(null)}>↺<span class="hidden">{param.name} as if not given</span></button>
        : <span />}
    </div>
  );
}

type Entered = FieldProps & { id: string };

function Entry(props: Entered): JSX.Element {
  const { param, value, set, id } = props;
  switch (param.type) {
    case "bool": return <input id={id} type="checkbox" checked={value === true} onChange={(event) => set(event.currentTarget.checked)} />;
    case "choice": return <Words {...props} words={param.words ?? []} />;
    case "text": case "file": return <TextBox {...props} />;
    case "color": return <Color {...props} />;
    case "color-texture": return <Textured {...props} kind="color" plain={<Color {...props} />} first={[0.5, 0.5, 0.5]} />;
    case "float-texture": return <Textured {...props} kind="float" plain={<Plain {...props} />} first={0.5} />;
    case "point3": case "vector3": return <Triple {...props} />;
    default: return <Plain {...props} />;
  }
}

function TextBox({ id, value, set }: Entered): JSX.Element {
  const draft = useSignal<string | null>(null);
  const enter = (text: string): void => {
    draft.value = null;
    set(text);
  };
  return <input id={id} type="text" value={draft.value ?? (typeof value === "string" ? value : "")} onInput={(event) => (draft.value = event.currentTarget.value)} onChange={(event) => enter(event.currentTarget.value)} />;
}

function Words({ id, value, words, set, param }: Entered & { words: string[] }): JSX.Element {
  return (
    <select id={id} value={typeof value === "string" ? value : ""} onChange={(event) => set(event.currentTarget.value)}>
      {value === null && <option value="">{param.default === null ? "as the kind decides" : "–"}</option>}
      {words.map((word) => <option key={word} value={word}>{word}</option>)}
    </select>
  );
}

/** A number, with a slider where the range has two ends. */
function Plain(props: Entered): JSX.Element {
  const { id, param, value, set } = props;
  if (value !== null && typeof value === "object" && !Array.isArray(value)) return <Other {...props} />;
  const slider = sliderOf(param);
  const at = typeof value === "number" ? value : null;
  return (
    <>
      {slider && <input type="range" {...slider} value={at ?? slider.min} aria-label={param.name}
        onInput={(event) => set(Number(event.currentTarget.value))} />}
      <NumberBox id={id} param={param} at={at} set={set} />
    </>
  );
}

function NumberBox({ id, param, at, set, label }: { id?: string; param: Param; at: number | null; set: (x: number) => void; label?: string }): JSX.Element {
  const wrong = useSignal(false);
  // What is being typed stays, whatever comes from the program meanwhile.
  const draft = useSignal<string | null>(null);
  const enter = (text: string): void => {
    const x = numberOf(text, param, param.type === "int");
    wrong.value = x === null;
    if (x === null) return;
    draft.value = null;
    if (x !== at) set(x);
  };
  const arrows = (event: KeyboardEvent): void => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault();
    draft.value = null;
    wrong.value = false;
    const now = at ?? 0;
    const to = now + (event.key === "ArrowUp" ? 1 : -1) * stepOf(param, now) * (event.shiftKey ? 10 : 1);
    set(Number(Math.min(Math.max(to, param.min ?? -Infinity), param.max ?? Infinity).toPrecision(7)));
  };
  const range = param.min !== null || param.max !== null ? `${param.min ?? "−∞"} … ${param.max ?? "∞"}` : undefined;
  return (
    <input id={id} class="number" type="text" inputMode="decimal" autocomplete="off" aria-label={label} aria-invalid={wrong.value} title={range}
      placeholder="auto" value={draft.value ?? (at === null ? "" : typed(at))} onInput={(event) => (draft.value = event.currentTarget.value)}
      onChange={(event) => enter(event.currentTarget.value)} onKeyDown={arrows} />
  );
}

function Triple({ id, param, value, set }: Entered): JSX.Element {
  const at: [number, number, number] | null = isTriple(value) ? value : null;
  return (
    <span class="triple">{[0, 1, 2].map((i) => (
      <NumberBox key={i} {...(i === 0 && { id })} param={param} at={at?.[i] ?? null} label={`${param.name} ${"xyz"[i]}`}
        set={(x) => set([0, 1, 2].map((j) => (i === j ? x : at?.[j] ?? 0)))} />
    ))}</span>
  );
}

/** Light by the browser's picker, and its three numbers. */
function Color(props: Entered): JSX.Element {
  const { id, param, value, set } = props;
  if (value !== null && !isTriple(value)) return <Other {...props} />;
  const rgb: Rgb = value ?? [0, 0, 0];
  return (
    <>
      <input id={id} type="color" value={hexOf(rgb)} onInput={(event) => set(rgbOf(event.currentTarget.value, rgb))} />
      <span class="triple">{[0, 1, 2].map((i) => (
        <NumberBox key={i} param={param} at={value === null ? null : rgb[i]!} label={`${param.name} ${["red", "green", "blue"][i]}`}
          set={(x) => set([0, 1, 2].map((j) => (i === j ? x : rgb[j]!)))} />
      ))}</span>
    </>
  );
}

/** What the file says in another way: shown, and replaced by a value if so wished. */
function Other({ param, value, set, id }: Entered): JSX.Element {
  if (value !== null && typeof value === "object" && "blackbody" in value) {
    return <span class="other">black body <NumberBox id={id} param={{ ...param, type: "float", min: 1, max: null }} at={value.blackbody} set={(x) => set({ blackbody: x })} /> K</span>;
  }
  const first: Value = param.type.startsWith("color") ? [0.5, 0.5, 0.5] : typeof param.default === "number" ? param.default : 1;
  return <span class="other" id={id}>{told(value)} <button type="button" onClick={() => set(first)}>use a {param.type.startsWith("color") ? "colour" : "number"}</button></span>;
}

/** A value, or one of the scene's textures. */
function Textured({ value, set, textures, kind, plain, first, param }: Entered & { kind: "color" | "float"; plain: JSX.Element; first: Value }): JSX.Element {
  const fit = textures.filter((texture) => texture.value === kind);
  const current = value !== null && typeof value === "object" && "texture" in value ? value.texture : null;
  if (fit.length === 0 && current === null) return plain;
  const own = param.default !== null && typeof param.default !== "string" ? param.default : first;
  return (
    <>
      <select value={current ?? ""} aria-label={`${param.name}: texture`} onChange={(event) => set(event.currentTarget.value === "" ? own : { texture: event.currentTarget.value })}>
        <option value="">{kind === "color" ? "colour" : "number"}</option>
        {current !== null && !fit.some(({ name }) => name === current) && <option value={current}>{current}</option>}
        {fit.map(({ name }) => <option key={name} value={name}>{name}</option>)}
      </select>
      {current === null && plain}
    </>
  );
}
