// Give a named thing of a design another name, everywhere the text speaks of it.

export type Named =
  | "bodies"
  | "objects"
  | "parameters"
  | "shapes"
  | "materials"
  | "histories"
  | "chambers"
  | "probes"
  | "objectives"
  | "constraints";

/** Lists whose entries hold their names, in place of keys before their tables. */
const THINGS: ReadonlySet<Named> = new Set(["bodies", "objects"]);

export const NAME = /^[A-Za-z_][\w-]*$/;

function escaped(text: string): string {
  return text.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
}

/** Split a line into its code and its comment. */
function splitComment(line: string): [string, string] {
  let quote = "";
  for (let i = 0; i < line.length; i++) {
    const letter = line[i] ?? "";
    if (quote) {
      if (letter === "\\" && quote === '"') i++;
      else if (letter === quote) quote = "";
    } else if (letter === '"' || letter === "'") quote = letter;
    else if (letter === "#") return [line.slice(0, i), line.slice(i)];
  }
  return [line, ""];
}

/** The key itself, where its section defines it. */
function redefine(
  code: string,
  inSection: boolean,
  section: Named,
  from: string,
  to: string,
): string {
  const header = new RegExp(`^(\\s*\\[\\s*${section}\\s*\\.\\s*)"?${escaped(from)}"?(\\s*[\\].])`);
  if (header.test(code)) return code.replace(header, `$1${to}$2`);
  if (!inSection) return code;
  return code.replace(new RegExp(`^(\\s*)"?${escaped(from)}"?(\\s*[=.])`), `$1${to}$2`);
}

/** Mentions of the name in texts: whole texts name things, formulas name parameters. */
function mention(code: string, section: Named, from: string, to: string): string {
  return code.replace(/"((?:\\.|[^"\\])*)"|'([^']*)'/g, (whole, double, single) => {
    const text: string = double ?? single ?? "";
    const quote = whole[0];
    if (section === "parameters") {
      if (!text.trimStart().startsWith("=")) return whole;
      // A name after a number is its unit, also where a parameter has the same name.
      const word = new RegExp(
        `(?<![\\w-])(?<!(?<![\\w-])[\\d.]+\\s*)${escaped(from)}(?![\\w-])`,
        "g",
      );
      return `${quote}${text.replace(word, to)}${quote}`;
    }
    // Names in a body begin with its name: left.tip.
    if (section === "bodies" && text.startsWith(`${from}.`))
      return `${quote}${to}${text.slice(from.length)}${quote}`;
    return text === from ? `${quote}${to}${quote}` : whole;
  });
}

// Lines that refer to names: a probe called like a shape must not rename the shape.
const SPEAKS: Readonly<Record<Named, RegExp | null>> = {
  bodies: /\b(?:body|object|cavity|probe)\s*=/,
  objects: /\bobject\s*=/,
  parameters: /./,
  shapes: /\b(?:of|shape|by|base|inner|outer)\s*=/,
  materials: /\bmaterial\s*=/,
  histories: /\bhistory\s*=/,
  chambers: /\bcavity\s*=/,
  probes: /\bprobe\s*=/,
  objectives: null,
  constraints: null,
};

/** The text with one thing renamed; its comments and its layout stay. */
export function renamed(text: string, section: Named, from: string, to: string): string {
  let current = "";
  const lines = text.split("\n").map((line) => {
    const [code, comment] = splitComment(line);
    const header = /^\s*\[\[?\s*([\w-]+)/.exec(code);
    if (header) current = header[1] ?? "";
    let next = THINGS.has(section)
      ? code
      : redefine(code, current === section && !header, section, from, to);
    const things = THINGS.has(section);
    // Names of bodies and objects stand in entries of their own, and in pairs of contact.
    const named = things && current === section && /^\s*name\s*=/.test(next);
    const paired = things && current === "contact";
    if (named || paired || SPEAKS[section]?.test(next)) next = mention(next, section, from, to);
    return next + comment;
  });
  return lines.join("\n");
}
