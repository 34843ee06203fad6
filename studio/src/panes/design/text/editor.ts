// The editor of the design's text: CodeMirror with TOML colors, completion, help and errors.
import {
  autocompletion,
  closeBrackets,
  closeBracketsKeymap,
  completionKeymap,
} from "@codemirror/autocomplete";
import { defaultKeymap, indentWithTab } from "@codemirror/commands";
import {
  bracketMatching,
  HighlightStyle,
  indentOnInput,
  StreamLanguage,
  syntaxHighlighting,
} from "@codemirror/language";
import { toml } from "@codemirror/legacy-modes/mode/toml";
import { lintGutter, lintKeymap, type Diagnostic as Mark, setDiagnostics } from "@codemirror/lint";
import { highlightSelectionMatches, searchKeymap } from "@codemirror/search";
import { Annotation, EditorState, Prec } from "@codemirror/state";
import {
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  hoverTooltip,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Diagnostic, HelloEvent } from "../../../protocol";
import { completions, helpAt } from "./complete";

/** Changes that came from the document and not from the keyboard. */
const fromDocument = Annotation.define<boolean>();

const colors = HighlightStyle.define([
  { tag: tags.comment, color: "var(--faint)", fontStyle: "italic" },
  { tag: tags.string, color: "var(--series-3)" },
  { tag: tags.number, color: "var(--series-1)" },
  { tag: [tags.bool, tags.atom], color: "var(--series-4)" },
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--series-2)" },
  { tag: tags.bracket, color: "var(--muted)" },
]);

const looks = EditorView.theme({
  "&": { height: "100%", backgroundColor: "var(--panel)", color: "var(--text)" },
  "&.cm-focused": { outline: "none" },
  ".cm-scroller": { fontFamily: "var(--mono)", fontSize: "12.5px", lineHeight: "1.55" },
  ".cm-content": { caretColor: "var(--accent)", padding: "6px 0" },
  ".cm-cursor": { borderLeftColor: "var(--accent)", borderLeftWidth: "2px" },
  ".cm-gutters": {
    border: "none",
    backgroundColor: "var(--panel)",
    color: "var(--faint)",
  },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "var(--raised)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground":
    { background: "var(--accent-soft)" },
  ".cm-selectionMatch": { backgroundColor: "var(--hover)" },
  "&.cm-focused .cm-matchingBracket": { backgroundColor: "var(--hover)", color: "inherit" },
  ".cm-tooltip": {
    maxWidth: "420px",
    border: "1px solid var(--line-strong)",
    borderRadius: "6px",
    backgroundColor: "var(--raised)",
    color: "var(--text)",
    boxShadow: "var(--shadow)",
  },
  ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono)", fontSize: "12px" },
  ".cm-tooltip.cm-tooltip-autocomplete > ul > li[aria-selected]": {
    backgroundColor: "var(--accent-soft)",
    color: "var(--text)",
  },
  ".cm-completionDetail": { color: "var(--muted)", fontStyle: "normal" },
  ".cm-completionInfo": { maxWidth: "320px", padding: "6px 10px" },
  ".cm-diagnostic": { padding: "6px 10px", fontFamily: "var(--font)", fontSize: "12.5px" },
  ".cm-diagnostic-error": { borderLeftColor: "var(--bad)" },
  ".cm-diagnostic-warning": { borderLeftColor: "var(--warn)" },
  ".cm-lintRange-error": {
    backgroundImage: "none",
    textDecoration: "underline wavy var(--bad)",
    textUnderlineOffset: "3px",
  },
  ".cm-lintRange-warning": {
    backgroundImage: "none",
    textDecoration: "underline wavy var(--warn)",
    textUnderlineOffset: "3px",
  },
  ".cm-panels": { backgroundColor: "var(--raised)", color: "var(--text)" },
  ".cm-textfield": {
    border: "1px solid var(--line)",
    borderRadius: "4px",
    backgroundColor: "var(--ground)",
    color: "var(--text)",
  },
  ".cm-button": {
    border: "1px solid var(--line)",
    borderRadius: "4px",
    backgroundImage: "none",
    backgroundColor: "var(--hover)",
    color: "var(--text)",
  },
});

export interface EditorHooks {
  hello(): HelloEvent | null;
  /** The user has typed. */
  typed(text: string): void;
  /** The user wants it applied now. */
  apply(): void;
  undo(): void;
  redo(): void;
}

export function makeEditor(parent: HTMLElement, text: string, hooks: EditorHooks): EditorView {
  const run = (action: () => void) => () => {
    action();
    return true;
  };
  return new EditorView({
    parent,
    state: EditorState.create({
      doc: text,
      extensions: [
        Prec.highest(
          keymap.of([
            { key: "Mod-Enter", run: run(hooks.apply) },
            { key: "Mod-z", run: run(hooks.undo) },
            { key: "Mod-y", run: run(hooks.redo) },
            { key: "Mod-Shift-z", run: run(hooks.redo) },
          ]),
        ),
        lineNumbers(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        drawSelection(),
        EditorView.lineWrapping,
        indentOnInput(),
        bracketMatching(),
        closeBrackets(),
        highlightSelectionMatches(),
        StreamLanguage.define(toml),
        syntaxHighlighting(colors),
        autocompletion({ override: [completions(hooks.hello)], icons: false }),
        hoverTooltip((view, position) => {
          const hello = hooks.hello();
          const help = hello && helpAt(hello, view.state.doc.toString(), position);
          if (!help) return null;
          return {
            pos: help.from,
            end: help.to,
            above: true,
            create: () => ({ dom: helpBox(help.title, help.text) }),
          };
        }),
        lintGutter(),
        keymap.of([
          ...closeBracketsKeymap,
          ...completionKeymap,
          ...searchKeymap,
          ...lintKeymap,
          ...defaultKeymap,
          indentWithTab,
        ]),
        // The edited text takes the focus anyway; audits of scrolled regions look for the number.
        EditorView.contentAttributes.of({ "aria-label": "Text of the design", tabindex: "0" }),
        EditorView.updateListener.of((update) => {
          const remote = update.transactions.some((one) => one.annotation(fromDocument));
          if (update.docChanged && !remote) hooks.typed(update.state.doc.toString());
        }),
        looks,
      ],
    }),
  });
}

function helpBox(title: string, text: string): HTMLElement {
  const box = document.createElement("div");
  box.className = "text-help";
  const head = document.createElement("strong");
  head.textContent = title;
  const body = document.createElement("p");
  body.textContent = text;
  box.append(head, body);
  return box;
}

/** The one stretch in which two texts differ, so that the cursor keeps its place. */
export function difference(
  before: string,
  after: string,
): { from: number; to: number; insert: string } {
  const most = Math.min(before.length, after.length);
  let from = 0;
  while (from < most && before[from] === after[from]) from++;
  let same = 0;
  while (
    same < most - from &&
    before[before.length - 1 - same] === after[after.length - 1 - same]
  ) {
    same++;
  }
  return { from, to: before.length - same, insert: after.slice(from, after.length - same) };
}

/** Show another text, keeping cursor and scroll. */
export function showText(view: EditorView, text: string): void {
  const before = view.state.doc.toString();
  if (before === text) return;
  view.dispatch({ changes: difference(before, text), annotations: fromDocument.of(true) });
}

/** Underline errors, at their places. */
export function showDiagnostics(view: EditorView, diagnostics: readonly Diagnostic[]): void {
  const { doc } = view.state;
  const marks = diagnostics.map((one): Mark => {
    const line = doc.line(Math.min(Math.max(one.line, 1), doc.lines));
    const blank = /^\s*/.exec(line.text)?.[0].length ?? 0;
    const start =
      one.column > 0 ? Math.min(line.from + one.column - 1, line.to) : line.from + blank;
    const end = one.end_column > 0 ? Math.min(line.from + one.end_column - 1, line.to) : line.to;
    return {
      from: start,
      to: Math.max(end, start),
      severity: one.severity === "note" ? "info" : one.severity,
      message: [one.where && `${one.where}: `, one.what, one.hint && `. Try: ${one.hint}`]
        .filter(Boolean)
        .join(""),
    };
  });
  view.dispatch(setDiagnostics(view.state, marks));
}
