import { useLayoutEffect, useState } from "react";
import { Button } from "../controls/Choice";
import { dismiss, useStudio } from "../store/studio";
import { Icon } from "./icons";
import { type ToastPlace, toastPlaceNow } from "./toastPlace";

/** Messages that go away by themselves. */
export function Toasts() {
  const toasts = useStudio((state) => state.toasts);
  const place = usePlace(toasts.length > 0);
  return (
    <div className="toasts" aria-live="polite" style={place ? { ...place, transform: "none" } : {}}>
      {toasts.map((toast) => (
        <div key={toast.id} className={`toast ${toast.level}`} data-testid="toast">
          <div>
            <strong>{toast.what}</strong>
            {toast.hint && <p>{toast.hint}</p>}
          </div>
          {toast.action && (
            <Button
              onClick={() => {
                toast.action?.run();
                dismiss(toast.id);
              }}
            >
              {toast.action.label}
            </Button>
          )}
          <Button icon kind="quiet" label="Close" onClick={() => dismiss(toast.id)}>
            <Icon name="close" />
          </Button>
        </div>
      ))}
    </div>
  );
}

/** Place of messages, as long as there are any: panes may be moved under them at any time. */
function usePlace(needed: boolean): ToastPlace | null {
  const [place, setPlace] = useState<ToastPlace | null>(null);
  useLayoutEffect(() => {
    if (!needed) return;
    let asked = 0;
    const look = () => {
      const now = toastPlaceNow();
      setPlace((before) => (JSON.stringify(before) === JSON.stringify(now) ? before : now));
      asked = requestAnimationFrame(look);
    };
    look();
    return () => cancelAnimationFrame(asked);
  }, [needed]);
  return place;
}
