// Place in a design of a position of its text: a tolerant reader of TOML that stops there, so that
// completion and help work while the text is not yet right.

export type Step = string | number;

export interface Place {
  readonly at: "key" | "value" | "header" | "comment";
  /** Path of the table for a key, of the value itself for a value. */
  readonly path: readonly Step[];
  /** Begin of the word under the position. */
  readonly from: number;
  /** The word up to the position. */
  readonly word: string;
  readonly quoted: boolean;
  /** Content of the text so far, as far as it was read: tables and texts. */
  readonly read: Readonly<Record<string, unknown>>;
}

interface Frame {
  readonly is: "table" | "array";
  readonly path: readonly Step[];
  key: readonly string[];
  index: number;
  expects: "key" | "value";
}

type Loose = Record<Step, unknown>;

function put(root: Loose, path: readonly Step[], value: unknown): void {
  let here = root;
  for (const step of path.slice(0, -1)) {
    if (typeof here[step] !== "object" || here[step] === null) here[step] = {};
    here = here[step] as Loose;
  }
  const last = path.at(-1);
  if (last !== undefined) here[last] = value;
}

function names(key: string): string[] {
  return key
    .split(".")
    .map((part) => part.trim().replaceAll(/^["']|["']$/g, ""))
    .filter((part) => part !== "");
}

const WORD = /[\w+-]/;

/** Read a text up to a position. */
export function placeAt(text: string, position: number): Place {
  const read: Loose = {};
  const counts = new Map<string, number>();
  let stack: Frame[] = [{ is: "table", path: [], key: [], index: 0, expects: "key" }];
  let word = "";
  let from = 0;
  const top = (): Frame => stack.at(-1) as Frame;
  const pathOf = (frame: Frame): Step[] =>
    frame.is === "array" ? [...frame.path, frame.index] : [...frame.path, ...frame.key];
  const done = (at: Place["at"], quoted = false, start = from, typed = word): Place => {
    const frame = top();
    const path = at === "value" ? pathOf(frame) : frame.path;
    return { at, path, from: start, word: typed, quoted, read };
  };
  let i = 0;
  while (i < position) {
    const letter = text[i] ?? "";
    const frame = top();
    if (letter === "#") {
      const end = text.indexOf("\n", i);
      if (end < 0 || end >= position) return done("comment");
      i = end;
      continue;
    }
    if (letter === '"' || letter === "'") {
      const start = i + 1;
      let end = start;
      while (end < text.length && text[end] !== letter && text[end] !== "\n") {
        end += text[end] === "\\" && letter === '"' ? 2 : 1;
      }
      if (end >= position) return done(frame.expects, true, start, text.slice(start, position));
      const content = text.slice(start, end);
      if (frame.expects === "key") word = content;
      else put(read, pathOf(frame), content);
      i = end + 1;
      continue;
    }
    if (letter === "[" && frame.expects === "key" && stack.length === 1) {
      const end = text.slice(i).search(/[\]\n]/);
      const close = end < 0 ? text.length : i + end;
      const start = text[i + 1] === "[" ? i + 2 : i + 1;
      if (close >= position) return done("header", false, start, text.slice(start, position));
      const path: Step[] = names(text.slice(start, close));
      if (text[i + 1] === "[") {
        const key = path.join(".");
        const count = counts.get(key) ?? 0;
        counts.set(key, count + 1);
        path.push(count);
      }
      put(read, path, {});
      stack = [{ is: "table", path, key: [], index: 0, expects: "key" }];
      i = text[close + 1] === "]" ? close + 2 : close + 1;
      word = "";
      continue;
    }
    if (WORD.test(letter) || (letter === "." && frame.expects === "key")) {
      if (word === "") from = i;
      word += letter;
      i++;
      continue;
    }
    if (letter === "=") {
      frame.key = names(word);
      frame.expects = "value";
    } else if (letter === "{") {
      stack.push({ is: "table", path: pathOf(frame), key: [], index: 0, expects: "key" });
    } else if (letter === "[") {
      stack.push({ is: "array", path: pathOf(frame), key: [], index: 0, expects: "value" });
    } else if ((letter === "}" || letter === "]") && stack.length > 1) {
      stack.pop();
    } else if (letter === ",") {
      if (frame.is === "array") frame.index++;
      else if (stack.length > 1) frame.expects = "key";
    } else if (letter === "\n" && stack.length === 1) {
      frame.expects = "key";
      frame.key = [];
    }
    // A blank behind a key may come before its equals sign.
    if (letter !== " " || frame.expects !== "key" || !/^\s*=/.test(text.slice(i))) word = "";
    i++;
  }
  if (word === "") from = position;
  return done(top().expects);
}
