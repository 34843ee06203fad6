// The text of the design: the same document as the form, with its errors at their lines.
import type { EditorView } from "@codemirror/view";
import { useEffect, useRef, useState } from "react";
import { Empty } from "../../../controls/Choice";
import { send } from "../../../store/session";
import { useStudio } from "../../../store/studio";
import { provideTyping } from "../../../store/typing";
import { makeEditor, showDiagnostics, showText } from "./editor";
import "./text.css";

/** Pause in typing before the text is tried, ms; Ctrl+Enter does not wait. */
const REST = 700;
/** Longest wait for the answer to a sent text before another text is shown, ms. */
const ANSWER = 1500;

export default function TextPane() {
  const there = useStudio((state) => state.document !== null);
  if (!there) {
    return (
      <Empty title="No text yet">
        <p>Open a template or a design file; its text can be changed here.</p>
      </Empty>
    );
  }
  return <Text />;
}

function Text() {
  const document = useStudio((state) => state.document);
  const box = useRef<HTMLDivElement>(null);
  const view = useRef<EditorView | null>(null);
  // Typed text that was not yet sent.
  const pending = useRef<string | null>(null);
  const sent = useRef<{ text: string; at: number } | null>(null);
  const shown = useRef<typeof document>(null);
  const [, lookAgain] = useState(0);
  const timer = useRef<ReturnType<typeof setTimeout> | null>(null);
  const [waiting, setWaiting] = useState(false);

  useEffect(() => {
    if (!box.current) return;
    const flush = () => {
      if (timer.current !== null) clearTimeout(timer.current);
      timer.current = null;
      const text = pending.current;
      if (text === null) return;
      pending.current = null;
      sent.current = { text, at: performance.now() };
      setWaiting(false);
      const rev = useStudio.getState().document?.rev ?? 0;
      send({ t: "text", rev, text });
    };
    const made = makeEditor(box.current, useStudio.getState().document?.text ?? "", {
      hello: () => useStudio.getState().hello,
      typed(text) {
        pending.current = text;
        setWaiting(true);
        if (timer.current !== null) clearTimeout(timer.current);
        timer.current = setTimeout(flush, REST);
      },
      apply: flush,
      undo: () => send({ t: "undo" }),
      redo: () => send({ t: "redo" }),
    });
    view.current = made;
    showDiagnostics(made, useStudio.getState().document?.diagnostics ?? []);
    const forget = provideTyping({
      flush() {
        flush();
        // Something else is asked now, and its answer is to be shown.
        sent.current = null;
      },
    });
    return () => {
      flush();
      forget();
      made.destroy();
      view.current = null;
    };
  }, []);

  useEffect(() => {
    if (!view.current || !document || document === shown.current) return;
    // Text typed just now is newer than this answer.
    if (pending.current !== null) return;
    const asked = sent.current;
    if (asked && document.text !== asked.text) {
      const left = asked.at + ANSWER - performance.now();
      if (left > 0) {
        // An answer to an earlier text: that to the newest text is still to come.
        const later = setTimeout(() => lookAgain((n) => n + 1), left);
        return () => clearTimeout(later);
      }
    }
    sent.current = null;
    shown.current = document;
    showText(view.current, document.text);
    showDiagnostics(view.current, document.diagnostics);
  });

  const wrong = document?.diagnostics.filter((one) => one.severity === "error").length ?? 0;
  return (
    <div className="text-pane" data-testid="text-editor">
      <div className="text-box" ref={box} />
      <div className="text-foot" role="status">
        {waiting ? (
          <span>
            <kbd>Ctrl</kbd> <kbd>Enter</kbd> applies at once
          </span>
        ) : wrong > 0 ? (
          <span className="bad">
            {wrong === 1 ? "1 error" : `${wrong} errors`}; the view shows the last good design
          </span>
        ) : (
          <span className="muted">applied</span>
        )}
      </div>
    </div>
  );
}
