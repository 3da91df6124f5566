// What went wrong, above the picture: the scene that could not be read again, the connection that broke, an order refused.
import { useSignal } from "@preact/signals";
import type { JSX } from "preact";
import { useEffect } from "preact/hooks";

import type { Live } from "../../live/live";

export function Banners({ live }: { live: Live }): JSX.Element {
  const { main } = live;
  const status = main.status.value;
  const complaint = main.complaint.value;
  // Those about a form stand at the form.
  const general = complaint && !main.forms.value.has(complaint.about) ? complaint : null;
  return (
    <div class="banners">
      {status?.state === "error" && (
        <div class="banner bad" role="alert" data-about="scene">
          <p><b>The scene cannot be shown as it is now; the picture is the one before.</b></p>
          <pre>{status.message}</pre>
        </div>
      )}
      {general && (
        <div class="banner bad" role="alert" data-about={general.about}>
          <p>{general.message}{general.hint && <small> {general.hint}</small>}</p>
          <button type="button" onClick={() => (main.complaint.value = null)}>Close</button>
        </div>
      )}
      <Connection live={live} />
    </div>
  );
}

function Connection({ live }: { live: Live }): JSX.Element | null {
  const { link } = live.main;
  const state = link.state.value;
  const now = useSignal(Date.now());
  useEffect(() => {
    if (state.is !== "lost") return undefined;
    const timer = setInterval(() => (now.value = Date.now()), 250);
    return () => clearInterval(timer);
  }, [state.is]);
  if (state.is === "stopped") return <div class="banner bad" role="alert" data-about="version"><p>{state.why}</p></div>;
  // A break that is mended at once is not worth a word.
  if (state.is !== "lost" || state.tries < 2) return null;
  const seconds = Math.max(0, Math.ceil((state.at - now.value) / 1000));
  return (
    <div class="banner" role="status" data-about="connection">
      <p><b>No connection to durer.</b> If it was stopped, start it again; {seconds > 0 ? `trying again in ${seconds} s.` : "trying …"}</p>
      <button type="button" onClick={() => link.retry()}>Try now</button>
    </div>
  );
}
