//! Sentences on a simulation for the user, with numbers as `voxsoft.units` writes them.

use voxsoft_solid::vector::Vec3;

/// Sentence on a step whose contact did not converge.
pub(crate) const UNSETTLED: &str =
    "Contact has not settled in this step: slow it down to see it right";

/// Formats a number with significant digits and no exponent.
fn significant(value: f64, digits: usize) -> String {
    // Rounds first: 9.996 gains a digit before the point.
    let rounded: f64 = format!("{value:.*e}", digits - 1)
        .parse()
        .expect("a number that was just written");
    format!("{rounded}")
}

/// Formats a time with three digits.
pub fn time_text(seconds: f64) -> String {
    if seconds == 0.0 {
        return "0 s".into();
    }
    let milli = 1e3 * seconds;
    if !(0.1..1000.0).contains(&seconds.abs()) && (0.1..1000.0).contains(&milli.abs()) {
        return format!("{} ms", significant(milli, 3));
    }
    format!("{} s", significant(seconds, 3))
}

/// Sentence on a body that came to rest.
pub fn at_rest(seconds: f64, tolerance: f64) -> String {
    let (time, share) = (time_text(seconds), significant(100.0 * tolerance, 2));
    format!("At rest after {time}: forces balance within {share} % of the load.")
}

/// Sentence on slow motion, with the reason if it was chosen automatically.
pub fn slowed(factor: f64, rest_in: Option<f64>) -> String {
    let why = rest_in.map_or(String::new(), |seconds| {
        format!(", as it comes to rest within {}", time_text(seconds))
    });
    let times = significant(1.0 / factor, 3);
    format!("Shown {times} times slower than real time{why}.")
}

/// Sentence on divergence, with the place and a suggestion.
pub fn diverged(seconds: f64, place: Option<Vec3>) -> String {
    let near = place.map_or(String::new(), |at| {
        let [x, y, z] = at.map(|value| format!("{:.1}", 1e3 * value));
        format!(" near ({x}, {y}, {z}) mm")
    });
    let time = time_text(seconds);
    format!(
        "Diverged at {time}{near}: the material cannot carry the load there. \
         Try a smaller load, a stiffer material or thicker walls, then reset."
    )
}

/// Sentence on steps that take more memory than there is.
pub fn out_of_memory(bytes: u64) -> String {
    let size = if bytes == 0 {
        "more memory than there is".to_owned()
    } else {
        let size = significant(1e-9 * bytes as f64, 2);
        format!("about {size} GB of memory, more than there is")
    };
    format!("Steps of this body take {size}. Try larger voxels, or press Solve.")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits_and_a_suitable_unit() {
        let times = [0.0, 0.81234, 0.0497, 12.0, 999.96, 1e-5, 0.1].map(time_text);
        let expected = [
            "0 s",
            "0.812 s",
            "49.7 ms",
            "12 s",
            "1000 s",
            "0.00001 s",
            "0.1 s",
        ];
        assert_eq!(times, expected);
    }

    #[test]
    fn lack_of_memory_is_told_with_its_size() {
        let sentence = "Steps of this body take about 24 GB of memory, more than there is. Try larger voxels, or \
                        press Solve.";
        assert_eq!(out_of_memory(24_300_000_000), sentence);
        assert!(out_of_memory(0).starts_with("Steps of this body take more memory than there is."));
    }

    #[test]
    fn rest_and_divergence_sentences() {
        let sentence = "At rest after 0.8 s: forces balance within 0.01 % of the load.";
        assert_eq!(at_rest(0.8, 1e-4), sentence);
        let sentence = diverged(0.31, Some([0.01, 0.0, 0.02]));
        assert!(sentence.starts_with("Diverged at 0.31 s near (10.0, 0.0, 20.0) mm: the material"));
        assert!(
            sentence
                .ends_with("Try a smaller load, a stiffer material or thicker walls, then reset.")
        );
        assert!(diverged(2.0, None).starts_with("Diverged at 2 s: the"));
    }
}
