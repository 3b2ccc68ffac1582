//! Numbers, flags and seconds as common tools write them. `None` is what cannot be read, NaN what is missing.

/// What tools write where there is no value.
const MISSING: [&str; 7] = ["", "-", "nan", "na", "n/a", "null", "none"];

/// The text of a field.
pub(crate) fn text(field: &[u8]) -> Option<&str> {
    std::str::from_utf8(field).ok().map(str::trim)
}

/// The number of a field; the same as [`number`] of its text, sooner for what most tools write.
#[inline]
pub(crate) fn number_of(field: &[u8]) -> Option<f64> {
    match field {
        b"NaN" => return Some(f64::NAN),
        // A bus that stands is at 0 m/s.
        [digit @ b'0'..=b'9'] => return Some(f64::from(digit - b'0')),
        _ => {}
    }
    match fast_float2::parse(field) {
        Ok(value) if f64::is_finite(value) => Some(value),
        _ => number(text(field)?),
    }
}

/// A number with a decimal point.
pub(crate) fn number(text: &str) -> Option<f64> {
    if MISSING.iter().any(|missing| text.eq_ignore_ascii_case(missing)) {
        return Some(f64::NAN);
    }
    text.parse().ok().filter(|value: &f64| value.is_finite())
}

/// 1 for what is so, 0 for what is not.
pub(crate) fn flag(text: &str) -> Option<f64> {
    match text {
        _ if text.eq_ignore_ascii_case("true") => Some(1.0),
        _ if text.eq_ignore_ascii_case("false") => Some(0.0),
        _ => number(text),
    }
}

/// Whole seconds, also as `1610694000.0` or `1.610694e+09`.
pub(crate) fn second(text: &str) -> Option<i64> {
    let whole = |value: &f64| value.fract() == 0.0 && value.abs() < 1e11;
    text.parse().ok().or_else(|| text.parse().ok().filter(whole).map(|value| value as i64))
}

/// The likely cause that values of a column cannot be read, from one of them.
pub(crate) fn likely_cause(text: &str) -> &'static str {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    match text.trim().trim_start_matches(['-', '+']).split_once(',') {
        Some((whole, decimals)) if digits(whole) && digits(decimals) => {
            "decimal commas; export the file with decimal points"
        }
        _ => "another unit, code or column; correct the export",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn prop_the_number_of_a_field_is_that_of_its_text(value in any::<f64>(), digits in "-?[0-9]{1,18}(\\.[0-9]{0,18})?(e-?[0-9]{1,2})?") {
            for text in [value.to_string(), format!("{value:e}"), digits] {
                prop_assert_eq!(number(&text).map(f64::to_bits), number_of(text.as_bytes()).map(f64::to_bits), "{}", text);
            }
        }
    }

    #[test]
    fn prop_what_common_tools_write_is_read() {
        for text in ["1610694000", "1610694000.0", "1.610694e+09", "1.610694E9"] {
            assert_eq!(second(text), Some(1_610_694_000), "{text}");
        }
        assert_eq!((second("1610694000.5"), second(""), second("x")), (None, None, None));
        assert_eq!((flag("True"), flag("FALSE"), flag("1.0"), flag("open")), (Some(1.0), Some(0.0), Some(1.0), None));
        for text in ["", "NaN", "NA", "-", "null"] {
            assert!(number(text).is_some_and(f64::is_nan), "{text:?}");
        }
        for text in [
            "3.5", "-0", "+7", ".5", "1e3", " 2 ", "\u{a0}4", "nan", "-nan", "inf", "1e999", "", "-", "3,5", "0x10",
            "1_0",
        ] {
            let [by_text, by_field] = [number(text.trim()), number_of(text.as_bytes())];
            assert_eq!(by_text.map(f64::to_bits), by_field.map(f64::to_bits), "{text:?}");
        }
        assert_eq!((number("3.5"), number("3,5"), number("inf")), (Some(3.5), None, None));
        assert!(likely_cause("-3,5").starts_with("decimal commas") && !likely_cause("3;5").starts_with("decimal"));
    }
}
