// Formulas as VoxSoft reads them (python/voxsoft/design/formula.py has the grammar), so that a field
// can report errors at once; tests/unit/design/formulas.json holds both readers to the same cases.
import {
  type Dimension,
  describeDimension,
  PLAIN,
  sameDimension,
  timesDimension,
} from "./dimension";
import { COMMON_UNITS, canonical, plainExponents, unitOf } from "./unitTable";

/** A number in SI with its dimension. */
export interface Amount {
  readonly value: number;
  readonly dimension: Dimension;
}

/** Values of parameters by name; null for one that the page knows by its name alone. */
export type Amounts = Readonly<Record<string, Amount | null>>;

export interface Problem {
  readonly problem: string;
  /** The page knows too little to tell, a unit for instance; VoxSoft may know more. */
  readonly unsure?: boolean;
}

export type Evaluated = Amount | Problem;

export const NO_PARAMETERS: Amounts = {};

const LONGEST = 500;
const DEEPEST = 40;
const TOKEN =
  /\s*((?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,3})?|[A-Za-z_µμ°%][A-Za-z0-9_µμ]*|[-+*/(),^])/y;
const NAME = /^[A-Za-z_µμ°%]/;

class Refusal extends Error {
  constructor(
    message: string,
    readonly unsure = false,
  ) {
    super(message);
  }
}

/** Work a formula out, with its leading `=` or without. */
export function evaluate(formula: string, parameters: Amounts = NO_PARAMETERS): Evaluated {
  try {
    return new Reader(formula, parameters).read();
  } catch (error) {
    if (!(error instanceof Refusal)) throw error;
    return { problem: error.message, ...(error.unsure && { unsure: true }) };
  }
}

/** Check if a text names a parameter, so that it is a formula even without its `=`. */
function namesParameter(text: string, parameters: Amounts): boolean {
  return (text.match(/[A-Za-z_]\w*/g) ?? []).some((name) => Object.hasOwn(parameters, name));
}

/**
 * Read typed text as a formula of a design file, or give its error; null where it is none.
 * `due` is the dimension of its place.
 */
export function writtenFormula(
  typed: string,
  due: Dimension,
  parameters: Amounts,
): { readonly formula: string } | Problem | null {
  const text = typed.trim().replaceAll("−", "-");
  if (!text.startsWith("=") && !namesParameter(text, parameters)) return null;
  const body = text.replace(/^=/, "").trim();
  if (body === "") return { problem: "expected a formula after the =" };
  const read = evaluate(body, parameters);
  if ("problem" in read) return read.unsure ? { formula: `= ${body}` } : read;
  const zero = read.value === 0 && sameDimension(read.dimension, PLAIN);
  if (!zero && !sameDimension(read.dimension, due)) {
    const [came, wanted] = [read.dimension, due].map(describeDimension);
    return { problem: `the formula gives ${came}; expected ${wanted}` };
  }
  return { formula: `= ${body}` };
}

/** One pass over one formula: recursive descent with one token of lookahead. */
class Reader {
  private readonly tokens: readonly string[];
  private at = 0;
  private depth = 0;

  constructor(
    formula: string,
    private readonly parameters: Amounts,
  ) {
    if (formula.length > LONGEST) {
      throw new Refusal(`is longer than ${LONGEST} characters: split it over several parameters`);
    }
    this.tokens = tokensOf(plainExponents(formula.trim().replace(/^=/, "").trim()));
  }

  read(): Amount {
    const result = this.sum();
    if (this.token) this.fail(`"${this.token}" is not expected here`);
    return result;
  }

  private get token(): string {
    return this.tokens[this.at] ?? "";
  }

  private get after(): string {
    return this.tokens[this.at + 1] ?? "";
  }

  private take(): string {
    const token = this.token;
    this.at += 1;
    return token;
  }

  /** Take the token if it is the one that is asked for. */
  private took(token: string): boolean {
    if (this.token !== token) return false;
    this.at += 1;
    return true;
  }

  private expect(token: string): void {
    const came = this.token ? `"${this.token}"` : "the end";
    if (!this.took(token)) this.fail(`expected "${token}", but ${came} stands there`);
  }

  private sum(): Amount {
    let total = this.product();
    while (this.token === "+" || this.token === "-") {
      const sign = this.take() === "+" ? 1 : -1;
      const term = this.product();
      const dimension = this.shared([total, term], sign > 0 ? "added" : "subtracted");
      total = finite(total.value + sign * term.value, dimension);
    }
    return total;
  }

  private product(): Amount {
    let result = this.factor();
    while (this.token === "*" || this.token === "/") {
      const divide = this.take() === "/";
      const factor = this.factor();
      if (divide && factor.value === 0) this.fail("divides by zero");
      const value = divide ? result.value / factor.value : result.value * factor.value;
      result = finite(value, timesDimension(result.dimension, factor.dimension, divide ? -1 : 1));
    }
    return result;
  }

  private factor(): Amount {
    this.depth += 1;
    if (this.depth > DEEPEST) this.fail(`is nested deeper than ${DEEPEST} levels`);
    const token = this.take();
    const result = this.factorFrom(token);
    this.depth -= 1;
    return result;
  }

  private factorFrom(token: string): Amount {
    if (token === "-") {
      const inner = this.factor();
      return { value: -inner.value, dimension: inner.dimension };
    }
    if (token === "(") {
      const inner = this.sum();
      this.expect(")");
      return inner;
    }
    if ((token === "min" || token === "max") && this.token === "(") return this.call(token);
    if (/^[\d.]/.test(token)) return this.quantity(token);
    if (NAME.test(token)) {
      const found = this.parameter(token);
      if (found === null) throw new Refusal(`"${token}" has no value at present`, true);
      return found ?? this.fail(`"${token}" is not a parameter`);
    }
    return this.fail(token ? `expected a value, but "${token}" stands there` : "is not complete");
  }

  private call(name: "min" | "max"): Amount {
    this.expect("(");
    const given = [this.sum()];
    while (this.took(",")) given.push(this.sum());
    this.expect(")");
    const dimension = this.shared(given, "compared");
    return { value: Math[name](...given.map((each) => each.value)), dimension };
  }

  private quantity(digits: string): Amount {
    const token = this.token;
    const calls = (token === "min" || token === "max") && this.after === "(";
    if (!NAME.test(token) || calls) return finite(Number(digits), PLAIN);
    if (this.parameter(token) !== undefined) {
      this.fail(`"${token}" is not expected here: write "${digits}*${token}"`);
    }
    let text = this.power();
    while ((this.token === "*" || this.token === "/") && this.goesOnAsUnit()) {
      text += this.take() + this.power();
    }
    const unit = unitOf(text);
    if (!unit) throw new Refusal(`there is no unit "${text}"`, true);
    return finite(Number((Number(digits) * unit.factor).toPrecision(16)), unit.dimension);
  }

  private power(): string {
    const name = this.take();
    if (!this.took("^")) return name;
    const sign = this.took("-") ? "-" : "";
    const exponent = this.take();
    if (!/^[1-9]$/.test(exponent)) this.fail("expected an exponent from 1 to 9 after ^");
    return `${name}^${sign}${exponent}`;
  }

  /** Check if the text after a sign belongs to the unit before it: only units of daily use do. */
  private goesOnAsUnit(): boolean {
    return COMMON_UNITS.includes(canonical(this.after)) && this.parameter(this.after) === undefined;
  }

  private parameter(name: string): Amount | null | undefined {
    return Object.hasOwn(this.parameters, name) ? this.parameters[name] : undefined;
  }

  /** The one dimension of all terms; a plain zero goes with anything. */
  private shared(terms: readonly Amount[], verb: string): Dimension {
    const plain = (each: Amount) => sameDimension(each.dimension, PLAIN);
    const counted = terms.filter((each) => each.value !== 0 || !plain(each));
    const first = counted[0]?.dimension ?? PLAIN;
    const other = counted.find((each) => !sameDimension(each.dimension, first));
    if (other) {
      const named = [first, other.dimension].map(describeDimension).sort().join(" and ");
      const hint = counted.some(plain) ? ": give the number a unit, as in 5 mm" : "";
      this.fail(`${named} cannot be ${verb}${hint}`);
    }
    return first;
  }

  private fail(what: string): never {
    throw new Refusal(what);
  }
}

function finite(value: number, dimension: Dimension): Amount {
  if (!Number.isFinite(value)) throw new Refusal("is too large for a number");
  return { value, dimension };
}

function tokensOf(text: string): readonly string[] {
  const tokens: string[] = [];
  TOKEN.lastIndex = 0;
  while (TOKEN.lastIndex < text.length) {
    const from = TOKEN.lastIndex;
    const match = TOKEN.exec(text);
    if (!match) {
      throw new Refusal(`"${text.slice(from).trim().slice(0, 10)}" is not part of a formula`);
    }
    tokens.push(match[1] ?? "");
  }
  return tokens;
}
