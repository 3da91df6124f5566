// A form: the kind of a thing, its parameters as fields, and the way back to what the file says.
import type { JSX } from "preact";
import { useEffect, useRef } from "preact/hooks";

import { counts } from "../../live/fields";
import type { Form } from "../../live/protocol";
import type { Session } from "../../live/session";
import { Field } from "./Field";

export function FormCard({ session, form, open, name }: { session: Session; form: Form; open?: boolean; name?: string }): JSX.Element {
  const textures = session.scene.value?.textures ?? [];
  const complaint = session.complaint.value?.about === form.id ? session.complaint.value : null;
  return (
    <div class={`form ${open ? "plain" : ""}`} data-form={form.id}>
      {form.kinds.length > 0 && (
        <div class="field kind">
          <label for={`kind-${form.id}`}>{name ?? "kind"}</label>
          <div class="entry"><select id={`kind-${form.id}`} value={form.kind ?? ""} title={form.doc} onChange={(event) => session.choose(event.currentTarget.value, form.id)}>
            {form.kind !== null && !form.kinds.includes(form.kind) && <option value={form.kind}>{form.kind}</option>}
            {form.kinds.map((kind) => <option key={kind} value={kind}>{kind}</option>)}
          </select></div><span />
        </div>
      )}
      {form.doc && form.kinds.length > 0 && <p class="note story-of">{form.doc}</p>}
      {form.params.map((param) => {
        const asked = session.asked(form.id, param.name);
        const value = asked ? asked.value ?? param.default : counts(param);
        return (
          <Field key={param.name} of={form.id} param={param} value={value} given={(asked ? asked.value : param.value) !== null} textures={textures}
            set={(to) => { session.complaint.value = null; session.set(form.id, param.name, to); }} />
        );
      })}
      {complaint && (
        <p class="wrong" role="alert">{complaint.param && <b>{complaint.param}: </b>}{complaint.message}{complaint.hint && <small> {complaint.hint}</small>}</p>
      )}
      {form.changed && <button type="button" class="undo" onClick={() => session.reset(form.id)}>As in the scene</button>}
    </div>
  );
}

/** A form that is opened when it is needed: scenes have hundreds of materials. */
export function Folded({ session, form, open, toggle }: { session: Session; form: Form; open: boolean; toggle: (open: boolean) => void }): JSX.Element {
  const card = useRef<HTMLDetailsElement>(null);
  useEffect(() => {
    if (open) card.current?.scrollIntoView({ block: "nearest" });
  }, [open]);
  return (
    <details class="folded" ref={card} open={open} onToggle={(event) => event.currentTarget.open !== open && toggle(event.currentTarget.open)}>
      <summary><b>{form.title}</b> <small>{form.kind}</small>{form.changed && <i title="changed">changed</i>}</summary>
      {open && <FormCard session={session} form={form} />}
    </details>
  );
}
