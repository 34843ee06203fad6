//! Expressions as text: `x^2 + y^2 - 0.02^2`, with x, y, z in m.
use crate::error::ParseError;
use crate::expr::Expr;

/// Longest text read, in bytes.
const LONGEST: usize = 20_000;
/// Deepest nesting of parentheses, signs and powers, as each level takes stack.
const DEEPEST: usize = 200;

/// Names of the functions.
const FUNCTIONS: &str =
    "abs acos asin atan atan2 ceil cos exp floor hypot log max min sin sqrt tan";

/// Reads an expression.
///
/// Names are x, y, z (m) and pi; operators + − * / % (as in Python) and ^ or ** (powers, right to
/// left, stronger than a sign); functions sqrt abs exp log sin cos tan asin acos atan floor ceil of
/// one argument, atan2 hypot of two, min max of two or more. Angles are in rad.
///
/// # Errors
/// [`ParseError`] with the position of the text that cannot be read.
///
/// ```
/// let circle = voxsoft_shape::parse("sqrt(x^2 + y**2) - 2")?;
/// assert_eq!(circle.evaluate(&[[3.0, 4.0, 0.0]]), vec![3.0]);
/// # Ok::<(), voxsoft_shape::ParseError>(())
/// ```
pub fn parse(text: &str) -> Result<Expr, ParseError> {
    parse_of(text, &["x", "y", "z"])
}

/// Reads an expression in variables of these names: the first is [`crate::Node::Axis`] 0, and so on.
///
/// # Errors
/// As for [`parse`].
///
/// ```
/// use voxsoft_shape::{Node, parse_of};
/// let brake = parse_of("-8*vx", &["x", "vx"])?;
/// assert!(matches!(brake.node(), Node::Binary(..)));
/// assert!(parse_of("-8*vy", &["x", "vx"]).is_err());
/// # Ok::<(), voxsoft_shape::ParseError>(())
/// ```
pub fn parse_of(text: &str, variables: &[&str]) -> Result<Expr, ParseError> {
    if text.len() > LONGEST {
        let message = format!(
            "the text has {} bytes; at most {LONGEST} are read",
            text.len()
        );
        return Err(ParseError {
            position: 1,
            message,
        });
    }
    let mut parser = Parser {
        text: text.chars().collect(),
        at: 0,
        depth: 0,
        variables,
    };
    let expr = parser.sum()?;
    match parser.peek() {
        None => Ok(expr),
        Some(')') => Err(parser.error("this ')' closes nothing")),
        Some(found) => {
            Err(parser.error(&format!("'{found}' came; expected an operator or the end")))
        }
    }
}

struct Parser<'a> {
    text: Vec<char>,
    at: usize,
    depth: usize,
    variables: &'a [&'a str],
}

impl Parser<'_> {
    fn peek(&mut self) -> Option<char> {
        while self.text.get(self.at).is_some_and(|c| c.is_whitespace()) {
            self.at += 1;
        }
        self.text.get(self.at).copied()
    }

    fn take(&mut self, symbol: &str) -> bool {
        self.peek();
        let is_there = symbol
            .chars()
            .enumerate()
            .all(|(i, c)| self.text.get(self.at + i) == Some(&c));
        if is_there {
            self.at += symbol.len();
        }
        is_there
    }

    fn error(&self, message: &str) -> ParseError {
        ParseError {
            position: self.at + 1,
            message: message.to_owned(),
        }
    }

    fn sum(&mut self) -> Result<Expr, ParseError> {
        let mut total = self.product()?;
        loop {
            if self.take("+") {
                total = total + self.product()?;
            } else if self.take("-") {
                total = total - self.product()?;
            } else {
                return Ok(total);
            }
        }
    }

    fn product(&mut self) -> Result<Expr, ParseError> {
        let mut total = self.signed()?;
        loop {
            if self.take("*") {
                total = total * self.signed()?;
            } else if self.take("/") {
                total = total / self.signed()?;
            } else if self.take("%") {
                // The remainder has the sign of the divisor, as in Python and NumPy.
                let divisor = self.signed()?;
                total = total.clone() - divisor.clone() * (total / divisor).floor();
            } else {
                return Ok(total);
            }
        }
    }

    fn signed(&mut self) -> Result<Expr, ParseError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.error(&format!("nested deeper than {DEEPEST} levels")));
        }
        let expr = if self.take("-") {
            -self.signed()?
        } else if self.take("+") {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(expr)
    }

    fn power(&mut self) -> Result<Expr, ParseError> {
        let base = self.atom()?;
        if self.take("^") || self.take("**") {
            let exponent = self.signed()?;
            return Ok(base.pow(&exponent));
        }
        Ok(base)
    }

    fn atom(&mut self) -> Result<Expr, ParseError> {
        match self.peek() {
            Some('(') => {
                self.at += 1;
                let inner = self.sum()?;
                self.close()?;
                Ok(inner)
            }
            Some(c) if c.is_ascii_digit() || c == '.' => self.number(),
            Some(c) if c.is_alphabetic() || c == '_' => self.name(),
            Some(c) => Err(self.error(&format!("'{c}' came; expected a number, a name or '('"))),
            None => Err(self.error("the text ends; expected a number, a name or '('")),
        }
    }

    fn close(&mut self) -> Result<(), ParseError> {
        if self.take(")") {
            Ok(())
        } else {
            Err(self.error("expected ')'"))
        }
    }

    fn number(&mut self) -> Result<Expr, ParseError> {
        let start = self.at;
        let digits = |parser: &mut Self| {
            while parser
                .text
                .get(parser.at)
                .is_some_and(|c| c.is_ascii_digit() || *c == '.')
            {
                parser.at += 1;
            }
        };
        digits(self);
        if matches!(self.text.get(self.at), Some('e' | 'E')) {
            self.at += 1;
            if matches!(self.text.get(self.at), Some('+' | '-')) {
                self.at += 1;
            }
            digits(self);
        }
        let text: String = self.text[start..self.at].iter().collect();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value.into()),
            _ => {
                self.at = start;
                Err(self.error(&format!("\"{text}\" is not a finite number")))
            }
        }
    }

    fn name(&mut self) -> Result<Expr, ParseError> {
        let start = self.at;
        while self
            .text
            .get(self.at)
            .is_some_and(|c| c.is_alphanumeric() || *c == '_')
        {
            self.at += 1;
        }
        let name: String = self.text[start..self.at].iter().collect();
        if let Some(number) = self.variables.iter().position(|known| *known == name) {
            return Ok(Expr::variable(number));
        }
        match name.as_str() {
            "pi" => Ok(std::f64::consts::PI.into()),
            _ if FUNCTIONS.split(' ').any(|known| known == name) => self.call(&name, start),
            _ => {
                self.at = start;
                Err(self.error(&format!(
                    "\"{name}\" is not known; known are {} pi {FUNCTIONS}",
                    self.variables.join(" ")
                )))
            }
        }
    }

    fn call(&mut self, name: &str, start: usize) -> Result<Expr, ParseError> {
        if !self.take("(") {
            return Err(self.error(&format!("expected '(' after {name}")));
        }
        let mut arguments = vec![self.sum()?];
        while self.take(",") {
            arguments.push(self.sum()?);
        }
        self.close()?;
        let found = arguments.len();
        apply(name, arguments).ok_or_else(|| {
            let due = match name {
                "atan2" | "hypot" => "two arguments",
                "min" | "max" => "two or more arguments",
                _ => "one argument",
            };
            ParseError {
                position: start + 1,
                message: format!("{name} takes {due}, not {found}"),
            }
        })
    }
}

/// Applies the function of this name; `None` for a wrong number of arguments.
fn apply(name: &str, arguments: Vec<Expr>) -> Option<Expr> {
    if matches!(name, "min" | "max") && arguments.len() >= 2 {
        let combine = |a: Expr, b: Expr| if name == "min" { a.min(b) } else { a.max(b) };
        return arguments.into_iter().reduce(combine);
    }
    match (name, arguments.as_slice()) {
        ("atan2", [y, x]) => Some(y.atan2(x)),
        ("hypot", [a, b]) => Some((a.square() + b.square()).sqrt()),
        ("abs", [a]) => Some(a.abs()),
        ("acos", [a]) => Some(a.acos()),
        ("asin", [a]) => Some(a.asin()),
        ("atan", [a]) => Some(a.atan()),
        ("ceil", [a]) => Some(-(-a.clone()).floor()),
        ("cos", [a]) => Some(a.cos()),
        ("exp", [a]) => Some(a.exp()),
        ("floor", [a]) => Some(a.floor()),
        ("log", [a]) => Some(a.log()),
        ("sin", [a]) => Some(a.sin()),
        ("sqrt", [a]) => Some(a.sqrt()),
        ("tan", [a]) => Some(a.tan()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::parse;

    fn value(text: &str) -> f64 {
        parse(text).unwrap().evaluate(&[[2.0, 3.0, 5.0]])[0]
    }

    #[test]
    fn operators_bind_as_in_python() {
        assert_eq!(value("-x^2"), -4.0);
        assert_eq!(value("2^-1"), 0.5);
        assert_eq!(value("2^3^2"), 512.0);
        assert_eq!(value("x - y - z"), -6.0);
        assert_eq!(value("z / x / x"), 1.25);
        assert_eq!(value("-z % y"), 1.0);
        assert_eq!(value("z % -y"), -1.0);
        assert_eq!(value("2 * (x + y) * z"), 50.0);
        assert_eq!(value("1.5e-3*1e3"), 1.5);
        assert_eq!(value("max(x, y, z) - min(x, y)"), 3.0);
        assert!((value("y^1.5") - 27f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn unreadable_text_is_reported_with_its_position() {
        let problem = |text: &str| parse(text).unwrap_err();
        assert_eq!(problem("x + radius").position, 5);
        assert!(
            problem("x + radius")
                .message
                .contains("\"radius\" is not known")
        );
        assert_eq!(problem("x +").position, 4);
        assert_eq!(problem("(x").message, "expected ')'");
        assert_eq!(problem("x)").message, "this ')' closes nothing");
        assert_eq!(
            problem("atan2(x)").message,
            "atan2 takes two arguments, not 1"
        );
        assert_eq!(problem("1e999").message, "\"1e999\" is not a finite number");
        assert!(
            problem("x y")
                .message
                .contains("expected an operator or the end")
        );
        assert!(problem(&"(".repeat(1000)).message.contains("nested deeper"));
        assert!(problem(&"x+".repeat(20_000)).message.contains("at most"));
        assert!(problem("").message.contains("the text ends"));
    }
}
