//! Numbers as Python writes them, so that the models of a scene have one text in both languages.

/// The fewest digits that determine the number, as `repr` of Python writes them.
pub(super) fn shortest(x: f64) -> String {
    let told = format!("{x:e}");
    let Some((digits, power)) = told.split_once('e').and_then(|(d, p)| Some((d, p.parse::<i32>().ok()?)))
    else {
        return if x.is_nan() { "nan".into() } else { told };
    };
    placed(digits, power, (-4, 16), true)
}

/// The number with this many significant digits, as `:.6g` of Python writes it with six.
pub(super) fn general(x: f64, digits: usize) -> String {
    let told = format!("{x:.*e}", digits - 1);
    let Some((mut kept, power)) = told.split_once('e').and_then(|(d, p)| Some((d, p.parse::<i32>().ok()?)))
    else {
        return told;
    };
    if kept.contains('.') {
        kept = kept.trim_end_matches('0').trim_end_matches('.');
    }
    placed(kept, power, (-4, digits as i32), false)
}

/// A number from its digits and a power of ten, in plain notation for powers within the range, else in scientific notation.
fn placed(digits: &str, power: i32, (low, high): (i32, i32), point: bool) -> String {
    if !(low..high).contains(&power) {
        let sign = if power < 0 { '-' } else { '+' };
        return format!("{digits}e{sign}{:02}", power.abs());
    }
    let (sign, digits) = digits.strip_prefix('-').map_or(("", digits), |rest| ("-", rest));
    let all: String = digits.chars().filter(char::is_ascii_digit).collect();
    let told = if power < 0 {
        format!("0.{}{all}", "0".repeat((-power - 1) as usize))
    } else {
        let whole = power as usize + 1;
        let filled = format!("{all}{}", "0".repeat(whole.saturating_sub(all.len())));
        let (before, after) = filled.split_at(whole);
        match (after, point) {
            ("", true) => format!("{before}.0"),
            ("", false) => before.to_owned(),
            _ => format!("{before}.{after}"),
        }
    };
    format!("{sign}{told}")
}

/// Numbers as text, separated by blanks.
pub(super) fn words(numbers: impl IntoIterator<Item = f64>) -> String {
    numbers.into_iter().map(shortest).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks the texts against those that Python 3 writes.
    #[test]
    fn numbers_are_written_as_python_writes_them() {
        for (x, told, six) in [
            (0.0, "0.0", "0"),
            (-0.0, "-0.0", "-0"),
            (1.0, "1.0", "1"),
            (0.1, "0.1", "0.1"),
            (-2.5, "-2.5", "-2.5"),
            (1e-4, "0.0001", "0.0001"),
            (1.5e-5, "1.5e-05", "1.5e-05"),
            (1e16, "1e+16", "1e+16"),
            (123456789012345680.0, "1.2345678901234568e+17", "1.23457e+17"),
            (1234567.0, "1234567.0", "1.23457e+06"),
            (999999.5, "999999.5", "1e+06"),
            (100000.0, "100000.0", "100000"),
            (0.1 + 0.2, "0.30000000000000004", "0.3"),
            (9.80665, "9.80665", "9.80665"),
            (5e-324, "5e-324", "4.94066e-324"),
        ] {
            assert_eq!((shortest(x).as_str(), general(x, 6).as_str()), (told, six));
        }
    }
}
