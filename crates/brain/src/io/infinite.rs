//! Infinity as `null`, because JSON has no infinity.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// One number.
pub(crate) mod number {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
    pub(crate) fn serialize<S: Serializer>(number: &f64, to: S) -> Result<S::Ok, S::Error> {
        number.is_finite().then_some(number).serialize(to)
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<f64, D::Error> {
        let number = Option::<f64>::deserialize(from)?;
        Ok(number.unwrap_or(f64::INFINITY))
    }
}

/// A list of numbers.
pub(crate) mod numbers {
    use super::{Deserialize, Deserializer, Serializer};
    use alloc::vec::Vec;

    pub(crate) fn serialize<S: Serializer>(numbers: &[f64], to: S) -> Result<S::Ok, S::Error> {
        let finite = |number: &f64| number.is_finite().then_some(*number);
        to.collect_seq(numbers.iter().map(finite))
    }

    pub(crate) fn deserialize<'d, D: Deserializer<'d>>(from: D) -> Result<Vec<f64>, D::Error> {
        let numbers = Vec::<Option<f64>>::deserialize(from)?.into_iter();
        Ok(numbers
            .map(|number| number.unwrap_or(f64::INFINITY))
            .collect())
    }
}
